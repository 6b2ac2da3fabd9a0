#pragma once
// Member functions of BusLoop, in the order of a cycle.
#include "master/rt/bus_loop.hpp"
#include "master/wire/sync.hpp"

namespace takt {

template <Port P, class N>
BusLoop<P, N>::BusLoop(const BusPlan& plan, P& port, Exchange& exchange, BusLoopOptions options)
    : plan_{plan},
      port_{port},
      exchange_{exchange},
      options_{options},
      pdos_{plan, events_},
      network_{plan, {.observe = options.observe}},
      pdo_requests_{plan},
      stop_{plan},
      port_watch_{events_},
      clock_{plan.cycle.period},
      counter_{plan.cycle.sync_overflow},
      hold_{plan},
      gate_{plan.cycle.period},
      prediction_{plan.cycle.sync ? plan.cycle.receive_window : Time{0}},
      wire_{plan.bitrate},
      received_(batch),
      quick_stopped_(stop_.axes().size()) {}

template <Port P, class N>
void BusLoop<P, N>::start() noexcept {
  const Time now = port_.now();
  clock_.start(now + clock_.period());
  network_.start(now);
  predict_next_publish();
}

template <Port P, class N>
void BusLoop<P, N>::cycle() noexcept {
  follow_nodes();
  wait_for_beat();
  send_sync();
  receive();
  publish();
  serve();
  stop_drives_after_loss();
  send_outputs();
  give_events();
  write_status();
  clock_.next();
}

/// Which nodes exchange PDOs in this cycle.
template <Port P, class N>
void BusLoop<P, N>::follow_nodes() noexcept {
  hearing_ = false;
  for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
    const bool exchanging = network_.exchanges_pdos(i);
    if (exchanging != exchanging_[i]) {
      exchanging_[i] = exchanging;
      if (exchanging) {
        pdos_.outputs().open(i, exchange_.set_points.newest().points);
      } else {
        pdos_.outputs().shut(i);
      }
    }
    // Without a SYNC of our own no cycle can wait for answers to it.
    const Reception heard = options_.observe ? Reception::listening : Reception::full;
    const bool listen = options_.observe || !plan_.nodes[i].boot;
    hearing_ = hearing_ || exchanging || listen;
    const Reception unheard = listen ? Reception::listening : Reception::off;
    pdos_.inputs().set_reception(i, exchanging ? heard : unheard, sync_sent_);
  }
}

template <Port P, class N>
void BusLoop<P, N>::wait_for_beat() noexcept {
  port_.sleep_precisely_until(clock_.deadline());
  Time now = port_.now();
  if (const std::uint64_t missed = clock_.skip_missed(now); missed != 0) {
    status_.cycles_missed += missed;
    tell(EventKind::cycles_missed, now, static_cast<std::int64_t>(missed));
    port_.sleep_precisely_until(clock_.deadline());
    now = port_.now();
  }
  sync_sent_ = now;
  look_at_wire();
}

/// Frames that could not leave yet must not be followed by others.
template <Port P, class N>
void BusLoop<P, N>::look_at_wire() noexcept {
  if (gate_.doubtful(port_.news())) drain();
  gate_open_ = gate_.open(port_.news(), sync_sent_);
  if (!gate_open_) {
    ++held_;
    ++status_.cycles_missed;
  } else if (held_ != 0) {
    tell(EventKind::cycles_missed, sync_sent_, static_cast<std::int64_t>(held_),
         static_cast<std::uint32_t>(MissedBecause::wire_blocked));
    held_ = 0;
  }
}

template <Port P, class N>
void BusLoop<P, N>::send_sync() noexcept {
  const Time late = sync_sent_ - clock_.deadline();
  exchange_.timing.sync_lateness.record(late);
  if (late > clock_.period() / 10) ++status_.cycles_late;
  bool heard = true;
  if (plan_.cycle.sync && !options_.observe && !hold_.open(network_.nodes())) {
    heard = false;
  } else if (plan_.cycle.sync && !options_.observe) {
    const Frame sync = counter_.used() ? sync_frame(plan_.cycle.sync_cob_id, counter_.next())
                                       : sync_frame(plan_.cycle.sync_cob_id);
    heard = send({&sync, 1}) == 1;
    if (heard) {
      counter_.sent();
      gate_.sent(sync_sent_);
    }
  }
  pdos_.inputs().begin(clock_.cycle(), sync_sent_, heard);
  status_.beats += heard;
  if (starved_ >= patience_with_services) relieve_services();
}

/// Cycles so full that no dialogue fits before the outputs must not keep nodes from booting: one
/// service frame goes out right behind SYNC. PDOs have priority over it on the wire.
template <Port P, class N>
void BusLoop<P, N>::relieve_services() noexcept {
  services_.drop(send(services_.first(1)));
  starved_ = 0;
}

template <Port P, class N>
void BusLoop<P, N>::receive() noexcept {
  const Time end = std::min(sync_sent_ + plan_.cycle.receive_window,
                            clock_.deadline() + plan_.cycle.output_deadline);
  // While no node exchanges PDOs (all still boot) the whole slack belongs to the services.
  if (plan_.cycle.sync && hearing_) {
    // Event-driven PDOs alone teach no arrival; half of the window leaves room for services.
    const bool nothing_due = pdos_.inputs().expected() == 0 && !prediction_.learned();
    const Time wait = nothing_due ? plan_.cycle.receive_window / 2 : prediction_.predicted();
    port_.sleep_until(std::min(sync_sent_ + wait, end));
  }
  drain();
  const bool in_time = pdos_.inputs().complete();
  if (!in_time) {
    port_.sleep_until(end);
    drain();
  }
  learn(in_time);
}

template <Port P, class N>
void BusLoop<P, N>::drain() noexcept {
  for (;;) {
    const std::size_t count = port_.receive(received_);
    for (std::size_t i = 0; i < count; ++i) {
      const StampedFrame& stamped = received_[i];
      status_.wire_bits += static_cast<std::uint64_t>(WireTime::mean_bits(stamped.frame));
      if (!pdos_.inputs().receive(stamped)) {
        network_.on_frame(stamped.frame, stamped.when, services_.inbox());
      } else if (pdo_requests_.waiting()) [[unlikely]] {
        pdo_requests_.on_frame(pdos_.inputs().row_of(stamped.frame), stamped);
      }
    }
    status_.frames_received += count;
    if (count < received_.size()) return;
  }
}

template <Port P, class N>
void BusLoop<P, N>::learn(bool in_time) noexcept {
  if (pdos_.inputs().expected() == 0) return;
  const Time arrival = pdos_.inputs().last_arrival() - sync_sent_;
  if (in_time) {
    prediction_.in_time(arrival);
  } else if (pdos_.inputs().complete()) {
    prediction_.late(arrival);
  }
  exchange_.timing.sync_to_last_pdo.record(arrival);
}

template <Port P, class N>
void BusLoop<P, N>::publish() noexcept {
  const PortNews news = port_.news();
  status_.port = news;
  const bool echoed = news.last_sync_echo >= sync_sent_;
  sync_time_ = echoed ? news.last_sync_echo : sync_sent_;
  if (echoed) exchange_.timing.sync_on_wire.record(sync_time_ - clock_.deadline());
  const Time now = port_.now();
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
  predict_next_publish();
  port_watch_.on_news(news, now);
  run_controller(stamp);
  pdos_.inputs().forget_marks();
}

template <Port P, class N>
void BusLoop<P, N>::run_controller(const ImageStamp& stamp) noexcept {
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

template <Port P, class N>
void BusLoop<P, N>::predict_next_publish() noexcept {
  const Time next = clock_.deadline() + clock_.period() + prediction_.predicted();
  exchange_.next_publish.store(next.count(), std::memory_order_relaxed);
}

/// Slack: machines and requests. Their frames and the answers to them end before the outputs.
template <Port P, class N>
void BusLoop<P, N>::serve() noexcept {
  take_requests();
  const Time end = clock_.deadline() + plan_.cycle.output_deadline - wire_.worst_dialogue();
  std::size_t budget = plan_.cycle.service_frames;
  services_.inbox().set_limit(budget);
  pdo_requests_.on_time(exchanging_, status_.beats, port_.now(), services_.inbox());
  for (;;) {
    services_.inbox().set_limit(budget);
    network_.on_time(port_.now(), services_.inbox());
    if (options_.observe) services_.clear();
    if (!send_services(budget) || budget == 0 || !port_.wait_frame(end)) break;
    drain();
  }
  give_replies();
  step_stop();
}

/// False: nothing was sent that will be answered soon.
template <Port P, class N>
bool BusLoop<P, N>::send_services(std::size_t& budget) noexcept {
  if (services_.empty()) return false;
  const Time end = clock_.deadline() + plan_.cycle.output_deadline;
  const Time room = end - port_.now();
  const auto fitting =
      static_cast<std::size_t>(std::max<std::int64_t>(0, room / wire_.worst_dialogue()));
  const std::span<const Frame> frames = services_.first(std::min(budget, fitting));
  if (frames.empty()) {
    ++starved_;
    return false;
  }
  starved_ = 0;
  const bool answered = std::ranges::any_of(
      frames, [](const Frame& frame) { return (frame.id.id() & 0x780) == 0x600; });
  const std::size_t count = send(frames);
  services_.drop(count);
  budget -= count;
  return answered && count != 0;
}

template <Port P, class N>
void BusLoop<P, N>::take_requests() noexcept {
  if (reply_waits_ || !exchange_.requests.pop(request_)) return;
  if (!options_.observe && submit(request_)) return;
  reply_ = Reply{.id = request_.id, .fault = SdoFault::cancelled};
  reply_waits_ = true;
}

template <Port P, class N>
bool BusLoop<P, N>::submit(const Request& request) noexcept {
  const Time now = port_.now();
  return PdoRequests::takes(request.kind) ? pdo_requests_.submit(request, now)
                                          : network_.submit(request, now);
}

template <Port P, class N>
void BusLoop<P, N>::give_replies() noexcept {
  for (;;) {
    if (!reply_waits_ && !network_.take(reply_) && !pdo_requests_.take(reply_)) return;
    reply_waits_ = exchange_.replies.full() || !exchange_.replies.push(reply_);
    if (reply_waits_) return;
  }
}

/// LossReaction::quick_stop: quick stop, then disabled, until the lost node is back.
template <Port P, class N>
void BusLoop<P, N>::stop_drives_after_loss() noexcept {
  if constexpr (requires { network_.stops_drives(); }) {
    if (!network_.stops_drives() || stop_.stage() != StopStage::running) return;
    for (std::size_t i = 0; i < stop_.axes().size(); ++i) {
      const StopAxis& axis = stop_.axes()[i];
      if (network_.demands_quick_stop(axis.node_index)) {
        const bool disabled =
            axis.statusword && OrderedStop::disabled(pdos_.image().values[*axis.statusword]);
        pdos_.outputs().force(axis.controlword, disabled ? OrderedStop::disable_voltage_word
                                                         : OrderedStop::quick_stop_word);
        quick_stopped_[i] = 1;
      } else if (quick_stopped_[i] != 0) {
        pdos_.outputs().release(axis.controlword);
        quick_stopped_[i] = 0;
      }
    }
  }
}

template <Port P, class N>
void BusLoop<P, N>::send_outputs() noexcept {
  port_.sleep_until(clock_.deadline() + plan_.cycle.output_deadline);
  if (options_.observe) return;
  const Time now = port_.now();
  const SetPointFrame& commands = exchange_.set_points.newest();
  const std::span<const Frame> frames =
      pdos_.outputs().pack(commands.points, {.cycle = clock_.cycle(), .now = now});
  if (pdos_.outputs().fresh_commands() != 0) {
    exchange_.timing.command_age.record(now - commands.when);
  }
  if (frames.empty()) return;
  // SYNC comes first: outputs that could not end before it wait for the next cycle.
  const bool fits = now + wire_.worst(frames) <= clock_.deadline() + clock_.period();
  pdos_.outputs().sent(fits ? send(frames) : 0, now);
  status_.outputs_skipped += !fits;
}

/// Begins and follows the ordered stop.
template <Port P, class N>
void BusLoop<P, N>::step_stop() noexcept {
  const Time now = port_.now();
  if (stop_.stage() == StopStage::running) {
    if (!exchange_.stop_requested.load(std::memory_order_relaxed)) return;
    tell(EventKind::stopping, now);
    stop_.begin(now);
    pdos_.outputs().fall_back();
    pdo_requests_.cancel_all();
  }
  const StopStage before = stop_.stage();
  stop_.step(now,
             {.values = pdos_.image().values,
              .exchanging = exchanging_,
              .network_stopped = options_.observe || (network_.stopped() && services_.empty())});
  if (const auto word = stop_.controlword()) {
    for (const StopAxis& axis : stop_.axes()) pdos_.outputs().force(axis.controlword, *word);
  }
  if (before != StopStage::nmt && stop_.stage() == StopStage::nmt) network_.begin_stop(now);
  done_ = stop_.stage() == StopStage::done;
  if (done_) tell(EventKind::stopped, now);
}

template <Port P, class N>
void BusLoop<P, N>::give_events() noexcept {
  Event event;
  while (network_.take(event)) {
    event.cycle = clock_.cycle();
    exchange_.events.push(event);
  }
  while (events_.pop(event)) {
    event.cycle = clock_.cycle();
    exchange_.events.push(event);
  }
}

template <Port P, class N>
void BusLoop<P, N>::write_status() noexcept {
  status_.cycle = clock_.cycle();
  status_.stop = stop_.stage();
  status_.events_lost = events_.lost();
  if (sync_sent_ - last_status_ < status_interval && !done_) return;
  last_status_ = sync_sent_;
  status_.when = sync_sent_;
  const PdoInputs& inputs = pdos_.inputs();
  exchange_.status.write(
      status_, network_.nodes(), [&](std::size_t row) { return inputs.status(row); },
      [&](std::size_t row) { return pdos_.outputs().status(row); });
  if (done_) exchange_.finished.store(true, std::memory_order_release);
}

template <Port P, class N>
std::size_t BusLoop<P, N>::send(std::span<const Frame> frames) noexcept {
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

template <Port P, class N>
void BusLoop<P, N>::tell(EventKind kind, Time now, std::int64_t value,
                         std::uint32_t detail) noexcept {
  events_.push(
      {.when = now, .cycle = clock_.cycle(), .kind = kind, .detail = detail, .value = value});
}

}  // namespace takt
