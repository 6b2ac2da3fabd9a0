#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "eds_parser/table/waits.hpp"
#include "master/core/network/time_producer.hpp"
#include "master/rt/beat/beat.hpp"
#include "master/rt/frame_sender.hpp"
#include "master/rt/intake.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/port.hpp"
#include "master/wire/nmt.hpp"

namespace takt {

/// The slack of a cycle, in which the loop sends service frames: their number is limited, and they
/// and their answers end before the outputs. Bus thread only.
template <Port P, Services S>
class Slack {
 public:
  /// Keeps references to all arguments.
  Slack(P& port, Beat& beat, FrameSender<P>& sender, Intake<P, S>& intake, BusMachines<S>& bus)
      : port_{port},
        beat_{beat},
        sender_{sender},
        intake_{intake},
        bus_{bus},
        time_{bus.plan.time} {}

  /// Extends the time-outs after this thread did not run. It received nothing during that time, but
  /// has now received all frames that the socket has kept. Frames that the socket could not keep
  /// must not count as silence of a device. Call this once a cycle.
  void extend_deadlines() noexcept {
    const Time away = beat_.take_absence();
    if (away == Time{}) return;
    bus_.services.on_absence(away);
    bus_.pdo_requests.extend_deadlines(away);
  }
  /// Runs one round of services: TIME, PDO requests and the state machines, until nothing more fits
  /// or is awaited.
  void run_round() noexcept;
  /// Returns true for a long cycle. It has many rounds, so that boots and heartbeats proceed as
  /// fast as in a short cycle.
  bool has_many_rounds() const noexcept { return bus_.plan.cycle.period >= long_cycle; }
  /// Sleeps until the next round of a long cycle. Returns false if the outputs come next, or if a
  /// followed SYNC came early.
  bool rest_until_next_round() noexcept;
  /// Sends one service frame directly after SYNC if some cycles had no room for a service frame and
  /// its answer before the outputs. Such cycles must not keep nodes from booting. PDOs have
  /// priority over this frame on the wire.
  void relieve_services() noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(time_, wire_free_, asked_, cycles_without_room_);
  }

 private:
  /// Number of cycles without room for service frames after which relieve_services() sends one.
  static constexpr unsigned forced_after = 2;
  /// Largest number of frames that are handed over at once, because interface queues are short.
  static constexpr std::size_t burst_frames = 6;
  /// Number of frames that are still in the queue when the next ones are handed over.
  static constexpr std::size_t burst_ahead = 3;
  static constexpr Time long_cycle = std::chrono::milliseconds{50};
  /// Time between the service rounds of a long cycle.
  static constexpr Time round_distance = std::chrono::milliseconds{10};

  struct Round {
    Time outputs{};          ///< when the outputs are due
    Time last_look{};        ///< end of the wait for answers
    std::size_t budget = 0;  ///< frames that may still be handed over
    std::size_t open = 0;    ///< number of unanswered requests of this round
    bool idle = true;        ///< this round has handed over nothing so far
  };
  enum class Handed : std::uint8_t {
    nothing,   ///< there were no frames, or no room for them
    requests,  ///< answers to these frames will come soon
    burst,     ///< these frames have no answers; more may follow as the wire takes them
  };

  void send_time() noexcept;
  Round begin_round() noexcept;
  bool run_machines(const Round& round) noexcept;
  void expect_started_nodes() noexcept;
  Handed send_frames(Round& round) noexcept;
  std::size_t hand_over(std::size_t most) noexcept;
  bool await_answers(Round& round, Handed handed) noexcept;
  bool before_stream_end(Time now) const noexcept;
  Time awaited_wire_time(std::size_t open) const noexcept;

  P& port_;
  Beat& beat_;
  FrameSender<P>& sender_;
  Intake<P, S>& intake_;
  BusMachines<S>& bus_;
  TimeProducer time_;
  /// Time at which the service frames handed over in this cycle have left the wire.
  Time wire_free_{};
  std::size_t asked_ = 0;             ///< SDO requests handed over since the last round
  Time stream_end_{};                 ///< latest end of the newest sub-block that was requested
  unsigned cycles_without_room_ = 0;  ///< cycles in which service frames found no room
};

template <Port P, Services S>
void Slack<P, S>::relieve_services() noexcept {
  if (cycles_without_room_ < forced_after || before_stream_end(port_.now())) return;
  hand_over(1);
  cycles_without_room_ = 0;
}

template <Port P, Services S>
bool Slack<P, S>::rest_until_next_round() noexcept {
  const Time next = port_.now() + round_distance;
  if (next >= beat_.outputs_due() - bus_.wire.worst_dialogue()) return false;
  port_.sleep_until(next);
  intake_.drain();
  return !beat_.next_sync_came();
}

template <Port P, Services S>
void Slack<P, S>::run_round() noexcept {
  send_time();
  Round round = begin_round();
  for (bool more = true; more && run_machines(round);) {
    const Handed handed = send_frames(round);
    round.idle = round.idle && handed == Handed::nothing;
    more = await_answers(round, handed);
  }
  asked_ = 0;
  cycles_without_room_ +=
      round.idle && !bus_.service_frames.empty() && !before_stream_end(port_.now());
}

/// Sends TIME if it is due. TIME carries the moment at which it is sent, so it never waits in a
/// queue.
template <Port P, Services S>
void Slack<P, S>::send_time() noexcept {
  const Time now = port_.now();
  if (now < time_.deadline() || bus_.observe) return;
  const auto frame = time_.frame(now, port_.condition().since_1970);
  if (!frame) return;
  const std::span one{&*frame, 1};
  const bool fits = now + bus_.wire.worst(one) <= beat_.outputs_due();
  if (fits && sender_.send(one) == 1) time_.sent(now);
}

template <Port P, Services S>
auto Slack<P, S>::begin_round() noexcept -> Round {
  const Time outputs = beat_.outputs_due();
  Round round{.outputs = outputs,
              .last_look = outputs - bus_.wire.worst_dialogue(),
              .budget = bus_.plan.cycle.service_frames};
  if (has_many_rounds()) round.last_look = std::min(round.last_look, port_.now() + round_distance);
  Outbox& inbox = bus_.service_frames.inbox();
  inbox.set_limit(round.budget);
  if (const Time now = port_.now(); !beat_.stalled(now)) {
    bus_.pdo_requests.on_time(bus_.exchanging, bus_.status.beats, now, inbox);
  }
  return round;
}

/// Lets the state machines write their frames. Returns false if this thread did not run for too
/// long.
template <Port P, Services S>
bool Slack<P, S>::run_machines(const Round& round) noexcept {
  const Time now = port_.now();
  if (beat_.stalled(now)) return false;
  BusMachines<S>& bus = bus_;
  Outbox& inbox = bus.service_frames.inbox();
  inbox.set_limit(round.budget);
  bus.services.on_time(now, inbox);
  if (bus.observe) bus.service_frames.clear();
  expect_started_nodes();
  return true;
}

/// Prepares to receive the first TPDOs of nodes that are being started. A node sends its
/// event-driven PDOs as soon as it is started, often in this round, and not again until they
/// change.
template <Port P, Services S>
void Slack<P, S>::expect_started_nodes() noexcept {
  if (!bus_.service_frames.has(nmt_cob_id)) return;
  PdoInputs& inputs = bus_.pdos.inputs();
  for (std::size_t i = 0; i < bus_.plan.nodes.size(); ++i) {
    const bool soon = bus_.services.starts(i) || bus_.services.exchanges_pdos(i);
    if (!soon || inputs.reception(i) != Reception::off) continue;
    inputs.set_reception(i, Reception::early);
  }
}

/// Hands over the service frames that fit, together with their answers.
template <Port P, Services S>
auto Slack<P, S>::send_frames(Round& round) noexcept -> Handed {
  const ServiceQueue& frames = bus_.service_frames;
  if (frames.empty()) return Handed::nothing;
  const Time now = port_.now();
  if (before_stream_end(now)) return Handed::nothing;
  wire_free_ = std::max(wire_free_, now);
  const Time room = round.outputs - wire_free_ - awaited_wire_time(round.open);
  std::size_t fitting = frames.fitting(round.budget, room, bus_.wire);
  const bool burst = frames.unanswered(std::min(fitting, burst_frames));
  if (burst) fitting = std::min(fitting, burst_frames);
  if (frames.first(fitting).empty()) return Handed::nothing;
  cycles_without_room_ = 0;
  const std::size_t count = hand_over(fitting);
  round.budget -= count;
  if (count == 0) return Handed::nothing;
  if (!burst && !bus_.takes_pdos) round.open += count;
  return burst ? Handed::burst : Handed::requests;
}

/// Hands over the first `most` service frames, or as many of them as the port takes. Returns their
/// number.
template <Port P, Services S>
std::size_t Slack<P, S>::hand_over(std::size_t most) noexcept {
  ServiceQueue& frames = bus_.service_frames;
  const std::size_t streams = frames.count(Answer::stream);
  const std::size_t count = sender_.send(frames.first(most));
  if (frames.unanswered(count)) {
    wire_free_ += bus_.wire.mean(frames.first(count));
  } else if (bus_.takes_pdos) {
    wire_free_ += frames.to_others(count, bus_.wire);
  }
  asked_ += frames.to_servers(count);
  frames.drop(count);
  if (frames.count(Answer::stream) != streams) stream_end_ = port_.now() + waits::sub_block_end;
  return count;
}

/// Waits for answers, or until the wire has taken a burst. Returns false if the round is over.
template <Port P, Services S>
bool Slack<P, S>::await_answers(Round& round, Handed handed) noexcept {
  const bool held_back = !bus_.service_frames.empty() && bus_.services.awaited_answers() != 0;
  const bool awaited =
      handed != Handed::nothing || bus_.services.streams() || round.open != 0 || held_back;
  const bool spent = round.budget == 0 && round.open == 0;
  if (!awaited || spent || beat_.next_sync_came()) return false;
  if (handed == Handed::burst) {
    const Time dry = wire_free_ - bus_.wire.worst_dialogue() / 2 * burst_ahead;
    if (dry >= round.outputs) return false;
    port_.wait_frame(dry);
  } else if (!port_.wait_frame(round.last_look)) {
    return false;
  }
  const std::uint64_t heard = bus_.status.frames_received;
  intake_.drain();
  // While no node exchanges PDOs (all nodes boot), each answer makes room for the next request.
  const std::size_t answered =
      std::min<std::size_t>(round.open, bus_.status.frames_received - heard);
  round.open -= answered;
  round.budget += answered;
  return true;
}

/// Returns true while a device sends a sub-block, or has not ended an abandoned one. A frame of
/// lower priority would wait for the end of the sub-block in the transmit queue of the controller,
/// and SYNC would wait behind that frame.
template <Port P, Services S>
bool Slack<P, S>::before_stream_end(Time now) const noexcept {
  const ServiceQueue& frames = bus_.service_frames;
  return now < stream_end_ &&
         bus_.services.awaited_sub_blocks() + frames.count(Answer::after_stream) >
             frames.count(Answer::stream);
}

/// Returns the wire time to reserve for outstanding answers. In operation, this covers all answers
/// of servers, so that they fit before the outputs even if they come at once. `open` is the number
/// of unanswered requests of this round.
template <Port P, Services S>
Time Slack<P, S>::awaited_wire_time(std::size_t open) const noexcept {
  const Time dialogue = bus_.wire.worst_dialogue();
  if (!bus_.takes_pdos) return dialogue * open;
  const std::size_t queued = bus_.service_frames.to_servers(bus_.service_frames.size());
  const std::size_t owed = std::max(bus_.services.awaited_answers(), queued) - queued;
  return dialogue / 2 * (owed + std::min(owed, asked_));
}

}  // namespace takt
