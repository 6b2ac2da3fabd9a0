#pragma once
#include <string>
#include <vector>

#include "apps/black_box/recording_file.hpp"
#include "master/rt/replay_port.hpp"

namespace takt {

/// The difference in words; `logs` are the paths of the candump logs.
std::string difference_text(const ReplayDifference& difference,
                            const std::vector<std::string>& logs);
/// The recorded decision and the one in its place.
std::string decision_text(const Decision& recorded, const Decision& decision);
/// One more decision than recorded.
std::string surplus_text(const Decision& decision);
/// A recorded decision that was not taken again.
std::string lack_text(const Decision& recorded);

}  // namespace takt
