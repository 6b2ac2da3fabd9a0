#include "master/gateway/motion/motion_homing.hpp"

#include <utility>

#include "master/gateway/motion/motion_text.hpp"

namespace takt {

std::optional<MotionRefusal> MotionHoming::objection(std::span<const std::size_t> axes) const {
  for (const std::size_t axis : axes) {
    if (!axes_[axis].needs_homing || states_[axis] == motion::HomingState::homed) continue;
    return MotionRefusal{.why = std::string{text(states_[axis])}, .axis = axis};
  }
  return std::nullopt;
}

void MotionHoming::observe(const MotionSnapshot& snapshot, const CommandContext& context) {
  for (std::size_t i = 0; i < states_.size() && i < snapshot.axes.size(); ++i) {
    const motion::HomingState now = snapshot.axes[i].homing;
    const motion::HomingState before = std::exchange(states_[i], now);
    if (now != before) answers_.homing_changed(i, before, now, context);
  }
}

}  // namespace takt
