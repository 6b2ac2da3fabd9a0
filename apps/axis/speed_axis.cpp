#include "apps/axis/speed_axis.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "apps/axis/group/speed_pattern.hpp"
#include "eds_parser/values/data_type.hpp"

namespace takt {
namespace {

constexpr std::int8_t sequence_of_cia402 = 1;
constexpr std::int8_t reset_by_level = 1;
/// Number of images in which the command "off" is sent before a fault reset, so that the drive sees
/// the change.
constexpr int steps_before_reset = 3;
/// Longest time for which the set speed changes in one step.
constexpr double longest_step = 0.05;
/// If the status word is missing in this number of images in sequence, the state of the drive is
/// unknown.
constexpr int most_silent_images = 3;
/// CiA 402-2, 0x6041.
constexpr unsigned state_bits = 0x6F;
constexpr unsigned operation_enabled = 0x27;

bool is_position(std::int32_t place, bool output, std::int16_t node, const ImageInput& input) {
  if (place < 0 || static_cast<std::size_t>(place) >= input.signals().size()) return false;
  const signal_t& signal = input.signals()[static_cast<std::size_t>(place)];
  return (signal.output != 0) == output && signal.node_id == node;
}

bool is_scale(double scale) noexcept { return std::isfinite(scale) && scale != 0.0; }

}  // namespace

bool SpeedAxis::is_usable(const speed_axis_t& words, const ImageInput& input) {
  const auto is = [&](std::int32_t place, bool output) {
    return is_position(place, output, words.node_id, input);
  };
  return is(words.control, true) && is(words.set_speed, true) && is(words.status, false) &&
         (words.actual_speed < 0 || is(words.actual_speed, false)) && is_scale(words.set_scale) &&
         is_scale(words.actual_scale);
}

void SpeedAxis::set_goal(SpeedGoal goal, double speed, double acceleration) noexcept {
  goal_ = goal;
  target_ = goal == SpeedGoal::running && std::isfinite(speed) ? speed : 0.0;
  acceleration_ = acceleration;
  if (goal == SpeedGoal::off) commanded_ = 0.0;
  drive_.set_goal(goal == SpeedGoal::off ? DriveGoal::disabled : DriveGoal::enabled);
}

void SpeedAxis::reset_fault() noexcept {
  reset_steps_ = 0;
  drive_.reset_fault();
}

void SpeedAxis::step(const ImageInput& input) noexcept {
  const double cycles = cycle_ < 0 ? 1.0 : static_cast<double>(input.cycle() - cycle_);
  cycle_ = input.cycle();
  if (is_stale(input)) return;  // the last command is held
  ramp(std::min(longest_step, cycles * static_cast<double>(input.period_ns()) * 1e-9));
  control_ = word_for_goal();
}

bool SpeedAxis::is_stale(const ImageInput& input) const noexcept {
  return input.stale(static_cast<std::size_t>(words_.status));
}

/// A single missing status word does not end a run.
void SpeedAxis::read(const ImageInput& input) noexcept {
  if (is_stale(input)) {
    if (silent_images_ < most_silent_images) ++silent_images_;
    if (silent_images_ == most_silent_images) state_ = SpeedState::unknown;
    return;
  }
  silent_images_ = 0;
  status_ = static_cast<std::uint16_t>(input.values()[static_cast<std::size_t>(words_.status)]);
  if (words_.actual_speed >= 0) {
    actual_counts_ = input.values()[static_cast<std::size_t>(words_.actual_speed)];
    const double way = shows(words_.reverse, status_) ? -1.0 : 1.0;
    actual_ = way * static_cast<double>(actual_counts_) * words_.actual_scale;
  }
  if (shows(words_.fault, status_)) {
    state_ = SpeedState::fault;
    if (!reset_steps_) set_goal(SpeedGoal::off);
    return;
  }
  reset_steps_.reset();
  leave_with_drive();
  const bool is_ready = words_.ready.mask == 0 || shows(words_.ready, status_);
  state_ = is_ready ? SpeedState::ready : SpeedState::not_ready;
}

/// A CiA 402 drive that has left Operation enabled by itself is not enabled again automatically.
void SpeedAxis::leave_with_drive() noexcept {
  if (words_.sequence != sequence_of_cia402) return;
  const bool is_enabled = (status_ & state_bits) == operation_enabled;
  if (was_enabled_ && !is_enabled) set_goal(SpeedGoal::off);
  was_enabled_ = is_enabled;
}

void SpeedAxis::ramp(double seconds) noexcept {
  if (acceleration_ <= 0.0) {
    commanded_ = target_;
    return;
  }
  const double most = acceleration_ * seconds;
  commanded_ += std::clamp(target_ - commanded_, -most, most);
}

std::int64_t SpeedAxis::word_for_goal() noexcept {
  if (words_.sequence == sequence_of_cia402) {
    const std::uint16_t word = drive_.step(status_);
    return drive_.enabled() && goal_ != SpeedGoal::off ? word_to_move() : word;
  }
  if (reset_steps_) return reset_word();
  return goal_ == SpeedGoal::off ? words_.off : word_to_move();
}

std::int64_t SpeedAxis::word_to_move() const noexcept {
  if (goal_ == SpeedGoal::standing && commanded_ == 0.0) return words_.stop;
  const bool back = commanded_ / words_.set_scale < 0.0;
  return back && words_.run_reverse >= 0 ? words_.run_reverse : words_.run;
}

std::int64_t SpeedAxis::reset_word() noexcept {
  if (words_.reset < 0) return words_.off;
  const int step = (*reset_steps_)++;
  const bool before = words_.fault_reset != reset_by_level && step < steps_before_reset;
  return before ? words_.off : words_.reset;
}

std::int64_t SpeedAxis::set_speed() const noexcept {
  const std::int64_t counts = std::llround(commanded_ / words_.set_scale);
  return words_.run_reverse >= 0 ? std::abs(counts) : counts;
}

bool SpeedAxis::can_hold(double speed, const ImageInput& input) const noexcept {
  const signal_t& signal = input.signals()[static_cast<std::size_t>(words_.set_speed)];
  const bool has_sign = is_signed(static_cast<DataType>(signal.data_type));
  const double counts = std::round(speed / words_.set_scale);
  const double most = std::ldexp(1.0, signal.bits - (has_sign ? 1 : 0)) - 1.0;
  if (!(std::abs(counts) <= most)) return false;
  return counts >= 0.0 || has_sign || words_.run_reverse >= 0;
}

bool SpeedAxis::stands() const noexcept {
  if (commanded_ != 0.0 || goal_ == SpeedGoal::running) return false;
  if (words_.standstill.mask != 0) return shows(words_.standstill, status_);
  if (words_.actual_speed >= 0) return std::abs(actual_counts_) <= 1;
  return !shows(words_.running, status_) || words_.sequence == sequence_of_cia402;
}

bool SpeedAxis::runs() const noexcept {
  return goal_ == SpeedGoal::running &&
         (words_.running.mask == 0 || shows(words_.running, status_));
}

std::string SpeedAxis::why_not_ready() const {
  const std::string word = fmt::format("its status word is 0x{:04X}", status_);
  switch (state_) {
    case SpeedState::unknown:
      return words_.node + ": its status word has not arrived";
    case SpeedState::fault:
      return fmt::format("{} has a fault: {}", words_.node, word);
    case SpeedState::not_ready:
      return words_.sequence == sequence_of_cia402
                 ? fmt::format("{} is not enabled, {}: {}", words_.node, name(drive_.state()), word)
                 : fmt::format("{} is not ready to run: {}", words_.node, word);
    case SpeedState::ready:
      return {};
  }
  return {};
}

}  // namespace takt
