#include <takt/drive402.hpp>

namespace takt {
namespace {

constexpr std::uint16_t disable_voltage = 0x0000;
constexpr std::uint16_t quick_stop = 0x0002;
constexpr std::uint16_t shutdown = 0x0006;
constexpr std::uint16_t switch_on = 0x0007;  // "disable operation" in Operation enabled
constexpr std::uint16_t enable_operation = 0x000F;
constexpr std::uint16_t fault_reset = 0x0080;

std::uint16_t word_to_enable(State402 state) noexcept {
  using enum State402;
  if (state == switch_on_disabled) return shutdown;
  if (state == ready_to_switch_on) return switch_on;
  const bool on = state == switched_on || state == operation_enabled;
  return on ? enable_operation : disable_voltage;
}

std::uint16_t word_to_disable(State402 state) noexcept {
  if (state == State402::operation_enabled) return switch_on;
  return state == State402::switched_on ? shutdown : disable_voltage;
}

std::uint16_t word_to_quick_stop(State402 state) noexcept {
  const bool moving = state == State402::operation_enabled || state == State402::quick_stop_active;
  return moving ? quick_stop : word_to_disable(state);
}

}  // namespace

void DriveSequence::set_goal(DriveGoal goal) noexcept {
  if (goal == goal_) return;
  goal_ = goal;
  was_enabled_ = false;
  waited_ = 0;
}

void DriveSequence::reset_fault() noexcept {
  resetting_ = in_fault();
  reset_steps_ = 0;
  waited_ = 0;
}

std::uint16_t DriveSequence::step(std::uint16_t statusword, Enabling enabling) noexcept {
  const auto state = decode_statusword(statusword);
  unknown_ = !state;
  notice(state.value_or(state_));
  return resetting_ ? reset_word() : word_for_goal(enabling);
}

void DriveSequence::notice(State402 state) noexcept {
  waited_ = state != state_ || (reached() && !resetting_) ? 0 : waited_ + 1;
  state_ = state;
  if (enabled()) was_enabled_ = true;
  const bool left_by_itself = goal_ == DriveGoal::enabled && was_enabled_ && !enabled();
  if (left_by_itself || (in_fault() && !resetting_)) set_goal(DriveGoal::disabled);
  if (!in_fault() || stuck()) resetting_ = false;
}

std::uint16_t DriveSequence::reset_word() noexcept {
  if (state_ != State402::fault) return disable_voltage;  // The fault reaction must end first.
  if (reset_steps_ == limits_.reset_low_steps) return fault_reset;
  ++reset_steps_;
  return disable_voltage;
}

std::uint16_t DriveSequence::word_for_goal(Enabling enabling) const noexcept {
  if (goal_ == DriveGoal::quick_stopped) return word_to_quick_stop(state_);
  const bool enables = goal_ == DriveGoal::enabled && (enabling == Enabling::goes_on || enabled());
  return enables ? word_to_enable(state_) : word_to_disable(state_);
}

bool DriveSequence::in_fault() const noexcept {
  return state_ == State402::fault || state_ == State402::fault_reaction_active;
}

bool DriveSequence::reached() const noexcept {
  using enum State402;
  if (goal_ == DriveGoal::enabled) return enabled();
  if (goal_ == DriveGoal::quick_stopped) {
    return state_ == quick_stop_active || state_ == switch_on_disabled;
  }
  return state_ == switch_on_disabled || state_ == not_ready_to_switch_on || state_ == fault;
}

}  // namespace takt
