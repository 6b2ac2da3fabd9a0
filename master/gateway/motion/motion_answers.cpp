#include "master/gateway/motion/motion_answers.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "master/explain/emcy_text.hpp"
#include "master/gateway/motion/motion_text.hpp"

namespace takt {
namespace {

/// Returns the severity of a stop: a stop that was requested is a note.
Weight weight_of(motion::StopCause cause) noexcept {
  using enum motion::StopCause;
  const bool requested = cause == application || cause == ordered_stop || cause == nmt_command;
  return requested ? Weight::note : Weight::warning;
}

}  // namespace

std::string MotionAnswers::name_of(std::size_t axis) const {
  const std::string& node = plan_.nodes[axes_[axis].node_index].name;
  return axes_[axis].number == 0 ? node : fmt::format("{} (axis {})", node, axes_[axis].number + 1);
}

void MotionAnswers::announce(const std::string& kind, const std::string& text,
                             std::optional<std::size_t> axis, const CommandContext& context,
                             Weight weight) {
  const std::string whole = axis ? fmt::format("{}: {}", name_of(*axis), text) : text;
  const auto kept_back = reported_.allow(kind + whole, context.now);
  if (!kept_back) return;
  announce_({.when = context.now,
             .cycle = context.cycle,
             .node = axis ? plan_.nodes[axes_[*axis].node_index].id.value() : std::uint8_t{0},
             .kind = kind,
             .weight = weight,
             .text = with_kept_back(whole, *kept_back)});
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
      axis, context, weight_of(stop.cause));
}

void MotionAnswers::homing_changed(std::size_t axis, motion::HomingState before,
                                   motion::HomingState now, const CommandContext& context) {
  using enum motion::HomingState;
  if (now == homed) return announce("homed", "the axis is homed", axis, context, Weight::note);
  if (now == failed) {
    const std::size_t node = axes_[axis].node_index;
    const std::uint16_t emcy = node < context.nodes.size() ? context.nodes[node].last_emcy : 0;
    const std::string code = emcy == 0
                                 ? ""
                                 : fmt::format("; the newest error of its device is 0x{:04X} ({})",
                                               emcy, emcy_text(&plan_.nodes[node], emcy));
    return announce("homing_failed",
                    "the drive reports a homing error (bit 13 of its statusword)" + code, axis,
                    context);
  }
  if (before == runs && now == none) {
    return announce("homing_failed", "the homing run was broken off before it had a result", axis,
                    context);
  }
  if (before == homed && now == none) {
    const std::string_view then =
        axes_[axis].needs_homing ? ", and it has to be homed again before it goes to a position"
                                 : "";
    announce(
        "homing_lost",
        fmt::format("its node has stopped exchanging PDOs, so its home position is not certain "
                    "any longer{}",
                    then),
        axis, context);
  }
}

}  // namespace takt
