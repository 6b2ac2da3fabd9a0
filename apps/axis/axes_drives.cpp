#include <fmt/format.h>

#include "apps/axis/axes_state.hpp"
#include "apps/axis/not_ready.hpp"

namespace takt {
namespace {

/// Number of status_t (10 in a second) in sequence in which another program holds an axis before
/// enable() gives up. It may be a program that has died, whose last command lives on.
constexpr int held_statuses = 20;
/// axis_motion_t::state of a drive that is not enabled.
constexpr std::int8_t motion_not_enabled = 0;

}  // namespace

/// taktd also looks at the mode of operation before it reports a drive as enabled.
bool Axes::State::is_ready(Index axis) const {
  const auto motion = group.motion(axis);
  return group.axes().drive(axis).enabled() && motion && motion->state != motion_not_enabled;
}

bool Axes::State::all_ready() const {
  return all([this](Index axis) { return is_ready(axis); });
}

std::string Axes::State::why_not_ready_text() const {
  std::string text;
  for (const Index axis : axes) {
    const std::string& name = group.axes().name(axis);
    std::vector<std::string> lines = why_not_ready(group, axis, mode_);
    if (group.axes().drive(axis).enabled() && !group.motion(axis)) {
      lines = {name +
               ": taktd reports no motion of it: was taktd started with --no-motions, and are "
               "6041 and 6064 in TPDOs and 607A in an RPDO of the drive?"};
    } else if (lines.empty() && !is_ready(axis)) {
      lines = {name +
               ": its target position is not sent: does each object of its RPDO have a value?"};
    }
    for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
  }
  return text;
}

Done Axes::State::enable() {
  if (!is_current()) return restarted();
  AxisControl& known = group.axes();
  mode_ = DriveMode::cyclic_position;
  known.set_mode(mode_);
  for (const Index axis : axes) known.set_goal(axis, DriveGoal::enabled);
  sending_ = Sending::controls;
  const auto blocked = [&](Index axis) {
    return known.drive(axis).in_fault() || group.holder(axis).is_other(held_statuses);
  };
  const auto no_motions = [&] { return event_text("motion_refused", "taktd runs no motions"); };
  const auto waited = wait_until(
      [&] { return all_ready() || any(blocked) || !no_motions().empty(); }, options.longest);
  if (waited && !*waited) return *waited;
  if (all_ready()) {
    sending_ = Sending::alive;
    return {};
  }
  const std::string why = no_motions().empty() ? why_not_ready_text() : no_motions();
  [[maybe_unused]] const Done done = disable();  // the first obstacle is the one to tell
  return obstacle(Obstacle::Kind::blocked, why);
}

Done Axes::State::disable() {
  if (sending_ == Sending::nothing || !is_current()) return {};
  const Done stood = stop();
  if (!is_current()) return stood;
  AxisControl& known = group.axes();
  for (const Index axis : axes) known.set_goal(axis, DriveGoal::disabled);
  sending_ = Sending::controls;
  const auto over = [&](Index axis) {
    return known.drive(axis).reached() || group.holder(axis).is_other();
  };
  const auto waited = wait_until([&] { return all(over); }, options.longest, Interruption::ignored);
  sending_ = Sending::nothing;
  group.release();
  if (waited && !*waited) return *waited;
  if (waited) return stood;
  std::string text;
  for (const Index axis : axes) {
    if (over(axis)) continue;
    text += fmt::format("{}{} does not confirm that it is disabled: its statusword is 0x{:04X}",
                        text.empty() ? "" : "; ", known.name(axis), known.statusword(axis));
  }
  return obstacle(Obstacle::Kind::time_over, text);
}

Done Axes::State::reset() {
  if (!is_current()) return restarted();
  AxisControl& known = group.axes();
  const auto in_fault = [&](Index axis) { return known.drive(axis).in_fault(); };
  if (!any(in_fault)) return {};
  for (const Index axis : axes) known.reset_fault(axis);
  sending_ = Sending::controls;
  const auto waited = wait_until([&] { return !any(in_fault); }, options.longest);
  if (waited) return *waited;
  return obstacle(Obstacle::Kind::blocked, why_not_ready_text());
}

Done Axes::State::set_mode(DriveMode wanted) {
  if (!is_current()) return restarted();
  const Done stood = stop();
  if (!stood) return stood;
  mode_ = wanted;
  group.axes().set_mode(wanted);
  sending_ = Sending::controls;
  const auto waited = wait_until(
      [this] { return all([this](Index i) { return group.axes().in_mode(i); }); }, options.longest);
  if (waited) return *waited;
  return obstacle(Obstacle::Kind::blocked, why_not_ready_text());
}

}  // namespace takt
