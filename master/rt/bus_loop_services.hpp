#pragma once
// Member functions of BusLoop for the slack of a cycle, in which services and requests have their
// turn.
#include <algorithm>

#include "eds_parser/table/waits.hpp"
#include "master/rt/bus_loop.hpp"

namespace takt {

/// Cycles that are too full for a dialogue before the outputs must not keep nodes from booting.
/// This sends one service frame directly behind SYNC; PDOs have priority over it on the wire.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::relieve_services() noexcept {
  if (behind_stream(port_.now())) return;
  hand_over(1);
  starved_ = 0;
}

/// While this thread stood still, nobody listened. It has read what came in by now; frames that the
/// socket could not hold must not count as silence of a device.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::excuse_absence() noexcept {
  const Time away = sync_sent_ - std::exchange(last_sync_, sync_sent_) - clock_.period();
  if (away <= longest_lapse * clock_.period()) return;
  network_.on_absence(away);
  pdo_requests_.excuse(away);
}

/// Returns true if this thread stood still since SYNC. The time-outs must take this absence into
/// account before the state machines run again.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::stalled(Time now) const noexcept {
  return now - sync_sent_ > longest_lapse * clock_.period();
}

/// Runs the state machines and the requests in the slack. A long cycle has many rounds, so that
/// boots and heartbeats proceed as fast as in a short cycle.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::serve() noexcept {
  excuse_absence();
  end_halt();
  serve_round();
  while (plan_.cycle.period >= long_cycle && rest_until_next_round()) {
    give_events();
    serve_round();
  }
  step_stop();
}

/// Returns false if the outputs come next, or if a followed SYNC came early.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::rest_until_next_round() noexcept {
  const Time next = port_.now() + round_distance;
  if (next >= clock_.deadline() + plan_.cycle.output_deadline - wire_.worst_dialogue())
    return false;
  port_.sleep_until(next);
  drain();
  return !follower_.arrived();
}

/// A node sends its event-driven PDOs as soon as it is started, often in this round, and not again
/// until they change.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::expect_started_nodes() noexcept {
  if (!services_.has(nmt_cob_id)) return;
  for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
    const bool soon = network_.starts(i) || network_.exchanges_pdos(i);
    if (!soon || pdos_.inputs().reception(i) != Reception::off) continue;
    pdos_.inputs().set_reception(i, Reception::early);
  }
}

/// Runs one round of services. Service frames and their answers end before the outputs.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::serve_round() noexcept {
  take_requests();
  write_fallbacks();
  ask_for_stop();
  send_time();
  const Time outputs = clock_.deadline() + plan_.cycle.output_deadline;
  Time last_look = outputs - wire_.worst_dialogue();
  if (plan_.cycle.period >= long_cycle) {
    last_look = std::min(last_look, port_.now() + round_distance);
  }
  std::size_t budget = plan_.cycle.service_frames;
  std::size_t open = 0;  // dialogues of this round that are still unanswered
  bool idle = true;      // this round has handed over nothing so far
  services_.inbox().set_limit(budget);
  if (const Time now = port_.now(); !stalled(now)) {
    pdo_requests_.on_time(exchanging_, status_.beats, now, services_.inbox());
  }
  for (;;) {
    const Time now = port_.now();
    if (stalled(now)) break;
    services_.inbox().set_limit(budget);
    network_.on_time(now, services_.inbox());
    if (options_.observe) services_.clear();
    expect_started_nodes();
    const std::size_t left = budget;
    const Handed handed = send_services(budget, under_way(open));
    idle = idle && handed == Handed::nothing;
    if (handed == Handed::requests && !hearing_) open += left - budget;
    const bool held_back = !services_.empty() && network_.awaited_answers() != 0;
    const bool awaited = handed != Handed::nothing || network_.streams() || open != 0 || held_back;
    if (!awaited || (budget == 0 && open == 0) || follower_.arrived()) break;
    if (handed == Handed::burst) {
      const Time dry = wire_free_ - wire_.worst_dialogue() / 2 * burst_ahead;
      if (dry >= outputs) break;
      port_.wait_frame(dry);
    } else if (!port_.wait_frame(last_look)) {
      break;
    }
    const std::uint64_t heard = status_.frames_received;
    drain();
    // While no node exchanges PDOs (all nodes boot), each answer makes room for the next request.
    const std::size_t answered = std::min<std::size_t>(open, status_.frames_received - heard);
    open -= answered;
    budget += answered;
  }
  asked_ = 0;
  starved_ += idle && !services_.empty() && !behind_stream(port_.now());
  give_replies();
}

/// Returns true while a device sends a sub-block, or has not ended an abandoned one. A frame of
/// lower priority would wait for the end of the sub-block in the transmit queue of the controller,
/// and SYNC would wait behind that frame.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::behind_stream(Time now) const noexcept {
  return now < stream_end_ &&
         network_.awaited_sub_blocks() + services_.count(Answer::after_stream) >
             services_.count(Answer::stream);
}

/// Returns the wire time to reserve for answers under way. In operation, this covers everything
/// that servers owe, so that it fits before the outputs even if it comes at once. `open` counts the
/// unanswered dialogues of this round.
template <Port P, FrontLink L, Services S>
Time BusLoop<P, L, S>::under_way(std::size_t open) const noexcept {
  if (!hearing_) return wire_.worst_dialogue() * open;
  const std::size_t queued = services_.to_servers(services_.size());
  const std::size_t owed = std::max(network_.awaited_answers(), queued) - queued;
  return wire_.worst_dialogue() / 2 * (owed + std::min(owed, asked_));
}

/// Hands over the first `most` service frames, or as many of them as the port takes. Returns their
/// number.
template <Port P, FrontLink L, Services S>
std::size_t BusLoop<P, L, S>::hand_over(std::size_t most) noexcept {
  const std::size_t streams = services_.count(Answer::stream);
  const std::size_t count = send(services_.first(most));
  if (services_.unanswered(count)) {
    wire_free_ += wire_.mean(services_.first(count));
  } else if (hearing_) {
    wire_free_ += services_.to_others(count, wire_);
  }
  asked_ += services_.to_servers(count);
  services_.drop(count);
  if (services_.count(Answer::stream) != streams) stream_end_ = port_.now() + waits::sub_block_end;
  return count;
}

template <Port P, FrontLink L, Services S>
auto BusLoop<P, L, S>::send_services(std::size_t& budget, Time under_way) noexcept -> Handed {
  if (services_.empty()) return Handed::nothing;
  const Time now = port_.now();
  if (behind_stream(now)) return Handed::nothing;
  const Time outputs = clock_.deadline() + plan_.cycle.output_deadline;
  wire_free_ = std::max(wire_free_, now);
  std::size_t fitting = services_.fitting(budget, outputs - wire_free_ - under_way, wire_);
  const bool burst = services_.unanswered(std::min(fitting, burst_frames));
  if (burst) fitting = std::min(fitting, burst_frames);
  if (services_.first(fitting).empty()) {
    return Handed::nothing;
  }
  starved_ = 0;
  const std::size_t count = hand_over(fitting);
  budget -= count;
  if (count == 0) return Handed::nothing;
  return burst ? Handed::burst : Handed::requests;
}

/// TIME carries the moment at which it is sent, so it never waits in a queue.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::send_time() noexcept {
  const Time now = port_.now();
  if (now < time_.deadline() || options_.observe) return;
  const auto frame = time_.frame(now, port_.news().since_1970);
  if (!frame) return;
  const std::span one{&*frame, 1};
  const bool fits = now + wire_.worst(one) <= clock_.deadline() + plan_.cycle.output_deadline;
  if (fits && send(one) == 1) time_.sent(now);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::take_requests() noexcept {
  if (reply_waits_ || !front_.take_request(request_)) return;
  if (!options_.observe && submit(request_)) return;
  reply_ = Reply{.id = request_.id, .fault = SdoFault::cancelled};
  reply_waits_ = true;
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::write_fallbacks() noexcept {
  while (fallbacks_.waits()) {
    const bool there = exchanging_[fallbacks_.node_index()];
    if (there && !network_.submit(fallbacks_.request(), port_.now())) return;
    if (there) remember_word(fallbacks_.request());
    fallbacks_.submitted();
  }
}

template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::submit(const Request& request) noexcept {
  const Time now = port_.now();
  remember_word(request);
  if (!PdoRequests::takes(request.kind)) return network_.submit(request, now);
  return stop_.stage() == StopStage::running && pdo_requests_.submit(request, now);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::take_answer_of_stop() noexcept {
  const Time now = port_.now();
  if (const auto word = StopRequests::statusword_of(reply_)) memory_[word->axis].see(word->value);
  if (stop_requests_.take(reply_, now, active_stop())) return;
  const ObjectKey object = stop_requests_.refused_object();
  events_.push({.when = now,
                .kind = EventKind::still_armed,
                .node = stop_requests_.refusing_node(),
                .detail = std::uint32_t{object.index} << 8U | object.sub,
                .value = stop_requests_.refusal()});
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::give_replies() noexcept {
  for (;;) {
    if (!reply_waits_ && !network_.take(reply_) && !pdo_requests_.take(reply_)) return;
    if (FallbackWriter::owns(reply_)) continue;
    if (StopRequests::owns(reply_)) {
      take_answer_of_stop();
      continue;
    }
    reply_waits_ = !front_.give_reply(reply_);
    if (reply_waits_) return;
  }
}

}  // namespace takt
