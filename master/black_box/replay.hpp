#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "master/black_box/recording_file.hpp"

namespace takt {

/// Result of a replay.
struct ReplayOutcome {
  std::uint64_t cycles = 0;
  std::uint64_t decisions = 0;              ///< number of decisions that are as recorded
  std::optional<std::string> difference{};  ///< first difference, in words; empty if none
};

/// Runs the recording through the bus loop of the master. `announce` receives each decision. The
/// plan is that of the recording, or another one; the first difference then shows the effect of the
/// change.
ReplayOutcome replay(const BusPlan& plan, const LoadedRecording& recording,
                     const std::function<void(const Decision&)>& announce);

}  // namespace takt
