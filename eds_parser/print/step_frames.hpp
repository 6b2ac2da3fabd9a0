#pragma once
#include <string>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The frames with which a step begins, as candump writes them: `601#4018100100000000`. `..` is a
/// byte that the device decides.
struct StepFrames {
  std::string first{};  ///< empty: the step sends none
  std::string write{};  ///< the download that follows where what was read is not what it should be
};

/// One for each step of the node's boot, in their order.
std::vector<StepFrames> step_frames(const NodePlan& node);

}  // namespace takt
