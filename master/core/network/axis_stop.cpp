#include "master/core/network/axis_stop.hpp"

#include <algorithm>

namespace takt {
namespace {

constexpr Time silent_after = std::chrono::milliseconds{500};

}  // namespace

/// Takes a value. `within` states whether it is inside the window. If it is the first value of a
/// rest, the rest begins at `from`.
void Standstill::rest(Time from, Time now, bool within) noexcept {
  if (!within || !resting_) {
    since_ = last_ = from;
    pause_ = Time{};
  }
  pause_ = std::max(pause_, now - last_);
  samples_ = within ? samples_ + 1 : 0;
  resting_ = within;
  last_ = now;
  measured_ = true;
}

void Standstill::take(Time now, const AxisSample& sample) noexcept {
  // A value that was read by SDO was measured at some time between the request and the answer.
  const Time asked = sample.motion_asked.value_or(now);
  if (sample.velocity) {
    velocity_ = *sample.velocity;
    velocity_at_ = now;
    from_ = asked;
    by_position_ = false;
    rest(now, now, std::abs(velocity_) <= velocity_window_);
    if (sample.position) set_anchor(now, asked, *sample.position);
    return;
  }
  if (!sample.position) return;
  // The velocity that the drive itself reports takes precedence while it is new.
  if (velocity_at_ && now - *velocity_at_ < standstill_time) {
    return set_anchor(now, asked, *sample.position);
  }
  take_position(now, asked, *sample.position);
}

void Standstill::set_anchor(Time now, Time asked, std::int64_t position) noexcept {
  anchor_ = position_ = position;
  position_at_ = anchor_at_ = now;
  anchor_from_ = asked;
}

void Standstill::take_position(Time now, Time asked, std::int64_t position) noexcept {
  by_position_ = true;
  if (!position_at_) {
    samples_ = 1;
    return set_anchor(now, asked, position);
  }
  if (now > *position_at_) {
    const double seconds = std::chrono::duration<double>(now - *position_at_).count();
    velocity_ = static_cast<std::int64_t>(static_cast<double>(position - position_) / seconds);
  }
  position_ = position;
  position_at_ = now;
  from_ = anchor_from_;
  const bool within = std::abs(position - anchor_) <= position_window_;
  rest(anchor_at_, now, within);
  if (within) return;
  set_anchor(now, asked, position);
  samples_ = 1;
}

namespace {

AxisState first_state(AxisPrior prior) noexcept {
  switch (prior) {
    case AxisPrior::untouched:
      return AxisState::exempt;
    case AxisPrior::heard:
      return AxisState::asked;
    case AxisPrior::disabled:
      return AxisState::rested;
    case AxisPrior::exposed:
    case AxisPrior::foreign:
      return AxisState::unseen;
  }
  return AxisState::unseen;
}

}  // namespace

void AxisStop::begin(Time now, AxisPrior prior) noexcept {
  state_ = first_state(prior);
  prior_ = prior;
  commanded_ = false;
  entered_ = answered_ = now;
}

/// The transitions of an axis. Observations that are not listed change nothing.
///
///   state     seen                                     next
///   unseen    it is enabled                            braking
///   unseen    it is disabled, no command before        exempt
///   unseen    it is disabled after a command           as braking: it may have been enabled
///   asked, rested: as unseen
///   braking   enabled, certainly at standstill         standing
///   braking   disabled, and drops()                    dropped
///   braking   disabled                                 settling
///   braking   disabled, certainly at standstill        stopped
///   standing  disabled, and drops()                    dropped
///   standing  disabled                                 stopped
///   standing  enabled, moves again                     braking
///   settling  disabled, certainly at standstill        stopped
///   settling  disabled, a value after the grace moves  dropped
///   settling  enabled again                            braking
///   braking   the time is over: see cut()              cut
AxisState AxisStop::next(AxisState state, Seen seen) noexcept {
  using enum AxisState;
  const bool enabled = seen == Seen::powered || seen == Seen::standing;
  switch (state) {
    case unseen:
    case asked:
    case rested:
      return enabled ? braking : exempt;
    case braking:
      if (!enabled) return seen == Seen::off_rest ? stopped : settling;
      return seen == Seen::standing ? standing : braking;
    case standing:
      if (!enabled) return stopped;
      return seen == Seen::powered ? braking : standing;
    case settling:
      if (enabled) return braking;
      if (seen == Seen::off_move) return dropped;
      return seen == Seen::off_rest ? stopped : settling;
    case exempt:
    case stopped:
    case cut:
    case dropped:
      return state;
  }
  return state;
}

AxisStop::Seen AxisStop::judge() const noexcept {
  if (powered_) return standstill_.certain() ? Seen::standing : Seen::powered;
  if (standstill_.certain()) return Seen::off_rest;
  return standstill_.moves_after(entered_, settling_grace) ? Seen::off_move : Seen::off;
}

void AxisStop::go(AxisState state, Time now) noexcept {
  if (state == state_) return;
  if (state == AxisState::settling) velocity_then_ = standstill_.velocity();
  state_ = state;
  entered_ = now;
}

void AxisStop::recall(std::optional<std::int64_t> statusword,
                      std::optional<std::int64_t> velocity) noexcept {
  if (statusword && disabled(*statusword)) {
    motion_ = Motion::rests;
  } else if (velocity) {
    motion_ = standstill_.rests_at(*velocity) ? Motion::rests : Motion::moves;
    velocity_enabled_ = *velocity;
  }
}

/// Notes the motion of an enabled axis. A value counts only when a statusword shows that the axis
/// was still enabled when it was measured.
void AxisStop::note_motion(Time now, const AxisSample& sample) noexcept {
  if (!sample.statusword || !powered_) return;
  if (standstill_.moves()) {
    motion_ = Motion::moves;
    velocity_enabled_ = standstill_.velocity();
  } else if (standstill_.rests(sample.word_asked.value_or(now))) {
    motion_ = Motion::rests;
  }
}

/// Returns true if this statusword shows that an axis in this state was disabled before it stood
/// still. A drive without power may report the velocity 0 although its axis coasts, so only values
/// from the time before it was disabled count. If 0x605A is 0, these values must have shown the
/// standstill. If the drive is in the state "fault", they must not have shown a motion. All other
/// drives may disable themselves at the end of the ramp.
bool AxisStop::drops(AxisState state, std::int64_t statusword) const noexcept {
  if (!disabled(statusword)) return false;
  const bool brakes = state == AxisState::braking;
  if (coasts_ && (brakes || state == AxisState::standing)) return motion_ != Motion::rests;
  const bool fault = (statusword & 0x4F) == 0x08;
  return brakes && fault && motion_ == Motion::moves;
}

void AxisStop::step(Time now, const AxisSample& sample) noexcept {
  if (!sample.empty()) answered_ = now;
  standstill_.take(now, sample);
  if (sample.statusword) powered_ = !disabled(*sample.statusword);
  disabled_seen_ = disabled_seen_ || (sample.statusword && !powered_);
  note_motion(now, sample);
  if (!seen() && !sample.statusword) return;
  // A velocity without a statusword does not show whether the axis is enabled.
  const bool needs_word = state_ == AxisState::standing || state_ == AxisState::braking;
  if (needs_word && !sample.statusword && !standstill_.certain()) return;
  // An axis leaves `standing` only if its newest value lies outside the window. It stays in this
  // state after a value inside the window, even if the standstill is not certain at this moment.
  if (state_ == AxisState::standing && powered_ && !standstill_.moves()) return;
  const bool in_doubt = state_ == AxisState::unseen && commanded_;
  const AxisState state = in_doubt ? AxisState::braking : state_;
  if (!sample.statusword || !drops(state, *sample.statusword)) return go(next(state, judge()), now);
  unproven_ = motion_ == Motion::unknown;
  velocity_then_ = velocity_enabled_;
  go(AxisState::dropped, now);
}

void AxisStop::cut() noexcept {
  if (state_ != AxisState::braking) return;
  velocity_then_ = standstill_.velocity();
  state_ = AxisState::cut;
}

bool AxisStop::settled() const noexcept {
  switch (state_) {
    case AxisState::rested:
    case AxisState::exempt:
    case AxisState::stopped:
    case AxisState::dropped:
      return true;
    case AxisState::cut:
      return disabled_seen_;
    case AxisState::unseen:
    case AxisState::asked:
    case AxisState::braking:
    case AxisState::standing:
    case AxisState::settling:
      return false;
  }
  return false;
}

std::int64_t AxisStop::controlword() const noexcept {
  const bool brakes = !seen() || state_ == AxisState::braking;
  return brakes ? quick_stop_word : disable_voltage_word;
}

std::int64_t AxisStop::velocity() const noexcept {
  const bool disabled_then =
      state_ == AxisState::settling || state_ == AxisState::cut || state_ == AxisState::dropped;
  return disabled_then ? velocity_then_ : standstill_.velocity();
}

AxisVerdict AxisStop::verdict(Time now, bool exchanging) const noexcept {
  if (confirmed()) return AxisVerdict::stopped;
  if (state_ == AxisState::unseen && refusal_ != 0) return AxisVerdict::refused;
  const bool answers = silence(now) < silent_after;
  if (state_ == AxisState::dropped && unproven_) return AxisVerdict::unproven;
  if (state_ == AxisState::dropped || (state_ == AxisState::cut && disabled_seen_)) {
    return AxisVerdict::moving;
  }
  if (!answers) return exchanging ? AxisVerdict::silent : AxisVerdict::lost;
  if (state_ == AxisState::settling) return AxisVerdict::moving;
  return state_ == AxisState::unseen ? AxisVerdict::silent : AxisVerdict::enabled;
}

}  // namespace takt
