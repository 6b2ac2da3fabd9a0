#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "apps/axis/axes_state.hpp"
#include "apps/axis/not_ready.hpp"

namespace takt {
namespace {

using std::chrono::nanoseconds;

constexpr std::uint16_t start_bit = 0x0010;      // bit of the controlword, CiA 402-2, homing mode
constexpr std::uint16_t homing_result = 0x3000;  // bits of the statusword
/// If the statusword shows no homing for this time, the drive has not begun the run, or has
/// interrupted it.
constexpr std::chrono::seconds start_patience{1};
/// The longest time of a homing run if taktd reports none.
constexpr std::chrono::seconds usual_time{60};
/// Values of axis_motion_t::homing.
constexpr std::int8_t is_homed = 2;
constexpr std::int8_t has_failed = 3;

}  // namespace

/// The homing run of one axis.
struct Axes::State::HomingRun {
  Index axis;
  std::optional<std::int64_t> started{};  ///< cycle of the first image that shows the start
  /// The newest time at which the statusword showed another state than "not started".
  Clock::time_point moved = Clock::now();
  bool done = false;
};

bool Axes::State::homed(Index axis) const {
  const auto motion = group.motion(axis);
  return motion && motion->homing == is_homed;
}

bool Axes::State::needs_homing(Index axis) const {
  const auto motion = group.motion(axis);
  return motion && motion->needs_homing != 0;
}

Done Axes::State::home(const HomingOptions& wanted) {
  if (!is_current()) return restarted();
  if (Done halted = check_halt(); !halted) return halted;
  if (readiness_ == Readiness::not_enabled || !all_ready()) {
    if (Done enabled = enable(); !enabled) return enabled;
  }
  if (Done stood = stop(); !stood) return stood;
  if (wanted.order == HomingOptions::Order::together) return home(axes, wanted.longest);
  for (const Index axis : axes) {
    if (Done done = home(std::span{&axis, 1}, wanted.longest); !done) return done;
  }
  return {};
}

Done Axes::State::home(std::span<const Index> chosen, nanoseconds longest) {
  Done homed = enter_homing(chosen);
  if (homed) homed = run_homing(chosen, longest);
  const Done left = is_current() ? leave_homing(chosen) : Done{};
  return homed ? left : homed;
}

Done Axes::State::enter_homing(std::span<const Index> chosen) {
  AxisControl& known = group.axes();
  for (const Index axis : chosen) known.set_mode(axis, DriveMode::homing);
  sending_ = Sending::controls;
  const std::int64_t begin = group.input().cycle();
  const auto is_in_mode = [&](Index axis) { return known.in_mode(axis); };
  const auto is_disabled = [&](Index axis) { return !known.drive(axis).enabled(); };
  const auto is_decided = [&] {
    const bool settled = group.input().cycle() >= begin + settled_cycles;
    return std::ranges::any_of(chosen, is_disabled) ||
           (settled && std::ranges::all_of(chosen, is_in_mode));
  };
  const auto waited = wait_until(is_decided, options.longest);
  if (waited && !*waited) return *waited;
  if (waited && std::ranges::none_of(chosen, is_disabled)) return {};
  return obstacle(Obstacle::Kind::blocked, why_not_in_homing_mode(chosen));
}

std::string Axes::State::why_not_in_homing_mode(std::span<const Index> chosen) const {
  std::string text;
  for (const Index axis : chosen) {
    for (const std::string& line : why_not_ready(group, axis, DriveMode::homing)) {
      text += (text.empty() ? "" : "; ") + line;
    }
  }
  return text;
}

Done Axes::State::run_homing(std::span<const Index> chosen, nanoseconds longest) {
  std::vector<HomingRun> runs;
  nanoseconds configured{0};
  for (const Index axis : chosen) {
    group.axes().start_homing(axis);
    runs.push_back({.axis = axis});
    const auto motion = group.motion(axis);
    const std::chrono::milliseconds given{motion ? motion->homing_timeout_ms : 0};
    configured = std::max<nanoseconds>(configured, given.count() > 0 ? given : usual_time);
  }
  if (longest <= nanoseconds{0}) longest = configured;
  std::string trouble;
  const auto over = [&] {
    for (HomingRun& run : runs) {
      if (trouble.empty()) trouble = trouble_of(run);
    }
    return !trouble.empty() || std::ranges::all_of(runs, &HomingRun::done);
  };
  const auto waited = wait_until(over, longest);
  if (waited && !*waited) return *waited;
  if (!trouble.empty()) return obstacle(Obstacle::Kind::stopped, trouble);
  if (waited) return {};
  for (const HomingRun& run : runs) {
    if (run.done) continue;
    trouble += fmt::format(
        "{}{}: the homing has not ended after {:.1f} s: its statusword is 0x{:04X}",
        trouble.empty() ? "" : "; ", group.axes().name(run.axis),
        std::chrono::duration<double>(longest).count(), group.axes().statusword(run.axis));
  }
  return obstacle(Obstacle::Kind::time_over, trouble);
}

/// Checks a run. Returns the reason if it has failed, otherwise an empty text. A report of taktd
/// about the cycle in which the start was sent, or about a later one, is about this run.
std::string Axes::State::trouble_of(HomingRun& run) {
  const AxisControl& known = group.axes();
  const std::uint16_t word = known.statusword(run.axis);
  if (!known.drive(run.axis).enabled()) {
    return "the homing was interrupted: " + why_not_in_homing_mode(std::span{&run.axis, 1});
  }
  const auto now = Clock::now();
  const std::int64_t cycle = group.input().cycle();
  const std::int64_t sent = group.input().values()[*known.signals(run.axis).controlword];
  if (!run.started && (sent & start_bit) != 0) run.started = cycle;
  if (!run.started || group.motion_cycle(run.axis) < *run.started + settled_cycles) {
    run.moved = now;
    return {};
  }
  const std::string& name = known.name(run.axis);
  const auto motion = group.motion(run.axis);
  run.done = homed(run.axis);
  if (motion && motion->homing == has_failed) {
    const auto node = group.node_status(run.axis);
    const std::string error = node ? newest_error(*node) : "";
    return fmt::format(
        "{}: the drive reports a homing error: bit 13 of its statusword 0x{:04X} is 1{}{}", name,
        word, error.empty() ? "" : "; ", error);
  }
  if ((word & (homing_result | target_reached)) != target_reached) run.moved = now;
  if (now - run.moved < start_patience) return {};
  return fmt::format(
      "{}: the drive has not begun the homing, or has interrupted it: bits 12 and 13 of its "
      "statusword 0x{:04X} are 0, and bit 10 is 1",
      name, word);
}

/// Ends the runs, waits until the axes are at rest, and sets cyclic synchronous position mode.
/// taktd keeps the target positions equal to the actual positions until the drives follow them.
Done Axes::State::leave_homing(std::span<const Index> chosen) {
  AxisControl& known = group.axes();
  for (const Index axis : chosen) known.end_homing(axis);
  const auto rested = wait_for_rest(chosen, Interruption::ignored);
  if (rested && !*rested) return *rested;
  if (!rested) return obstacle(Obstacle::Kind::time_over, "the axes still move");
  for (const Index axis : chosen) known.set_mode(axis, DriveMode::cyclic_position);
  const auto is_over = [this](Index axis) {
    return is_ready(axis) || !group.axes().drive(axis).enabled();
  };
  const auto back = wait_until([&] { return std::ranges::all_of(chosen, is_over); },
                               options.longest, Interruption::ignored);
  if (back && !*back) return *back;
  if (!all_ready()) return obstacle(Obstacle::Kind::blocked, why_not_ready_text());
  send_as_modes_need();
  return {};
}

}  // namespace takt
