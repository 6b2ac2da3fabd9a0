#pragma once
#include <string>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The frames with which a step begins, in the format of candump: `601#4018100100000000`. `..` is a
/// byte that depends on the device.
struct StepFrames {
  std::string first{};  ///< first frame; empty if the step sends none
  std::string write{};  ///< download that follows if the read value is not the expected one
};

/// Returns the frames of each step of the node's boot, in the order of the steps.
std::vector<StepFrames> step_frames(const NodePlan& node);

}  // namespace takt
