#pragma once
#include <string>
#include <vector>

#include "master/black_box/recording_file.hpp"
#include "master/rt/journal/replay_port.hpp"

namespace takt {

/// Describes a difference. `logs` are the paths of the candump logs.
std::string difference_text(const ReplayDifference& difference,
                            const std::vector<std::string>& logs);
/// Describes a decision that differs from the recorded one.
std::string decision_text(const Decision& recorded, const Decision& decision);
/// Describes a decision that is not in the recording.
std::string surplus_text(const Decision& decision);
/// Describes a recorded decision that the replay did not repeat.
std::string lack_text(const Decision& recorded);

}  // namespace takt
