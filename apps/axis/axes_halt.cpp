#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "apps/axis/axes_state.hpp"

// Halt and quick stop. The drives generate the ramps.

namespace takt {
namespace {

constexpr std::int64_t halt_bit = 0x0100;  // bit 8 of the controlword

/// Returns true for a mode in which bit 10 of the statusword does not mean that the axis is at
/// standstill.
bool has_own_set_points(DriveMode mode) noexcept {
  using enum DriveMode;
  return mode == profile_velocity || mode == cyclic_velocity || mode == profile_torque ||
         mode == cyclic_torque;
}

}  // namespace

Done Axes::State::check_halt() const {
  if (readiness_ != Readiness::halted) return {};
  return obstacle(Obstacle::Kind::blocked, "the axes are halted: call resume() first");
}

Done Axes::State::halt() {
  if (!is_current()) return restarted();
  if (readiness_ == Readiness::not_enabled) return not_enabled();
  jog_goes_on_ = false;
  stream_.reset();
  readiness_ = Readiness::halted;
  end_set_points();
  for (const Index axis : axes) group.axes().halt(axis);
  sending_ = Sending::controls;
  const auto is_sent = [this](Index axis) {
    return shows_halt(axis) || !group.axes().drive(axis).enabled();
  };
  auto rested = wait_until([&] { return all(is_sent); }, options.longest);
  if (rested && *rested) rested = wait_for_rest(axes, Interruption::obeyed);
  if (rested && !*rested) return *rested;
  if (!rested) {
    return obstacle(
        Obstacle::Kind::time_over,
        text_of_each(
            axes,
            "{} does not follow the Halt, or does not come to rest: its statusword is 0x{:04X}"));
  }
  if (all_enabled()) return {};
  return obstacle(Obstacle::Kind::blocked, why_not_ready_text());
}

Done Axes::State::resume() {
  if (!is_current()) return restarted();
  if (readiness_ != Readiness::halted) return {};
  end_halt(Readiness::enabled);
  sending_ = Sending::controls;
  std::int64_t halted = group.input().cycle();  // newest cycle in which an axis was halted
  const auto over = [&] {
    const std::int64_t cycle = group.input().cycle();
    if (any([this](Index axis) { return shows_halt(axis); })) halted = cycle;
    return cycle >= halted + settled_cycles && all_ready();
  };
  const auto waited = wait_until(over, options.longest);
  if (waited && !*waited) return *waited;
  if (!waited) return obstacle(Obstacle::Kind::blocked, why_not_ready_text());
  send_as_modes_need();
  return {};
}

bool Axes::State::shows_halt(Index axis) const {
  const auto place = *group.axes().signals(axis).controlword;
  return (group.input().values()[place] & halt_bit) != 0;
}

void Axes::State::end_halt(Readiness next) {
  readiness_ = next;
  for (const Index axis : axes) group.axes().end_halt(axis);
}

Done Axes::State::quick_stop() {
  if (!is_current()) return restarted();
  if (sending_ == Sending::nothing) return not_enabled();
  jog_goes_on_ = false;
  stream_.reset();
  end_halt(Readiness::not_enabled);
  AxisControl& known = group.axes();
  for (const Index axis : axes) known.set_goal(axis, DriveGoal::quick_stopped);
  sending_ = Sending::controls;
  const auto obeys = [&](Index axis) { return !known.drive(axis).enabled(); };
  const auto waited =
      wait_until([&] { return all(obeys); }, options.longest, Interruption::ignored);
  if (waited && !*waited) return *waited;
  if (!waited) {
    std::vector<Index> ignoring;
    for (const Index axis : axes) {
      if (!obeys(axis)) ignoring.push_back(axis);
    }
    return obstacle(
        Obstacle::Kind::blocked,
        text_of_each(
            ignoring,
            "{} ignores the quick stop: it is in operation enabled, its statusword is 0x{:04X}"));
  }
  const auto rested = wait_for_rest(axes, Interruption::ignored);
  if (!rested) return obstacle(Obstacle::Kind::time_over, "the axes still move");
  return *rested;
}

/// An axis is at standstill when its drive reports standstill, or when its position has stayed
/// within a few counts, because the position of an encoder may flicker at standstill.
std::optional<Done> Axes::State::wait_for_rest(std::span<const Index> chosen,
                                               Interruption interruption) {
  struct Window {
    double counts;
    std::int64_t cycles;
    std::int64_t since = 0;  ///< newest cycle in which an axis has left the window
    Eigen::VectorXd middle{};
  };
  // Both windows correspond to the same speed; the second one is for fine encoders.
  std::array windows{Window{.counts = 2.5, .cycles = settled_cycles},
                     Window{.counts = 25, .cycles = 10 * settled_cycles}};
  const AxisControl& known = group.axes();
  const auto leaves = [&](Index axis, const Window& window) {
    const State402 state = known.drive(axis).state();
    const bool brakes = known.drive(axis).enabled() || state == State402::quick_stop_active;
    const bool says_rest =
        !has_own_set_points(known.mode(axis)) && (known.statusword(axis) & target_reached) != 0;
    const AxisSignals& signals = known.signals(axis);
    if (!brakes || says_rest || !signals.position) return false;
    const bool shows_rest = signals.velocity && !group.input().stale(*signals.velocity) &&
                            group.input().values()[*signals.velocity] == 0;
    const double counts = shows_rest ? windows.back().counts : window.counts;
    const double distance = std::abs(known.positions()(axis) - window.middle(axis));
    return distance > counts * std::abs(group.input().signals()[*signals.position].scale);
  };
  const auto at_rest = [&] {
    const std::int64_t cycle = group.input().cycle();
    bool stands = false;
    for (Window& window : windows) {
      const auto left = [&](Index axis) { return leaves(axis, window); };
      if (window.middle.size() == 0 || moving() || std::ranges::any_of(chosen, left)) {
        window.since = cycle;
        window.middle = known.positions();
      }
      stands |= cycle >= window.since + window.cycles;
    }
    return stands;
  };
  return wait_until(at_rest, options.longest, interruption);
}

std::string Axes::State::text_of_each(
    std::span<const Index> chosen,
    fmt::format_string<const std::string&, std::uint16_t> words) const {
  std::string text;
  for (const Index axis : chosen) {
    text += text.empty() ? "" : "; ";
    text += fmt::format(words, group.axes().name(axis), group.axes().statusword(axis));
  }
  return text;
}

}  // namespace takt
