#include "test/budget/worst_phase.hpp"

#include <algorithm>
#include <deque>

#include "eds_parser/plan/frame_time.hpp"
#include "master/sim/bus/frame_bits.hpp"
#include "master/sim/bus/virtual_bus.hpp"
#include "test/budget/plan_traffic.hpp"

namespace takt {
namespace {

constexpr Time moment{1};

/// Of many data the one with the most stuff bits.
Frame stuffed(const PlanFrame& what, sim::Random& random) {
  Frame best{.id = what.cob_id, .length = what.bytes, .rtr = what.remote_request};
  std::uint16_t most = sim::frame_bits(best).total;
  Frame frame = best;
  for (unsigned attempt = 0; attempt < 400 && what.bytes != 0 && !what.remote_request; ++attempt) {
    // Runs of four behind one of five make the next stuff bit each; the rest is for the CRC.
    const auto pattern = static_cast<std::uint8_t>(0x0F0F >> (attempt % 8));
    const bool again = attempt >= 100 && attempt % 2 == 1;  // from the best so far
    if (again) frame.data = best.data;
    if (!again) frame.data.fill(pattern);
    for (unsigned i = 0; i < attempt / 8 % 4 + (again ? 1U : 0U); ++i) {
      frame.data[random.below(what.bytes)] = static_cast<std::uint8_t>(random.next());
    }
    for (std::size_t i = what.bytes; i < 8; ++i) frame.data[i] = 0;
    const std::uint16_t total = sim::frame_bits(frame).total;
    if (total <= most) continue;
    most = total;
    best = frame;
  }
  return best;
}

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
    unsigned left = 0;        ///< of a burst
    Time next{};              ///< may come again from here on
    std::deque<Time> queued;  ///< when those were that are not through
  };

  /// Of the devices one for each identifier: what counts is the bus.
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

  /// Of two rows with one identifier the second is what is sent on request.
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
    served_ = put_out_ = !plan_.cycle.makes_sync();
    awaited_ = 0;
    calm_ = random_.chance(0.4);
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      if (traffic_[i].sent == Sent::sync) queue(i, sync_, sync_);
    }
    if (options_.one_queue) answer_at_last();
    hurt_at(sync_);
  }

  /// SocketCAN sends in the order of the calls: that of the identifiers.
  void queue_outputs() {
    put_out_ = true;
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
    if (random_.chance(0.5)) hurt_at(sync_ + plan_.cycle.output_deadline);
  }

  /// Where another device makes SYNC the master counts from here on.
  void sync_arrived(Time end) {
    if (!plan_.cycle.makes_sync()) {
      sync_ = end;
      served_ = put_out_ = false;
    }
    if (starved_ >= patience) relieve(end);
    queue_inputs(end);
  }

  /// Where cycles are too full for it one frame goes out right behind SYNC.
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
    starved_ = 0;
  }

  void queue_inputs(Time sync_end) {
    std::vector<std::size_t> due;
    for (std::size_t i = 0; i < traffic_.size(); ++i) {
      const auto& frame = traffic_[i];
      if (frame.sent == Sent::after_sync && cycle_ % frame.every == frame.turn) due.push_back(i);
    }
    const bool all_late = random_.chance(0.6);
    const auto first = all_late && random_.chance(0.8) ? hurting_first(due) : std::nullopt;
    for (const std::size_t i : due) {
      const auto limit = static_cast<std::uint32_t>(options_.device_time.count()) + 1;
      Time own = all_late ? options_.device_time : Time{random_.below(limit)};
      if (first == i) own = Time{0};
      queue(i, sync_end + own, sync_);
      awaited_ += traffic_[i].awaited;
    }
    hurt_at(sync_end + options_.device_time);
  }

  /// The longest below some priority: it has begun when the others are ready.
  std::optional<std::size_t> hurting_first(std::vector<std::size_t> due) {
    if (due.empty()) return std::nullopt;
    const auto rank = [this](std::size_t i) { return sim::arbitration_rank(streams_[i].frame); };
    const auto length = [this](std::size_t i) { return sim::frame_bits(streams_[i].frame).total; };
    std::ranges::sort(due, {}, rank);
    const auto from = random_.below(static_cast<std::uint32_t>(due.size()));
    return *std::ranges::max_element(due.begin() + from, due.end(), {}, length);
  }

  /// What the master has to send beside the cycle, as much as ends before the outputs.
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
        starved_ += served == 0;
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

  /// What comes by itself comes now, if it may: of higher priority at once, the others one moment
  /// before, so that one of them has begun. In a flood it goes on as often as it may.
  void hurt_at(Time when) {
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
        dribble(i, when);
        continue;
      }
      if (when < stream.next) continue;
      stream.left = 0;
      Time ready = std::max(when - (random_.chance(0.7) ? moment : Time{}), stream.next);
      // A server is as late as it likes, and on time with the next.
      const Time jitter = frame.kind == Traffic::sdo ? frame.distance : Time{};
      stream.next = std::max(stream.next, ready - jitter);
      do {
        for (unsigned n = 0; n < frame.burst; ++n) queue(i, ready, ready);
        ready += frame.distance;
        stream.next += frame.distance;
      } while (flood && ready < when + plan_.cycle.period);
    }
  }

  /// Servers are as late as they like, but not by more than a round.
  void answer(Time when) {
    const unsigned most = random_.chance(0.6) ? 1000 : random_.below(4);
    for (unsigned n = 0; n < most && !owed_.empty(); ++n) {
      if (owed_.front() > when) return;
      answer_one(when - (random_.chance(0.7) ? moment : Time{}));
    }
  }

  /// What is due in this cycle. Of a long one a round is but a part.
  void answer_at_last() {
    while (!owed_.empty()) {
      const Time latest = owed_.front() + traffic_[*answers_].distance;
      if (latest > sync_ + plan_.cycle.period) return;
      answer_one(std::max(latest, sync_));
    }
  }

  /// A server that has not answered gets no other request.
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

  /// Some of what comes at once, and the others later in its period.
  void dribble(std::size_t i, Time when) {
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
    sim::WireFrame wire;
    for (;;) {
      const Time now = bus_.next_event();
      const Time next = std::min(now, end);
      if (!served_ && sync_ + plan_.cycle.receive_window < next) {
        serve(sync_ + plan_.cycle.receive_window);
      } else if (!put_out_ && sync_ + plan_.cycle.output_deadline < next) {
        queue_outputs();
      } else if (now >= end) {
        return;
      } else {
        step(now, wire);
      }
    }
  }

  void step(Time now, sim::WireFrame& wire) {
    if (options_.error_distance > Time{0}) disturb(now >= next_error_ ? 1.0 : 0.0);
    if (!bus_.step(now, wire)) return;
    if (wire.result == sim::WireResult::sent) return arrived(wire);
    ++seen_.errors;
    next_error_ = wire.end + options_.error_distance;
    if (random_.chance(0.3)) next_error_ = std::max(next_error_, hurting_moment());
    // No controller becomes passive: what is tried are the errors, not who they are blamed on.
    for (sim::BusNodeIndex i = 0; i < bus_.size(); ++i) bus_.node(i).reset_errors();
  }

  void disturb(double share) {
    for (sim::BusNodeIndex i = 0; i < bus_.size(); ++i) bus_.node(i).faults.error = share;
  }

  /// SYNC, an input or an output of the cycle in which there may be errors again.
  Time hurting_moment() {
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

  /// What a frame makes others send.
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

  static constexpr unsigned patience = 2;
  static constexpr std::uint32_t longest_answer = 100'000;

  const BusPlan& plan_;
  std::vector<PlanFrame> traffic_;
  PhaseOptions options_;
  sim::Random random_;
  sim::VirtualBus bus_;
  sim::BusNodeIndex master_ = 0;    ///< SYNC and outputs
  sim::BusNodeIndex services_ = 0;  ///< the master's other frames
  std::vector<Stream> streams_;
  std::optional<std::size_t> answers_{};  ///< SDO
  std::size_t unanswered_ = 0;            ///< or answers that are not through
  std::deque<Time> owed_;                 ///< SDO requests without an answer; when they ended
  SeenBus seen_;
  unsigned cycle_ = 0;
  Time sync_{};
  Time next_error_{};     ///< at the earliest
  int awaited_ = 0;       ///< inputs of this cycle that are not there
  unsigned starved_ = 0;  ///< cycles
  bool served_ = false;
  bool put_out_ = false;
  bool calm_ = false;  ///< what may come by itself waits for another cycle
};

}  // namespace

SeenBus run_worst_phase(const BusPlan& plan, const BusBudget& budget, const PhaseOptions& options,
                        sim::Random random) {
  return WorstPhase{plan, budget, options, random}.run();
}

}  // namespace takt
