#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "apps/black_box/recording_file.hpp"

namespace takt {

/// What a replay found.
struct ReplayOutcome {
  std::uint64_t cycles = 0;
  std::uint64_t decisions = 0;              ///< that are as recorded
  std::optional<std::string> difference{};  ///< the first one, in words
};

/// Runs the recording through the bus loop of the master. `tell` hears each decision. The plan is
/// that of the recording, or another one: then the first difference tells what it changes.
ReplayOutcome replay(const BusPlan& plan, const LoadedRecording& recording,
                     const std::function<void(const Decision&)>& tell);

}  // namespace takt
