#include "master/gateway/motion/motion_answers.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "master/gateway/motion/motion_text.hpp"

namespace takt {

std::string MotionAnswers::name_of(std::size_t axis) const {
  const std::string& node = plan_.nodes[axes_[axis].node_index].name;
  return axes_[axis].number == 0 ? node : fmt::format("{} (axis {})", node, axes_[axis].number + 1);
}

void MotionAnswers::announce(const std::string& kind, const std::string& text,
                             std::optional<std::size_t> axis, const CommandContext& context) {
  const auto kept_back = reported_.allow(kind + text, context.now);
  if (!kept_back) return;
  announce_({.when = context.now,
             .cycle = context.cycle,
             .node = axis ? plan_.nodes[axes_[*axis].node_index].id.value() : std::uint8_t{0},
             .kind = kind,
             .weight = Weight::warning,
             .text = with_kept_back(axis ? fmt::format("{}: {}", name_of(*axis), text) : text,
                                    *kept_back)});
}

void MotionAnswers::announce_refusal(const MotionName& motion, const MotionRefusal& refusal,
                                     const CommandContext& context) {
  announce("motion_refused",
           fmt::format("motion {} of '{}' refused: {}", motion.id, motion.sender, refusal.why),
           refusal.axis, context);
}

void MotionAnswers::refuse(const MotionName& motion, std::span<const std::size_t> axes,
                           const MotionRefusal& refusal, const CommandContext& context) {
  for (const std::size_t axis : axes) ended(axis, motion.id, ShownMotion::Ended::refused);
  announce_refusal(motion, refusal, context);
}

void MotionAnswers::refuse(const MotionJob& job, const MotionRefusal& refusal,
                           const CommandContext& context) {
  for (const motion::AxisGoal& goal : job.goals) {
    ended(goal.axis, job.name.id, ShownMotion::Ended::refused);
  }
  announce_refusal(job.name, refusal, context);
}

void MotionAnswers::stopped(std::size_t axis, std::int32_t id, const motion::Stop& stop,
                            const CommandContext& context) {
  ended(axis, id, ShownMotion::Ended::stopped);
  announce(
      "motion_stopped",
      fmt::format("motion {} has stopped because of {}: {}", id,
                  name_of(std::min<std::size_t>(stop.axis, axes_.size() - 1)), text(stop.cause)),
      axis, context);
}

}  // namespace takt
