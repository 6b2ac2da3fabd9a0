#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "apps/axis/axes_state.hpp"
#include "apps/axis/group/signal_format.hpp"
#include "apps/axis/not_ready.hpp"

// Modes in which this program commands the drives without motions of taktd: velocities, torques,
// and positions to which the drives move along their own profiles.

namespace takt {
namespace {

/// Longest wait until an image shows that set-points were sent.
constexpr std::chrono::seconds sent_time{1};
/// If an axis has been at standstill for this time and its drive does not report the target as
/// reached, the motion has failed.
constexpr std::chrono::seconds standing_time{1};

std::string list_of(std::span<const DriveMode> modes) {
  std::string text;
  for (const DriveMode mode : modes) {
    text += fmt::format("{}{}", text.empty() ? "" : " or ", std::to_underlying(mode));
  }
  return text;
}

}  // namespace

/// A kind of set-points: the modes in which drives take them, and the output that carries them.
struct Axes::State::SetPoints {
  std::array<DriveMode, 2> modes;
  AxisSignals::Position AxisSignals::* output;
  std::string_view object;
};

/// Returns the reason if these axes do not take set-points of this kind now.
Done Axes::State::check_set_points(const Values& values, const SetPoints& kind) {
  if (values.size() != size()) {
    return obstacle(Obstacle::Kind::wrong_use,
                    fmt::format("expected one value for each of {} axes, got {} values", size(),
                                values.size()));
  }
  if (!values.allFinite()) {
    return obstacle(Obstacle::Kind::wrong_use, "a value is not a finite number");
  }
  if (!is_current()) return restarted();
  if (readiness_ == Readiness::not_enabled) return not_enabled();
  if (Done halted = check_halt(); !halted) return halted;
  const AxisControl& known = group.axes();
  for (const Index axis : axes) {
    const DriveMode mode = known.mode(axis);
    if (std::ranges::find(kind.modes, mode) == kind.modes.end()) {
      return obstacle(Obstacle::Kind::blocked,
                      fmt::format("{} is in mode {}, and this needs mode {}: call set_mode() first",
                                  known.name(axis), std::to_underlying(mode), list_of(kind.modes)));
    }
    // The target of an axis that interpolates is 0x60C1:01, which other modes do not use.
    const AxisSignals& signals = known.signals(axis);
    const bool is_point = signals.interpolates && kind.output == &AxisSignals::target_position;
    if (signals.*kind.output && !is_point) continue;
    return obstacle(Obstacle::Kind::blocked, fmt::format("{}: {} is in no RPDO: map it there",
                                                         known.name(axis), kind.object));
  }
  return all_ready() ? Done{} : obstacle(Obstacle::Kind::blocked, why_not_ready_text());
}

/// Returns these values at the places of the axes in the group, and `otherwise` for the other axes
/// of the group.
Eigen::VectorXd Axes::State::in_group(const Values& values, double otherwise) const {
  Eigen::VectorXd all_axes = Eigen::VectorXd::Constant(group.axes().size(), otherwise);
  for (Index i = 0; i < size(); ++i) all_axes(in_group(i)) = values(i);
  return all_axes;
}

void Axes::State::end_set_points() {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(group.axes().size());
  group.axes().set_velocities(zero);
  group.axes().set_torques(zero);
  has_set_points_ = false;
}

Done Axes::State::command_velocities(const Values& values) {
  const SetPoints velocities{.modes = {DriveMode::profile_velocity, DriveMode::cyclic_velocity},
                             .output = &AxisSignals::target_velocity,
                             .object = "0x60FF"};
  if (Done ready = check_set_points(values, velocities); !ready) return ready;
  if (!has_set_points_) learn_decelerations();
  if (!is_current()) return restarted();
  group.axes().set_velocities(in_group(values, 0.0));
  return send_set_points(values, velocities);
}

Done Axes::State::command_torques(const Values& values) {
  const SetPoints torques{.modes = {DriveMode::profile_torque, DriveMode::cyclic_torque},
                          .output = &AxisSignals::target_torque,
                          .object = "0x6071"};
  if (Done ready = check_set_points(values, torques); !ready) return ready;
  group.axes().set_torques(in_group(values, 0.0));
  return send_set_points(values, torques);
}

/// Sends the values, and returns when an image shows that they were sent. If taktd refuses them,
/// the axes get 0.
Done Axes::State::send_set_points(const Values& values, const SetPoints& kind) {
  std::vector<std::pair<std::size_t, std::int64_t>> expected;
  for (Index i = 0; i < size(); ++i) {
    const std::size_t place = *(group.axes().signals(in_group(i)).*kind.output);
    const std::array formats{format_of(group.input().signals()[place])};
    const auto raw = Units{formats}.raw_of(0, values(i));
    if (!raw || !fits(formats[0].type, formats[0].bits, *raw)) {
      end_set_points();
      return obstacle(Obstacle::Kind::wrong_use,
                      fmt::format("{} can't be commanded to {}", names[static_cast<std::size_t>(i)],
                                  values(i)));
    }
    expected.emplace_back(place, *raw);
  }
  events_.clear();
  if (!has_set_points_) last_values_ = Clock::now();
  has_set_points_ = true;
  const auto is_sent = [&] {
    return std::ranges::all_of(expected, [&](const auto& output) {
      return group.input().values()[output.first] == output.second;
    });
  };
  const auto is_over = [&] {
    return is_sent() || !has_set_points_ || !all_ready() || !refusal().empty();
  };
  const auto waited = wait_until(is_over, sent_time);
  if (waited && *waited && is_sent()) return {};
  end_set_points();
  if (waited && !*waited) return *waited;
  std::string why = refusal();
  if (!all_ready()) why += (why.empty() ? "" : "; ") + why_not_ready_text();
  return obstacle(Obstacle::Kind::refused,
                  why.empty() ? "the set-points were not sent: no image shows them" : why);
}

/// Returns the reason why taktd has refused the newest values for one of these axes, or an empty
/// text.
std::string Axes::State::refusal() const {
  for (const Index axis : axes) {
    const std::string text =
        refusal_of(group.input().signals()[*group.axes().signals(axis).controlword].node);
    if (!text.empty()) return text;
  }
  return {};
}

/// Writes a value of an axis by its output if an RPDO carries the object, because the RPDO would
/// overwrite it, and otherwise by SDO. `index` is the object of the first axis of a device.
Done Axes::State::write_of_axis(Index axis, std::uint16_t index, std::int64_t raw,
                                std::size_t bytes) {
  const Object object = object_of_axis(axis, index);
  if (const auto place = place_of(object, Signals::outputs)) return set_raw(*place, raw);
  Data data;
  for (std::size_t i = 0; i < bytes; ++i) data.push_back(static_cast<std::uint8_t>(raw >> (8 * i)));
  const auto done = transfer("sdo_download", object, data);
  return done ? Done{} : std::unexpected{done.error()};
}

Axes::State::Object Axes::State::object_of_axis(Index axis, std::uint16_t index) const {
  constexpr int first_controlword = 0x6040;
  const signal_t& word = group.input().signals()[*group.axes().signals(axis).controlword];
  return {.node = word.node,
          .index = static_cast<std::uint16_t>(index + word.index - first_controlword)};
}

std::optional<std::size_t> Axes::State::place_of(const Object& object, Signals among) const {
  const std::vector<signal_t>& known = group.input().signals();
  for (std::size_t i = 0; i < known.size(); ++i) {
    const bool fits = among == Signals::all || known[i].output != 0;
    const bool same = known[i].index == object.index && known[i].sub == object.sub;
    if (fits && same && known[i].node == object.node) return i;
  }
  return std::nullopt;
}

Done Axes::State::write_profile(std::uint16_t index, const Eigen::VectorXd& values) {
  if (values.size() == 0) return {};
  if (values.size() != 1 && values.size() != size()) {
    return obstacle(
        Obstacle::Kind::wrong_use,
        fmt::format("expected one bound for each of {} axes, or one for all, got {} bounds", size(),
                    values.size()));
  }
  for (Index i = 0; i < size(); ++i) {
    const AxisSignals& known = group.axes().signals(in_group(i));
    const auto velocity = known.velocity ? known.velocity : known.target_velocity;
    const std::size_t place = velocity.value_or(*known.target_position);
    const double scale = std::abs(format_of(group.input().signals()[place]).scale);
    const double value = values(values.size() == 1 ? 0 : i);
    const double counts = std::nearbyint(value / scale);
    if (!(counts >= 1.0 && counts <= std::numeric_limits<std::uint32_t>::max())) {
      return obstacle(Obstacle::Kind::wrong_use,
                      fmt::format("{}: 0x{:04X} can't be {}", known.name, index, value));
    }
    const Done done =
        write_of_axis(in_group(i), index, static_cast<std::int64_t>(counts), sizeof(std::uint32_t));
    if (!done) return done;
  }
  return {};
}

Done Axes::State::profile_move(const Values& positions, const ProfileBounds& bounds,
                               const ProfileMove& how) {
  const SetPoints targets{.modes = {DriveMode::profile_position, DriveMode::profile_position},
                          .output = &AxisSignals::target_position,
                          .object = "0x607A"};
  if (Done ready = check_set_points(positions, targets); !ready) return ready;
  const Eigen::VectorXd& deceleration =
      bounds.deceleration.size() == 0 ? bounds.acceleration : bounds.deceleration;
  if (Done done = write_profile(profile_velocity, bounds.velocity); !done) return done;
  if (Done done = write_profile(profile_acceleration, bounds.acceleration); !done) return done;
  if (Done done = write_profile(profile_deceleration, deceleration); !done) return done;
  if (!profile_targets_) profile_targets_ = actual_positions();
  Eigen::VectorXd wanted = positions;
  if (how.relative) wanted += *profile_targets_;
  events_.clear();
  if (Done taken = hand_over(axes, wanted, how.timing); !taken) return taken;
  profile_targets_ = wanted;
  return how.wait ? wait_for_profiles(std::chrono::nanoseconds::max()) : Done{};
}

Eigen::VectorXd Axes::State::actual_positions() const {
  Eigen::VectorXd actual{Eigen::VectorXd::Zero(size())};
  for (Index i = 0; i < size(); ++i) actual(i) = group.axes().positions()(in_group(i));
  return actual;
}

/// Hands a set-point to the drives of these axes; `positions` has a value for each axis.
Done Axes::State::hand_over(std::span<const Index> chosen, const Values& positions,
                            SetPointTiming timing) {
  AxisControl& known = group.axes();
  known.set_positions(in_group(positions, std::numeric_limits<double>::quiet_NaN()));
  for (const Index axis : chosen) known.begin_set_point(axis, timing);
  const auto is_taken = [&](Index axis) { return known.set_point_taken(axis); };
  const auto is_over = [&] {
    return std::ranges::all_of(chosen, is_taken) || !all_enabled() || !refusal().empty();
  };
  const auto waited = wait_until(is_over, options.longest);
  if (waited && !*waited) return *waited;
  if (std::ranges::all_of(chosen, is_taken)) return {};
  std::string why = refusal();
  if (why.empty() && !all_enabled()) why = why_not_ready_text();
  if (why.empty()) {
    why = text_of_each(chosen, "{} has not taken its set-point: its statusword is 0x{:04X}");
  }
  return obstacle(Obstacle::Kind::refused, why);
}

/// Waits until the drives report that they have reached their targets.
Done Axes::State::wait_for_profiles(std::chrono::nanoseconds longest) {
  const AxisControl& known = group.axes();
  const std::int64_t patience = standing_time / std::max<std::chrono::nanoseconds>(
                                                    group.period(), std::chrono::nanoseconds{1000});
  std::optional<std::int64_t> begin;
  std::int64_t moved = 0;
  Eigen::VectorXd before = known.positions();
  const auto has_reached = [&](Index axis) {
    return known.set_point_taken(axis) && (known.statusword(axis) & target_reached) != 0;
  };
  const auto is_over = [&] {
    const std::int64_t cycle = group.input().cycle();
    if (!begin) begin = moved = cycle;
    if (known.positions() != before) moved = cycle;
    before = known.positions();
    const bool reached = cycle >= *begin + settled_cycles && all(has_reached);
    return reached || !all_ready() || cycle - moved > patience;
  };
  const auto waited = wait_until(is_over, longest);
  if (!waited) return obstacle(Obstacle::Kind::time_over, "the axes still move");
  if (!*waited) return *waited;
  if (!all_ready()) return obstacle(Obstacle::Kind::stopped, why_not_ready_text());
  if (all(has_reached)) return {};
  std::vector<Index> before_target;
  for (const Index axis : axes) {
    if (!has_reached(axis)) before_target.push_back(axis);
  }
  return obstacle(
      Obstacle::Kind::stopped,
      text_of_each(before_target,
                   "{} is at standstill, but its drive has not reached its target: bit 10 of its "
                   "statusword 0x{:04X} is 0"));
}

/// Brings axes to rest that are not in cyclic synchronous position mode. A drive in profile
/// position mode gets a Halt and then its own position as target, because otherwise the drive would
/// continue to its old target when the Halt ends.
Done Axes::State::stop_set_points() {
  profile_targets_.reset();
  const auto slowed = slow_down();
  end_set_points();
  if (slowed && !*slowed) return *slowed;
  AxisControl& known = group.axes();
  std::vector<Index> led;
  std::vector<Index> positioned;
  for (const Index axis : axes) {
    const DriveMode mode = known.mode(axis);
    if (is_in_mode_of_motions(axis) || !known.drive(axis).enabled()) continue;
    led.push_back(axis);
    const bool stands = known.set_point_taken(axis) && readiness_ != Readiness::halted &&
                        (known.statusword(axis) & target_reached) != 0;
    if (mode == DriveMode::profile_position && !stands) positioned.push_back(axis);
  }
  if (led.empty()) return {};
  for (const Index axis : positioned) known.halt(axis);
  const auto rested = wait_for_rest(led, Interruption::ignored);
  if (rested && !*rested) return *rested;
  if (!rested) {
    return obstacle(Obstacle::Kind::time_over,
                    text_of_each(led, "{} still moves: its statusword is 0x{:04X}"));
  }
  if (positioned.empty()) return {};
  if (Done done = hand_over(positioned, actual_positions(), SetPointTiming::immediately); !done) {
    return done;
  }
  if (readiness_ == Readiness::halted) return {};
  for (const Index axis : positioned) known.end_halt(axis);
  const auto is_free = [this](Index axis) { return !shows_halt(axis); };
  const auto waited = wait_until([&] { return std::ranges::all_of(positioned, is_free); },
                                 options.longest, Interruption::ignored);
  return waited ? *waited : obstacle(Obstacle::Kind::time_over, "no newer image has come");
}

}  // namespace takt
