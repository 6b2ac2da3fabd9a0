#include "master/sim/pdo/tpdo.hpp"

#include <algorithm>
#include <span>

#include "master/wire/bytes.hpp"

namespace takt::sim {

void Tpdo::start(Time now) noexcept {
  running_ = true;
  allowed_from_ = Time{};
  reconfigure(now);
}

void Tpdo::look_at_record() noexcept {
  active_ = running_ && record_.valid() && record_.multiplex() == Multiplex::none;
}

void Tpdo::reconfigure(Time now) noexcept {
  look_at_record();
  record_.compile(mapping_);
  type_ = record_.type();
  count_ = 0;
  sampled_ = started_ = false;
  seen_ = last_ = mapping_.pack();
  pending_ = traits_.reports_state_at_start && !only_answers() && (type_ == 0 || type_ >= 254);
  timer_ = runs_by_timer() ? now + record_.event_timer() : never;
  update_deadline();
}

bool Tpdo::runs_by_timer() const noexcept {
  const bool uses_timer = type_ >= 254 || (type_ == 0 && traits_.timer_at_sync);
  return uses_timer && record_.event_timer() != Time{};
}

bool Tpdo::only_answers() const noexcept {
  return traits_.answers_255 && type_ == 255 && record_.event_timer() == Time{};
}

/// Returns true if events cause a transmission. Only for the transmission types 0, 254 and 255.
bool Tpdo::has_events() const noexcept {
  if (traits_.timer == DeviceTraits::Timer::alone && runs_by_timer()) return false;
  return !only_answers();
}

Time Tpdo::inhibit() const noexcept {
  const Time counted = record_.inhibit() / std::chrono::microseconds{100} * traits_.inhibit_unit;
  return std::max(counted, traits_.inhibit_floor);
}

void Tpdo::update_deadline() noexcept {
  deadline_ = never;
  if (!active_) return;
  deadline_ = timer_;
  if (pending_ && type_ >= 254) deadline_ = std::min(deadline_, allowed_from_);
}

void Tpdo::sample_at_sync(std::uint8_t counter, Time ready, Time window_end,
                          Transmitter& out) noexcept {
  if (type_ == 252) {
    sample_ = mapping_.pack();
    sampled_ = true;
  } else if (type_ == 0) {
    const std::uint64_t data = mapping_.pack();
    if (pending_ || data != last_) send(data, ready, window_end, out);
    pending_ = false;
  } else if (type_ <= 240 && counts_to_its_turn(counter)) {
    send(mapping_.pack(), ready, window_end, out);
  }
}

/// Returns true if the TPDO is due at this SYNC: at the SYNC whose counter equals the start value,
/// and from there at every n-th.
bool Tpdo::counts_to_its_turn(std::uint8_t counter) noexcept {
  const std::uint8_t start = record_.sync_start();
  if (start != 0 && counter != 0 && !started_) {
    if (counter != start) return false;
    started_ = true;
    count_ = 0;
    return true;
  }
  if (++count_ < type_) return false;
  count_ = 0;
  return true;
}

/// For an event-driven PDO a remote request is one more event, so the inhibit time applies.
void Tpdo::on_request(Time ready, Transmitter& out) noexcept {
  if (!active_ || !record_.rtr_allowed() || !traits_.answers_rtr) return;
  if (type_ == 252) {
    if (sampled_) send(sample_, ready, never, out);
  } else if (type_ == 253) {
    send(mapping_.pack(), ready, never, out);
  } else if (type_ >= 254) {
    pending_ = true;
    event(ready, out);
  }
}

void Tpdo::answer(Time ready, Transmitter& out) noexcept {
  if (only_answers() && running_ && record_.valid()) send(mapping_.pack(), ready, never, out);
}

void Tpdo::look_for_event(Time now, Transmitter& out) noexcept {
  const std::uint64_t data = mapping_.pack();
  if (type_ == 0) {
    if (data != seen_ && !traits_.compares_samples) pending_ = true;
  } else {
    if (data != last_) pending_ = true;
    if (pending_) event(now, out);
  }
  seen_ = data;
}

void Tpdo::on_time(Time now, Transmitter& out) noexcept {
  if (now < deadline_) return;
  if (now >= timer_) {
    pending_ = true;
    timer_ += record_.event_timer();
    if (traits_.timer == DeviceTraits::Timer::alone) allowed_from_ = Time{};
  }
  if (type_ == 0) return update_deadline();  // the event waits for SYNC
  event(now, out);
}

/// Within the inhibit time an event is delayed, not lost; several events become one frame.
void Tpdo::event(Time ready, Transmitter& out) noexcept {
  if (ready >= allowed_from_) send(mapping_.pack(), ready, never, out);
  update_deadline();
}

void Tpdo::send(std::uint64_t data, Time ready, Time expires, Transmitter& out) noexcept {
  Frame frame{.id = record_.id(), .length = mapping_.bytes()};
  store_le(std::span{frame.data}, data);
  out.send(frame, ready, expires);
  seen_ = last_ = data;
  if (type_ < 253) return;
  pending_ = false;
  allowed_from_ = ready + inhibit();
  if (runs_by_timer() && traits_.timer == DeviceTraits::Timer::restarts) {
    timer_ = ready + record_.event_timer();
  }
  update_deadline();
}

}  // namespace takt::sim
