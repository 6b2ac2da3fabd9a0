#include "test/budget/worst_phase.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "eds_parser/plan/frame_time.hpp"
#include "master/sim/bus/frame_bits.hpp"
#include "master/sim/bus/virtual_bus.hpp"
#include "test/budget/plan_traffic.hpp"
#include "test/budget/stuffed_frame.hpp"

namespace takt {
namespace {

constexpr Time moment{1};

class WorstPhase {
 public:
  WorstPhase(const BusPlan& plan, const BusBudget& budget, const PhaseOptions& options,
             sim::Random random)
      : plan_{plan},
        traffic_{traffic_of(plan, {budget.service_dialogues, budget.service_round})},
        options_{options},
        random_{random},
        bus_{plan.bitrate, random.fork(1)},
        streams_(traffic_.size()) {
    seen_.rows.resize(budget.rows.size());
    master_ = bus_.attach({.order = sim::QueueOrder::fifo, .capacity = 1024});
    services_ = bus_.attach({.capacity = 1024});
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      auto& stream = streams_[i];
      stream.frame = stuffed(traffic_[i], random_);
      stream.row = row_of(traffic_[i], budget.rows);
      seen_.not_in_budget += !stream.row;
      stream.sender = sender_of(i);
      stream.next = Time{random_.below(1'000'000)};
      if (traffic_[i].kind == Traffic::sdo && traffic_[i].sent == Sent::by_itself) answers_ = i;
    }
  }

  SeenBus run() {
    for (unsigned cycle = 1; cycle <= options_.cycles; ++cycle) {
      cycle_ = cycle;
      sync_ = cycle * plan_.cycle.period;
      const Time next = sync_ + plan_.cycle.period;
      begin_cycle();
      if (options_.emcys && cycle == options_.cycles / 2) burst();
      run_until(next);
    }
    return std::move(seen_);
  }

 private:
  struct Stream {
    Frame frame;
    sim::BusNodeIndex sender = 0;
    std::optional<std::size_t> row;
    unsigned left = 0;        ///< number of frames of the present burst that are not queued yet
    Time next{};              ///< earliest time of the next frame
    std::deque<Time> queued;  ///< queueing times of the frames that are not sent yet
  };

  /// Returns the sender of a frame. All devices that use one identifier are one sender, because
  /// only the order of the frames on the bus matters.
  sim::BusNodeIndex sender_of(std::size_t i) {
    const PlanFrame& what = traffic_[i];
    if (what.sent == Sent::in_slack) return options_.one_queue ? master_ : services_;
    if (what.sent == Sent::outputs) return master_;
    if (what.sent == Sent::sync && plan_.cycle.makes_sync()) return master_;
    for (std::size_t k = 0; k < i; ++k) {
      const bool same = traffic_[k].cob_id == what.cob_id && !traffic_[k].remote_request;
      if (same) return streams_[k].sender;
    }
    return bus_.attach({.capacity = 64});
  }

  /// Returns the row of the budget for a frame. If two rows have the same identifier, the second
  /// one is the answer to a remote request.
  static std::optional<std::size_t> row_of(const PlanFrame& what,
                                           const std::vector<BudgetRow>& rows) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto& frame = rows[i].frame;
      const bool same = frame.cob_id == what.cob_id && frame.remote_request == what.remote_request;
      if (same && (!found || what.sent == Sent::on_request)) found = i;
    }
    return found;
  }

  void queue(std::size_t i, Time ready, Time since) {
    auto& stream = streams_[i];
    if (!bus_.queue(stream.sender, stream.frame, ready)) return;
    stream.queued.insert(std::ranges::upper_bound(stream.queued, since), since);
  }

  void begin_cycle() {
    served_ = outputs_queued_ = !plan_.cycle.makes_sync();
    awaited_ = 0;
    calm_ = random_.chance(0.4);
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      if (traffic_[i].sent == Sent::sync) queue(i, sync_, sync_);
    }
    if (options_.one_queue) queue_late_answers();
    queue_by_themselves(sync_);
  }

  /// Queues the outputs in the order of their identifiers, as the master gives them to SocketCAN.
  void queue_outputs() {
    outputs_queued_ = true;
    std::vector<std::size_t> due;
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      const auto& frame = traffic_[i];
      if (frame.sent != Sent::outputs || cycle_ % frame.every != 0) continue;
      if (frame.distance > Time{0} && sync_ < streams_[i].next) continue;
      streams_[i].next = sync_ + frame.distance;
      due.push_back(i);
    }
    std::ranges::sort(due, {}, [this](std::size_t i) { return traffic_[i].cob_id; });
    for (const std::size_t i : due) queue(i, sync_ + plan_.cycle.output_deadline, sync_);
    if (random_.chance(0.5)) queue_by_themselves(sync_ + plan_.cycle.output_deadline);
  }

  /// If another device makes SYNC, the times of the cycle count from the end of SYNC.
  void sync_arrived(Time end) {
    if (!plan_.cycle.makes_sync()) {
      sync_ = end;
      served_ = outputs_queued_ = false;
    }
    if (cycles_without_room_ >= most_full_cycles) relieve(end);
    queue_inputs(end);
  }

  /// Sends one service frame right behind SYNC, because several cycles had no room for one.
  void relieve(Time sync_end) {
    std::vector<std::size_t> due;
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      if (traffic_[i].sent != Sent::in_slack || sync_end < streams_[i].next) continue;
      if (traffic_[i].kind != Traffic::sdo || may_request()) due.push_back(i);
    }
    if (due.empty()) return;
    const std::size_t i = due[random_.below(static_cast<std::uint32_t>(due.size()))];
    queue(i, sync_end, sync_end);
    streams_[i].next = sync_end + traffic_[i].distance;
    cycles_without_room_ = 0;
  }

  void queue_inputs(Time sync_end) {
    std::vector<std::size_t> due;
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      const auto& frame = traffic_[i];
      if (frame.sent == Sent::after_sync && cycle_ % frame.every == frame.turn) due.push_back(i);
    }
    const bool all_late = random_.chance(0.6);
    const auto first = all_late && random_.chance(0.8) ? blocking_input(due) : std::nullopt;
    for (const std::size_t i : due) {
      const auto limit = static_cast<std::uint32_t>(options_.device_time.count()) + 1;
      Time own = all_late ? options_.device_time : Time{random_.below(limit)};
      if (first == i) own = Time{0};
      queue(i, sync_end + own, sync_);
      awaited_ += traffic_[i].awaited;
    }
    queue_by_themselves(sync_end + options_.device_time);
  }

  /// Returns the longest TPDO below a random priority. It has already begun when the others are
  /// ready.
  std::optional<std::size_t> blocking_input(std::vector<std::size_t> due) {
    if (due.empty()) return std::nullopt;
    const auto rank = [this](std::size_t i) { return sim::arbitration_rank(streams_[i].frame); };
    const auto length = [this](std::size_t i) { return sim::frame_bits(streams_[i].frame).total; };
    std::ranges::sort(due, {}, rank);
    const auto from = random_.below(static_cast<std::uint32_t>(due.size()));
    return *std::ranges::max_element(due.begin() + from, due.end(), {}, length);
  }

  /// Sends as many service frames of the master as end before the outputs.
  void serve(Time now) {
    served_ = true;
    const Time dialogue = wire_time(2 * worst_frame_bits(8), plan_.bitrate);
    Time room = sync_ + plan_.cycle.output_deadline - now;
    unsigned served = 0;
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      auto& stream = streams_[i];
      const auto& frame = traffic_[i];
      if (frame.sent != Sent::in_slack || now < stream.next) continue;
      if (frame.kind == Traffic::sdo && !may_request()) continue;
      if (room < dialogue) {
        cycles_without_room_ += served == 0;
        return;
      }
      ++served;
      for (unsigned n = 0; n < frame.burst && room >= dialogue; ++n, room -= dialogue) {
        queue(i, now, now);
      }
      stream.next += frame.distance;
      if (stream.next <= now) stream.next = now + frame.distance;
    }
  }

  /// Queues the frames that come by themselves, if their distances permit it: some at `when`,
  /// others one moment earlier, so that one of them has already begun. In a flood they repeat as
  /// often as their distances permit.
  void queue_by_themselves(Time when) {
    if (calm_ || random_.chance(0.1)) return;
    const bool flood = random_.chance(0.3);
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      const auto& frame = traffic_[i];
      auto& stream = streams_[i];
      if (frame.sent != Sent::by_itself || random_.chance(flood ? 0.05 : 0.2)) continue;
      if (options_.one_queue && answers_ == i) {
        answer(when);
        continue;
      }
      if (frame.burst > 1 && !flood) {
        queue_part_of_burst(i, when);
        continue;
      }
      if (when < stream.next) continue;
      stream.left = 0;
      Time ready = std::max(when - (random_.chance(0.7) ? moment : Time{}), stream.next);
      // A server may answer late, and then answer the next request in time.
      const Time jitter = frame.kind == Traffic::sdo ? frame.distance : Time{};
      stream.next = std::max(stream.next, ready - jitter);
      do {
        for (unsigned n = 0; n < frame.burst; ++n) queue(i, ready, ready);
        ready += frame.distance;
        stream.next += frame.distance;
      } while (flood && ready < when + plan_.cycle.period);
    }
  }

  /// Queues some of the SDO answers that are due. A server may be late by one round at most.
  void answer(Time when) {
    const unsigned most = random_.chance(0.6) ? 1000 : random_.below(4);
    for (unsigned n = 0; n < most && !owed_.empty(); ++n) {
      if (owed_.front() > when) return;
      answer_one(when - (random_.chance(0.7) ? moment : Time{}));
    }
  }

  /// Queues the SDO answers that must come in this cycle. A long cycle has several rounds.
  void queue_late_answers() {
    while (!owed_.empty()) {
      const Time latest = owed_.front() + traffic_[*answers_].distance;
      if (latest > sync_ + plan_.cycle.period) return;
      answer_one(std::max(latest, sync_));
    }
  }

  /// Notes an SDO request. A server that has not answered gets no other request.
  void requested(Time end) {
    owed_.push_back(end);
    ++unanswered_;
    if (options_.one_queue && unanswered_ > plan_.nodes.size()) answer_one(end);
  }

  bool may_request() const { return !options_.one_queue || unanswered_ < plan_.nodes.size(); }

  void answer_one(Time when) {
    const Time ready = std::max(when, owed_.front());
    owed_.pop_front();
    queue(*answers_, ready, ready);
  }

  /// Queues some frames of a burst now, and leaves the others for later in the period.
  void queue_part_of_burst(std::size_t i, Time when) {
    auto& stream = streams_[i];
    if (when >= stream.next) {
      stream.left = traffic_[i].burst;
      stream.next = when + traffic_[i].distance;
    }
    const unsigned count = std::min(stream.left, 1 + random_.below(stream.left + 1));
    stream.left -= count;
    const Time ready = when - moment;
    for (unsigned n = 0; n < count; ++n) queue(i, ready, ready);
  }

  void burst() {
    const Time when =
        sync_ + Time{static_cast<Time::rep>(
                    random_.next() % static_cast<std::uint64_t>(plan_.cycle.period.count()))};
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      if (traffic_[i].sent == Sent::as_emcy) queue(i, when, when);
    }
  }

  void run_until(Time end) {
    for (;;) {
      const Time now = bus_.next_event();
      const Time next = std::min(now, end);
      if (!served_ && sync_ + plan_.cycle.receive_window < next) {
        serve(sync_ + plan_.cycle.receive_window);
      } else if (!outputs_queued_ && sync_ + plan_.cycle.output_deadline < next) {
        queue_outputs();
      } else if (now >= end) {
        return;
      } else {
        step(now);
      }
    }
  }

  void step(Time now) {
    if (options_.error_distance > Time{0}) disturb(now >= next_error_ ? 1.0 : 0.0);
    if (!bus_.step(now)) return;
    const sim::WireFrame& wire = bus_.wire();
    if (wire.result == sim::WireResult::sent) return arrived(wire);
    ++seen_.errors;
    next_error_ = wire.end + options_.error_distance;
    if (random_.chance(0.3)) next_error_ = std::max(next_error_, next_busy_moment());
    // No controller becomes error passive, because the test is about the time that errors cost.
    for (sim::BusNodeIndex i = 0; i < bus_.size(); ++i) bus_.node(i).reset_errors();
  }

  void disturb(double share) {
    for (sim::BusNodeIndex i = 0; i < bus_.size(); ++i) bus_.node(i).faults.error = share;
  }

  /// Returns the time of SYNC, of the TPDOs or of the outputs in the first cycle in which an error
  /// is permitted again.
  Time next_busy_moment() {
    const Time period = plan_.cycle.period;
    const auto cycles = (next_error_ - sync_) / period;
    const Time moments[] = {Time{0}, Time{random_.below(1'000'000)}, plan_.cycle.output_deadline};
    const Time when = sync_ + cycles * period + moments[random_.below(std::size(moments))];
    return when < next_error_ ? when + period : when;
  }

  void arrived(const sim::WireFrame& wire) {
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      const auto& stream = streams_[i];
      const bool same = stream.frame.id == wire.frame.id && stream.frame.rtr == wire.frame.rtr;
      if (!same || stream.queued.empty() || stream.sender != wire.sender) continue;
      if (!first || stream.queued.front() < streams_[*first].queued.front()) first = i;
    }
    if (!first) return;
    auto& stream = streams_[*first];
    if (stream.row) note(seen_.rows[*stream.row], wire.end - stream.queued.front());
    stream.queued.pop_front();
    follow(*first, wire.end);
  }

  static void note(SeenRow& row, Time response) {
    row.worst = std::max(row.worst, response);
    ++row.frames;
  }

  /// Queues the frames that follow from this one.
  void follow(std::size_t i, Time end) {
    const auto& frame = traffic_[i];
    if (frame.sent == Sent::sync) sync_arrived(end);
    if (options_.one_queue && i == answers_) --unanswered_;
    if (frame.kind == Traffic::sdo && frame.sent == Sent::in_slack) requested(end);
    if (frame.answer) {
      const Time ready = end + Time{random_.below(longest_answer)};
      queue(*frame.answer, ready, ready);
    }
    if (frame.sent == Sent::after_sync && frame.awaited && --awaited_ == 0 && !served_) serve(end);
  }

  static constexpr unsigned most_full_cycles = 2;
  static constexpr std::uint32_t longest_answer = 100'000;

  const BusPlan& plan_;
  std::vector<PlanFrame> traffic_;
  PhaseOptions options_;
  sim::Random random_;
  sim::VirtualBus bus_;
  sim::BusNodeIndex master_ = 0;    ///< SYNC and outputs
  sim::BusNodeIndex services_ = 0;  ///< the master's other frames
  std::vector<Stream> streams_;
  std::optional<std::size_t> answers_{};  ///< the SDO answers
  std::size_t unanswered_ = 0;            ///< SDO requests whose answers are not sent yet
  std::deque<Time> owed_;                 ///< ends of the SDO requests whose answers are not queued
  SeenBus seen_;
  unsigned cycle_ = 0;
  Time sync_{};
  Time next_error_{};                 ///< earliest time of the next error
  int awaited_ = 0;                   ///< TPDOs of this cycle that have not arrived
  unsigned cycles_without_room_ = 0;  ///< number of cycles without room for service frames
  bool served_ = false;               ///< the service frames of this cycle are queued
  bool outputs_queued_ = false;
  bool calm_ = false;  ///< no frames come by themselves in this cycle
};

}  // namespace

SeenBus run_worst_phase(const BusPlan& plan, const BusBudget& budget, const PhaseOptions& options,
                        sim::Random random) {
  return WorstPhase{plan, budget, options, random}.run();
}

}  // namespace takt
