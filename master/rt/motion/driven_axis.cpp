#include "master/rt/motion/driven_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "eds_parser/table/axis_modes.hpp"

namespace takt {
namespace {

using motion::AxisCondition;
using motion::AxisState;

constexpr std::int64_t halt = 0x100;  // bit of the controlword, CiA 402-2, 0x6040

/// Bit 12 of the statusword. In the mode cyclic synchronous position, the drive follows the target
/// position; in the mode interpolated position, the mode is active. CiA 402-2, 0x6041.
constexpr std::int64_t follows_command = 0x1000;

/// Returns the condition that the statusword shows. CiA 402-2, 0x6041.
AxisCondition condition_of(std::int64_t statusword) noexcept {
  if ((statusword & 0x6F) == 0x27) return AxisCondition::enabled;
  const std::int64_t state = statusword & 0x4F;
  return state == 0x0F || state == 0x08 ? AxisCondition::fault : AxisCondition::disabled;
}

constexpr std::int64_t homing_mode = 6;  // CiA 402-2, 0x6061

/// Bit 4 of the controlword in the modes homing and interpolated position. CiA 402-2.
constexpr std::int64_t homing_start = 0x10;
constexpr std::int64_t enables_interpolation = 0x10;

/// Longest time for which a drive may show the result of an earlier homing run.
constexpr Time homing_patience = std::chrono::milliseconds{500};

bool moves(const motion::AxisReport& report) noexcept {
  return report.state == AxisState::moving || report.state == AxisState::stopping;
}

struct RawRange {
  std::int64_t low = std::numeric_limits<std::int16_t>::min();
  std::int64_t high = std::numeric_limits<std::int16_t>::max();
};

/// Returns the raw values that `limits:` permits for this signal, within the range of INTEGER16.
RawRange torque_range_of(const BusPlan& plan, SignalIndex signal) noexcept {
  RawRange range;
  for (const OutputLimit& limit : plan.limits.outputs) {
    if (limit.signal != signal) continue;
    const double low = std::ceil(std::max(limit.low, static_cast<double>(range.low)));
    const double high = std::floor(std::min(limit.high, static_cast<double>(range.high)));
    range = {.low = static_cast<std::int64_t>(low), .high = static_cast<std::int64_t>(high)};
  }
  return range;
}

}  // namespace

DrivenAxis::DrivenAxis(const MotionAxis& axis, const BusPlan& plan)
    : axis_{axis},
      position_{scale_of(plan, axis.position)},
      target_{scale_of(plan, axis.target)},
      row_{plan.layout.signals[axis.target].row},
      longest_wait_{longest_wait_of(plan, axis.target)},
      homing_{
          static_cast<std::uint32_t>(homing_patience / std::max(plan.cycle.period, Time{1000}))} {
  position_.turn = target_.turn = axis.turn;
  if (axis.velocity) velocity_ = scale_of(plan, *axis.velocity);
  if (axis.velocity_offset) velocity_offset_ = scale_of(plan, *axis.velocity_offset);
  if (axis.torque_offset) {
    torque_offset_ = scale_of(plan, *axis.torque_offset);
    const RawRange range = torque_range_of(plan, *axis.torque_offset);
    lowest_torque_ = range.low;
    highest_torque_ = range.high;
  }
  for (std::size_t i = plan.layout.inputs; i < plan.layout.signals.size(); ++i) {
    if (plan.layout.signals[i].node_index != axis.node_index) continue;
    node_outputs_.push_back(static_cast<SignalIndex>(i));
  }
}

DrivenAxis::Scale DrivenAxis::scale_of(const BusPlan& plan, SignalIndex signal) noexcept {
  return {.scale = plan.layout.signals[signal].scale, .offset = plan.layout.signals[signal].offset};
}

/// Returns the raw value of a number, or std::nullopt if INTEGER32 can't hold it.
std::optional<std::int64_t> DrivenAxis::Scale::raw(double number) const noexcept {
  const double counts = turn.inside(std::round((number - offset) / scale));
  constexpr double largest = std::numeric_limits<std::int32_t>::max();
  const double smallest = turn.length > 0.0 ? turn.lowest : -largest;
  if (!(counts >= smallest && counts <= largest)) return std::nullopt;
  return static_cast<std::int64_t>(counts);
}

/// Returns the number of beats for which a set-point may wait for its frame, for example until the
/// n-th cycle or until an inhibit time is over. The number is at least 1, so one missing frame is
/// tolerated, as one missing SYNC is.
std::uint32_t DrivenAxis::longest_wait_of(const BusPlan& plan, SignalIndex signal) noexcept {
  const PdoRow& pdo = plan.pdos.rpdos[plan.layout.signals[signal].row];
  if (pdo.cyclic()) return pdo.transmission;
  if (pdo.synchronous() || plan.cycle.period <= Time{0}) return 1;
  return 1U + static_cast<std::uint32_t>((pdo.inhibit + plan.cycle.period - Time{1}) /
                                         plan.cycle.period);
}

AxisCondition DrivenAxis::condition(PdoExchange& pdos, bool exchanging) noexcept {
  const WorkingImage& image = pdos.image();
  const RpdoStatus rpdo = pdos.outputs().status(row_);
  count_unsent(rpdo, image.values[axis_.target]);
  ignores_target_ = obeys_halt_ = false;
  if (!exchanging) return AxisCondition::lost;
  if (image.is_stale(axis_.statusword)) return without_statusword();
  silent_beats_ = 0;
  const AxisCondition found = condition_of(image.values[axis_.statusword]);
  const auto wanted_mode = static_cast<std::int64_t>(axis_.mode_of_motions);
  const std::int64_t mode = axis_.mode ? image.values[*axis_.mode] : wanted_mode;
  ignores_target_ =
      found != AxisCondition::enabled || !rpdo.ready || !follows(AxisQuantity::position, mode);
  if (found != AxisCondition::enabled) return found;
  if (mode != wanted_mode || !rpdo.ready) return AxisCondition::disabled;
  if (unsent_beats_ > longest_wait_) return AxisCondition::unsent;
  const bool follows_it = (image.values[axis_.statusword] & follows_command) != 0;
  tells_following_ |= follows_it;
  if (!interpolates(image, follows_it)) {
    ignores_target_ = true;
    return AxisCondition::inactive;
  }
  const bool halted = axis_.controlword && (image.values[*axis_.controlword] & halt) != 0;
  obeys_halt_ = halted && tells_following_ && !follows_it;
  return halted ? AxisCondition::halted : found;
}

/// Returns false if the drive is in interpolated position mode and takes no points. It takes points
/// if bit 4 of the controlword is set. If its buffer runs empty, it ends the mode by itself, and
/// clears bit 12 of its statusword.
bool DrivenAxis::interpolates(const WorkingImage& image, bool shows_activity) const noexcept {
  if (axis_.mode_of_motions != MotionMode::interpolated_position) return true;
  const bool wanted =
      !axis_.controlword || (image.values[*axis_.controlword] & enables_interpolation) != 0;
  return wanted && (shows_activity || !tells_following_);
}

/// Counts the beats in a row in which a new target position was not sent. A target position that
/// does not change needs no frame.
void DrivenAxis::count_unsent(const RpdoStatus& rpdo, std::int64_t target) noexcept {
  if (rpdo.sent != frames_) sent_target_ = target;
  frames_ = rpdo.sent;
  unsent_beats_ = target != sent_target_ ? std::min(unsent_beats_, longest_wait_) + 1 : 0;
}

AxisCondition DrivenAxis::without_statusword() noexcept {
  if (silent_beats_ < most_silent_beats) ++silent_beats_;
  const AxisCondition last =
      silent_beats_ == most_silent_beats ? AxisCondition::silent : condition_;
  const bool may_follow = last == AxisCondition::enabled || last == AxisCondition::silent;
  return may_follow && unsent_beats_ > longest_wait_ ? AxisCondition::unsent : last;
}

/// Returns the state of homing. The controlword of the image is the one that was sent last.
motion::HomingState DrivenAxis::homing(const PdoExchange& pdos, bool exchanging) noexcept {
  const WorkingImage& image = pdos.image();
  in_homing_mode_ = axis_.mode && image.values[*axis_.mode] == homing_mode;
  const bool starts = axis_.controlword && (image.values[*axis_.controlword] & homing_start) != 0;
  return homing_.step(
      {.heard = exchanging,
       .fresh = !image.is_stale(axis_.statusword),
       .homing = in_homing_mode_ && starts &&
                 condition_of(image.values[axis_.statusword]) == AxisCondition::enabled,
       .statusword = static_cast<std::uint16_t>(image.values[axis_.statusword])});
}

/// While the actual position is missing, the following error counts as unchanged. Until the drive
/// is enabled, the positions of a rotary axis lie inside its turn; after that, they are the
/// positions nearest to the commanded one.
motion::AxisInput DrivenAxis::read(PdoExchange& pdos, bool exchanging,
                                   const motion::AxisReport& last) noexcept {
  const WorkingImage& image = pdos.image();
  condition_ = condition(pdos, exchanging);
  motion::AxisInput input{.condition = condition_,
                          .homing = homing(pdos, exchanging),
                          .actual = last.actual,
                          .set_point = {},
                          .is_unsent = unsent_beats_ >= longest_wait_};
  const bool starts = last.state == AxisState::unpowered;
  const auto position_of = [&](const Scale& scale, std::int64_t raw) {
    return starts ? scale.number(raw) : scale.number_near(raw, last.commanded.position);
  };
  input.actual.position = image.is_stale(axis_.position)
                              ? last.commanded.position - last.following_error
                              : position_of(position_, image.values[axis_.position]);
  if (axis_.velocity) input.actual.velocity = velocity_.number(image.values[*axis_.velocity]);
  const std::int64_t target = image.values[axis_.target];
  if (target != written_) writer_ = Writer::others;
  const bool by_motion = writer_ == Writer::motion || writer_ == Writer::in_motion;
  if ((starts || !by_motion) && pdos.outputs().known(axis_.target)) {
    input.set_point = position_of(target_, target);
  }
  follows_actual_ = obeys_halt_ && by_motion && last.state == AxisState::standing;
  if (follows_actual_) input.set_point = input.actual.position;
  return input;
}

/// In the beat in which a motion ends, the motion still commands the output: set-points that others
/// have sent during the motion must not take effect after it.
bool DrivenAxis::write(PdoOutputs& outputs, const motion::AxisReport& report,
                       OutputMoment moment) noexcept {
  if (report.delay != 0) outputs.pass_over(axis_.target, report.delay, moment);
  if (moves(report)) return lead(outputs, report.commanded, moment);
  const bool ends = report.state == AxisState::standing && writer_ == Writer::in_motion;
  if (ends) return end_motion(outputs, report.commanded, moment);
  stop_leading(outputs);
  if (report.state == AxisState::standing) {
    if (follows_actual_) follow_actual(outputs, report, moment);
    return true;
  }
  const auto raw = target_.raw(report.actual.position);
  const bool by_others =
      writer_ == Writer::others && !outputs.is_seeded(axis_.target) && !in_homing_mode_;
  if (by_others || !ignores_target_ || !raw || !outputs.trail(axis_.target, *raw)) return true;
  written_ = *raw;
  if (writer_ != Writer::others) clear_offsets(outputs);
  return true;
}

/// Returns the torque offset of a state. An acceleration at the limits of the motion may need more
/// torque than the limit of torque; the drive then gets the largest torque that is permitted.
std::int64_t DrivenAxis::torque(const motion::State& state) const noexcept {
  const FeedForwardPlan& plan = axis_.feed_forward;
  const double wanted =
      plan.torque_per_acceleration * state.acceleration + plan.torque_per_velocity * state.velocity;
  const double counts =
      std::clamp(wanted / torque_offset_.scale, static_cast<double>(lowest_torque_),
                 static_cast<double>(highest_torque_));
  return std::llround(counts);
}

bool DrivenAxis::lead_offsets(PdoOutputs& outputs, std::int64_t speed, std::int64_t torque,
                              OutputMoment moment) noexcept {
  if (axis_.velocity_offset && !outputs.lead(*axis_.velocity_offset, speed, moment)) return false;
  return !axis_.torque_offset || outputs.lead(*axis_.torque_offset, torque, moment);
}

/// Commands the set-points of a motion. If a set-point is refused, the target position does not
/// change, so the offsets become 0.
bool DrivenAxis::lead(PdoOutputs& outputs, const motion::State& state,
                      OutputMoment moment) noexcept {
  const auto raw = target_.raw(state.position);
  const auto speed = velocity_offset_.raw(state.velocity);
  const bool target_taken = raw && speed && outputs.lead(axis_.target, *raw, moment);
  if (target_taken) written_ = *raw;
  const bool taken = target_taken && lead_offsets(outputs, *speed, torque(state), moment);
  if (taken) {
    writer_ = Writer::in_motion;
  } else if (target_taken || writer_ != Writer::others) {
    writer_ = Writer::refused;
    clear_offsets(outputs);
  }
  return taken;
}

/// Commands the last set-points of a motion. If the target position is that of the previous beat,
/// the axis stands still at once, whatever its speed was, and no limit is checked.
bool DrivenAxis::end_motion(PdoOutputs& outputs, const motion::State& state,
                            OutputMoment moment) noexcept {
  if (target_.raw(state.position) == written_) {
    outputs.hold(axis_.target, moment);
    clear_offsets(outputs);
  } else if (!lead(outputs, state, moment)) {
    return false;
  }
  writer_ = Writer::motion;
  return true;
}

/// Makes the target position follow the actual position. A drive that was stopped by a Halt stands
/// at another position, and must not move back when the Halt ends.
void DrivenAxis::follow_actual(PdoOutputs& outputs, const motion::AxisReport& report,
                               OutputMoment moment) noexcept {
  const auto raw = target_.raw(report.commanded.position);
  if (raw && outputs.settle(axis_.target, *raw, moment)) written_ = *raw;
}

void DrivenAxis::clear_offsets(PdoOutputs& outputs) const noexcept {
  if (axis_.velocity_offset) outputs.trail(*axis_.velocity_offset, 0);
  if (axis_.torque_offset) outputs.trail(*axis_.torque_offset, 0);
}

void DrivenAxis::stop_leading(PdoOutputs& outputs) noexcept {
  outputs.release_lead(axis_.target);
  if (axis_.velocity_offset) outputs.release_lead(*axis_.velocity_offset);
  if (axis_.torque_offset) outputs.release_lead(*axis_.torque_offset);
  if (writer_ == Writer::in_motion) writer_ = Writer::motion;
}

}  // namespace takt
