#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/gateway/motion/motion_answers.hpp"
#include "master/rt/exchange/motion_board.hpp"

namespace takt {

/// Refuses absolute motions of axes that have to be homed first, and reports to users how homing
/// runs have ended. All calls come from the front thread.
class MotionHoming {
 public:
  /// Keeps references to both arguments. `axes` are the motion_axes() of the plan.
  MotionHoming(const std::vector<MotionAxis>& axes, MotionAnswers& answers)
      : axes_{axes}, answers_{answers}, states_(axes.size(), motion::HomingState::none) {}

  /// Returns the reason why the axes must not move to absolute positions now; std::nullopt if they
  /// may.
  std::optional<MotionRefusal> objection(std::span<const std::size_t> axes) const;
  /// Takes the newest reports.
  void observe(const MotionSnapshot& snapshot, const CommandContext& context);

 private:
  const std::vector<MotionAxis>& axes_;
  MotionAnswers& answers_;
  std::vector<motion::HomingState> states_;  ///< indexed by axis
};

}  // namespace takt
