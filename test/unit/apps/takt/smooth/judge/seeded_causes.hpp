#pragma once
#include <functional>
#include <vector>

#include "apps/takt/smooth/judge/finding.hpp"
#include "test/unit/apps/takt/smooth/judge/generated_trace.hpp"

namespace takt::smooth {

/// A cause, how it comes into a recording, and where it can't be seen.
struct Seeded {
  const char* name;
  Cause cause;
  std::function<void(Recipe&)> recipe;
  Defect defect;
  bool needs_boot = false;
};

/// Returns all causes that the tests know how to make.
const std::vector<Seeded>& seeded_causes();

}  // namespace takt::smooth
