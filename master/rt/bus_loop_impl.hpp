#pragma once
// Member functions of BusLoop, in the order of a cycle.
#include "master/rt/bus_loop.hpp"
#include "master/wire/sync.hpp"

namespace takt {

template <Port P, FrontLink L, Services S>
BusLoop<P, L, S>::BusLoop(const BusPlan& plan, P& port, L front, BusLoopOptions options)
    : plan_{plan},
      port_{port},
      front_{front},
      exchange_{front_.exchange()},
      options_{options},
      pdos_{plan, events_},
      network_{plan, {.observe = options.observe, .nmt_stop = NmtStop::after_axes}},
      pdo_requests_{plan},
      time_{plan.time},
      stop_{plan},
      halt_{plan},
      memory_(stop_.axes().size()),
      stop_requests_{plan},
      fallbacks_{plan},
      port_watch_{events_},
      clock_{plan.cycle.period},
      counter_{plan.cycle.sync_overflow},
      hold_{plan},
      gate_{plan.cycle.period},
      follower_{plan.cycle, events_},
      prediction_{plan.cycle.sync ? plan.cycle.receive_window : Time{0}},
      wire_{plan.bitrate},
      received_(batch),
      quick_stopped_(stop_.axes().size()) {
  StateSize size;
  keep(size);
  state_words_ = size.count();
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::start() noexcept {
  const Time now = port_.now();
  last_sync_ = now;
  clock_.start(now + clock_.period());
  network_.start(now);
  predict_next_publish(now);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::cycle() noexcept {
  front_.begin_cycle(clock_.cycle());
  follow_nodes();
  wait_for_beat();
  begin_beat();
  receive();
  publish();
  keep_state();
  finish_cycle();
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::finish_cycle() noexcept {
  serve();
  stop_drives_after_loss();
  send_outputs();
  give_events();
  write_status();
  clock_.next();
}

/// Updates which nodes exchange PDOs in this cycle.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::follow_nodes() noexcept {
  hearing_ = false;
  for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
    const bool exchanging = network_.exchanges_pdos(i);
    if (exchanging != exchanging_[i]) {
      exchanging_[i] = exchanging;
      if (exchanging) {
        pdos_.outputs().open(i, front_.set_points().points);
        pdos_.outputs().learn(i, network_.limits_read(i), {clock_.cycle(), port_.now()});
      } else {
        pdos_.outputs().shut(i);
      }
    }
    // A master that only observes and does not know SYNC cannot wait for answers to it.
    const bool beats = !options_.observe || follower_.used();
    // At the end of an ordered stop, a heartbeat sent before the last NMT command may still report
    // OPERATIONAL.
    const Reception beating = stop_.axes_done() ? Reception::early : Reception::full;
    const Reception heard = beats ? beating : Reception::listening;
    const bool listen = options_.observe || !plan_.nodes[i].boot;
    hearing_ = hearing_ || exchanging || listen;
    const Reception expected = network_.starts(i) ? Reception::early : Reception::off;
    const Reception unheard = listen ? Reception::listening : expected;
    pdos_.inputs().set_reception(i, exchanging ? heard : unheard);
  }
}

/// If earlier frames could not leave yet, no other frames may follow them.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::look_at_wire() noexcept {
  if (gate_.doubtful(port_.news())) drain();
  gate_open_ = gate_.open(port_.news(), sync_sent_);
  if (!gate_open_) {
    note_held();
    ++held_;
    ++status_.cycles_missed;
  } else if (held_ != 0) {
    tell(EventKind::cycles_missed, sync_sent_, static_cast<std::int64_t>(held_),
         static_cast<std::uint32_t>(held_because_));
    held_ = 0;
  }
}

/// A late cycle explains only the cycle that follows it. A controller error explains all held
/// cycles, because the controller may report it some cycles later.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::note_held() noexcept {
  const PortNews news = port_.news();
  if (held_ != 0 && held_because_ == MissedBecause::wire_blocked) return;
  held_because_ = MissedBecause::not_seen;
  if (held_ == 0 && late_cycle_) held_because_ = MissedBecause::sent_late;
  if (news.bus_off || news.error_passive) held_because_ = MissedBecause::wire_blocked;
}

/// Returns the time at which the loop publishes the image of this cycle, whatever is missing in it.
template <Port P, FrontLink L, Services S>
Time BusLoop<P, L, S>::end_of_window() const noexcept {
  return std::min(sync_sent_ + plan_.cycle.receive_window,
                  clock_.deadline() + plan_.cycle.output_deadline);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::receive() noexcept {
  const Time end = end_of_window();
  // While no node exchanges PDOs (all nodes still boot), the services get the whole slack.
  if (plan_.cycle.sync && hearing_) {
    // If only event-driven PDOs are mapped, there is no arrival to learn; half of the window leaves
    // room for services.
    const bool nothing_due = pdos_.inputs().expected() == 0 && !prediction_.learned();
    const Time wait = nothing_due ? plan_.cycle.receive_window / 2 : prediction_.predicted();
    port_.sleep_until(std::min(sync_sent_ + wait, end));
  }
  drain();
  const bool in_time = pdos_.inputs().complete();
  if (!in_time) await_rest(end);
  learn(in_time);
}

/// Takes PDOs that are later than predicted as they arrive. Other frames wake this thread as well,
/// so after a few wake-ups the loop takes the rest at the end of the window.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::await_rest(Time end) noexcept {
  for (unsigned wakes = 0; wakes < most_wakes; ++wakes) {
    const bool some = port_.wait_frame(end);
    drain();
    if (!some || pdos_.inputs().complete() || follower_.arrived()) return;
  }
  port_.sleep_until(end);
  drain();
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::drain() noexcept {
  for (bool more = !follower_.arrived(); more;) {
    const bool left = left_from_ != left_end_;
    const std::size_t first = std::exchange(left_from_, left_end_);
    const std::size_t end = left ? left_end_ : port_.receive(received_);
    for (std::size_t i = left ? first : 0; i < end; ++i) {
      const StampedFrame& stamped = received_[i];
      status_.wire_bits += static_cast<std::uint64_t>(WireTime::mean_bits(stamped.frame));
      if (!pdos_.inputs().receive(stamped)) {
        if (begins_cycle(stamped)) [[unlikely]] {
          left_from_ = i + 1;
          left_end_ = end;
          return;
        }
        network_.on_frame(stamped.frame, stamped.when, services_.inbox());
      } else if (pdo_requests_.waiting()) [[unlikely]] {
        pdo_requests_.on_frame(pdos_.inputs().row_of(stamped.frame), stamped);
      }
    }
    if (!left) status_.frames_received += end;
    more = left || end == received_.size();
  }
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::learn(bool in_time) noexcept {
  if (pdos_.inputs().expected() == 0) return;
  const Time arrival = pdos_.inputs().last_arrival() - sync_sent_;
  if (in_time) {
    prediction_.in_time(arrival);
  } else if (pdos_.inputs().complete()) {
    prediction_.late(arrival);
  }
  exchange_.timing.sync_to_last_pdo.record(arrival);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::publish() noexcept {
  const PortNews news = port_.news();
  status_.port = news;
  const bool echoed = news.last_sync_echo >= sync_sent_;
  sync_time_ = echoed ? news.last_sync_echo : sync_sent_;
  if (echoed) exchange_.timing.sync_on_wire.record(sync_time_ - clock_.deadline());
  const Time now = port_.now();
  published_ = now;
  const Time late = std::max(sync_sent_ - clock_.deadline(), now - end_of_window());
  late_cycle_ = late > clock_.period() / 4;
  const std::uint32_t missing = pdos_.inputs().close(now);
  status_.images_incomplete += missing != 0;
  const ImageStamp stamp{.cycle = clock_.cycle(),
                         .beat = status_.beats,
                         .sync_time = sync_time_,
                         .publish_time = now,
                         .missing = missing};
  const WorkingImage& image = pdos_.image();
  exchange_.images.publish(stamp, image.values, image.stale, pdos_.inputs().marks());
  exchange_.timing.sync_to_publish.record(now - sync_time_);
  predict_next_publish(now);
  port_watch_.on_news(news, now);
  run_controller(stamp);
  pdos_.inputs().forget_marks();
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::run_controller(const ImageStamp& stamp) noexcept {
  if (options_.controller == nullptr) return;
  const WorkingImage& image = pdos_.image();
  OutputWriter writer{pdos_.outputs(), {.cycle = stamp.cycle, .now = stamp.publish_time}};
  options_.controller->update({.cycle = stamp.cycle,
                               .beat = stamp.beat,
                               .sync_time = stamp.sync_time,
                               .publish_time = stamp.publish_time,
                               .missing = stamp.missing,
                               .values = image.values,
                               .stale_bits = image.stale,
                               .pdos = pdos_.inputs().marks()},
                              writer);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::predict_next_publish(Time now) noexcept {
  Time next = clock_.deadline() + clock_.period() + prediction_.predicted();
  // After a stall within the cycle, the clock will skip the periods that have passed.
  const Time late = now - next;
  if (late > Time{}) next += (late / clock_.period() + 1) * clock_.period();
  exchange_.next_publish.store(next.count(), std::memory_order_release);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::send_outputs() noexcept {
  if (follower_.arrived()) return;  // SYNC came early: these outputs belong to the next cycle.
  port_.sleep_until(clock_.deadline() + plan_.cycle.output_deadline);
  if (options_.observe || outputs_rest()) return;
  // A master in NMT Stopped sends no RPDOs, except for fallbacks that an inhibit time holds back.
  if (silent() && !pdos_.outputs().pending()) return;
  const Time now = port_.now();
  const SetPointFrame& commands = front_.set_points();
  const OutputMoment moment{.cycle = clock_.cycle(), .now = now};
  std::span<const Frame> frames = pdos_.outputs().pack(commands.points, moment);
  if (pdos_.outputs().fresh_commands() != 0) {
    exchange_.timing.command_age.record(now - commands.when);
  }
  if (frames.empty()) return;
  // SYNC has precedence: outputs that could not end before it wait for the next cycle.
  const Time room = clock_.deadline() + clock_.period() - now;
  if (wire_.worst(frames) > room) [[unlikely]] {
    frames = pdos_.outputs().pack_less(wire_.bits_in(room), WireTime::worst_bits);
    status_.outputs_skipped += frames.empty();
  }
  pdos_.outputs().sent(frames.empty() ? 0 : send(frames), moment);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::give_events() noexcept {
  Event event;
  while (network_.take(event)) give_event(event);
  while (events_.pop(event)) give_event(event);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::give_event(Event& event) noexcept {
  event.cycle = clock_.cycle();
  front_.tell(event);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::write_status() noexcept {
  status_.cycle = clock_.cycle();
  status_.stop = stop_.stage();
  status_.stop_result = stop_.result();
  status_.events_lost = events_.lost() + network_.events_lost();
  status_.sync = sync_state();
  status_.sync_period = follower_.period();
  if (sync_sent_ - last_status_ < status_interval && !done_) return;
  last_status_ = sync_sent_;
  status_.when = sync_sent_;
  const PdoInputs& inputs = pdos_.inputs();
  exchange_.status.write(
      status_, network_.nodes(), [&](std::size_t row) { return inputs.status(row); },
      [&](std::size_t row) {
        RpdoStatus status = pdos_.outputs().status(row);
        status.sent += pdo_requests_.sent(row);
        return status;
      });
  if (done_) exchange_.finished.store(true, std::memory_order_release);
}

template <Port P, FrontLink L, Services S>
std::size_t BusLoop<P, L, S>::send(std::span<const Frame> frames) noexcept {
  if (!gate_open_) return 0;
  const SendResult result = port_.send(frames);
  for (const Frame& frame : frames.first(result.sent)) {
    status_.wire_bits += static_cast<std::uint64_t>(WireTime::mean_bits(frame));
  }
  status_.frames_sent += result.sent;
  if (result.sent != frames.size()) {
    status_.send_failures += frames.size() - result.sent;
    port_watch_.on_send(frames.size() - result.sent, result.error, sync_sent_);
  }
  return result.sent;
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::tell(EventKind kind, Time now, std::int64_t value,
                            std::uint32_t detail) noexcept {
  events_.push(
      {.when = now, .cycle = clock_.cycle(), .kind = kind, .detail = detail, .value = value});
}

}  // namespace takt
