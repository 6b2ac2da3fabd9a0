#include <fmt/format.h>
#include <functional>

#include "apps/axis/axes_state.hpp"
#include "apps/axis/not_ready.hpp"

namespace takt {
namespace {

/// axis_motion_t::state of a drive that is not enabled.
constexpr std::int8_t motion_not_enabled = 0;

}  // namespace

bool Axes::State::is_in_mode_of_motions(Index axis) const {
  const AxisControl& known = group.axes();
  return known.mode(axis) == (known.signals(axis).interpolates ? DriveMode::interpolated_position
                                                               : DriveMode::cyclic_position);
}

/// Motion reports of taktd count a drive as enabled only in the mode of operation of taktd's
/// motions. In another mode, the statusword and the mode that the image shows are checked instead.
bool Axes::State::is_ready(Index axis) const {
  if (!group.axes().drive(axis).enabled()) return false;
  if (!is_in_mode_of_motions(axis)) return group.axes().in_mode(axis);
  const auto motion = group.motion(axis);
  return motion && motion->state != motion_not_enabled;
}

bool Axes::State::all_ready() const {
  return all([this](Index axis) { return is_ready(axis); });
}

bool Axes::State::all_enabled() const {
  return all([this](Index axis) { return group.axes().drive(axis).enabled(); });
}

bool Axes::State::all_in_mode_of_motions() const {
  return all([this](Index axis) { return is_in_mode_of_motions(axis); });
}

void Axes::State::send_as_modes_need() {
  sending_ = all_in_mode_of_motions() ? Sending::alive : Sending::controls;
}

Done Axes::State::not_enabled() const {
  return obstacle(Obstacle::Kind::blocked, "the axes are not enabled: call enable() first");
}

std::string Axes::State::why_not_ready_text() const {
  std::string text;
  for (const Index axis : axes) {
    const std::string& name = group.axes().name(axis);
    std::vector<std::string> lines = why_not_ready(group, axis, group.axes().mode(axis));
    if (group.axes().drive(axis).enabled() && !group.motion(axis)) {
      lines = {
          name +
          ": taktd reports no motions of this axis: was taktd started with --no-motions, and are "
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
  // A drive that moves in another mode must be at standstill before its mode changes.
  if (readiness_ != Readiness::not_enabled && !all_in_mode_of_motions()) {
    if (Done stood = stop(); !stood) return stood;
  }
  profile_targets_.reset();
  AxisControl& known = group.axes();
  end_halt(Readiness::not_enabled);
  for (const Index axis : axes) {
    known.set_mode(axis, DriveMode::cyclic_position);
    known.set_goal(axis, DriveGoal::enabled);
  }
  if (sending_ == Sending::nothing) has_begun_ = false;
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
    readiness_ = Readiness::enabled;
    return {};
  }
  const std::string why = no_motions().empty() ? why_not_ready_text() : no_motions();
  [[maybe_unused]] const Done done = disable();  // only the first obstacle is reported
  return obstacle(Obstacle::Kind::blocked, why);
}

Done Axes::State::disable() {
  if (!is_current()) return {};
  if (!std::exchange(held_, {}).empty() && sending_ == Sending::nothing) group.release();
  if (sending_ == Sending::nothing) return {};
  const Done stood = stop();
  if (!is_current()) return stood;
  AxisControl& known = group.axes();
  end_halt(Readiness::not_enabled);
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
  const bool only_resets = sending_ == Sending::nothing;
  if (only_resets) std::erase_if(commanded_, std::not_fn(in_fault));
  sending_ = Sending::controls;
  const auto waited = wait_until([&] { return !any(in_fault); }, options.longest);
  const std::string why = waited ? "" : why_not_ready_text();
  if (only_resets && is_current()) {
    commanded_ = axes;
    sending_ = Sending::nothing;
    group.release();
  }
  return waited ? *waited : obstacle(Obstacle::Kind::blocked, why);
}

Done Axes::State::set_mode(Index number, DriveMode wanted) {
  if (number >= 0 && number < size()) return set_mode(std::span{&axes[at(number)], 1}, wanted);
  return obstacle(Obstacle::Kind::wrong_use, fmt::format("axis {} of {}", number, size()));
}

Done Axes::State::set_mode(DriveMode wanted) { return set_mode(axes, wanted); }

Done Axes::State::set_mode(std::span<const Index> chosen, DriveMode wanted) {
  if (!is_current()) return restarted();
  const Done stood = stop();
  if (!stood) return stood;
  for (const Index axis : chosen) group.axes().set_mode(axis, wanted);
  sending_ = Sending::controls;
  const auto is_there = [this](Index axis) {
    return group.axes().in_mode(axis) && (readiness_ != Readiness::enabled || is_ready(axis));
  };
  const auto waited = wait_until([&] { return all(is_there); }, options.longest);
  if (waited && *waited && readiness_ == Readiness::enabled) send_as_modes_need();
  if (waited) return *waited;
  return obstacle(Obstacle::Kind::blocked, why_not_ready_text());
}

}  // namespace takt
