#include "test/budget/worst_phase.hpp"

#include <algorithm>
#include <deque>

#include "master/sim/frame_bits.hpp"
#include "master/sim/virtual_bus.hpp"

namespace takt {
namespace {

constexpr Time moment{1};

/// Of many data the one with the most stuff bits.
Frame stuffed(const TrafficFrame& what, sim::Random& random) {
  Frame best{.id = what.cob_id, .length = what.bytes, .rtr = what.remote_request};
  std::uint16_t most = sim::frame_bits(best).total;
  Frame frame = best;
  for (unsigned attempt = 0; attempt < 400 && what.bytes != 0 && !what.remote_request; ++attempt) {
    // Runs of four behind one of five make the next stuff bit each; the rest is for the CRC.
    const auto pattern = static_cast<std::uint8_t>(0x0F0F >> (attempt % 8));
    frame.data.fill(pattern);
    for (unsigned i = 0; i < attempt / 8 % 4; ++i) {
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
        rows_{budget.rows},
        options_{options},
        random_{random},
        bus_{plan.bitrate, random.fork(1)},
        streams_(rows_.size()),
        seen_(rows_.size()) {
    master_ = bus_.attach({.order = sim::QueueOrder::fifo, .capacity = 1024});
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      auto& stream = streams_[i];
      stream.frame = stuffed(rows_[i].frame, random_);
      // A sender for each device's frame: what counts is the bus.
      stream.sender = rows_[i].frame.from_master ? master_ : bus_.attach({.capacity = 64});
      bus_.node(stream.sender).faults.error = options.wire_errors;
      stream.next = Time{random_.below(1'000'000)};
    }
  }

  std::vector<SeenRow> run() {
    for (unsigned cycle = 1; cycle <= options_.cycles; ++cycle) {
      cycle_ = cycle;
      sync_ = cycle * plan_.cycle.period;
      const Time next = sync_ + plan_.cycle.period;
      queue_sync();
      if (plan_.cycle.makes_sync()) queue_outputs();
      hurt_at(sync_);
      if (options_.emcys && cycle == options_.cycles / 2) burst();
      run_until(next);
    }
    return std::move(seen_);
  }

 private:
  struct Stream {
    Frame frame;
    sim::BusNodeIndex sender = 0;
    Time next{};              ///< may come again from here on
    std::deque<Time> queued;  ///< when those were that are not through
  };

  void queue(std::size_t row, Time ready, Time since) {
    auto& stream = streams_[row];
    if (bus_.queue(stream.sender, stream.frame, ready)) stream.queued.push_back(since);
  }

  void queue_sync() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].frame.kind == Traffic::sync) queue(i, sync_, sync_);
    }
  }

  /// SocketCAN sends in the order of the calls: that of the identifiers.
  void queue_outputs() {
    std::vector<std::size_t> due;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto& frame = rows_[i].frame;
      if (!frame.in_cycle || frame.kind != Traffic::rpdo || cycle_ % frame.every != 0) continue;
      if (frame.on_change && sync_ < streams_[i].next) continue;
      streams_[i].next = sync_ + frame.period;
      due.push_back(i);
    }
    std::ranges::sort(due, {}, [this](std::size_t i) { return rows_[i].frame.cob_id; });
    for (const std::size_t i : due) queue(i, sync_ + plan_.cycle.output_deadline, sync_);
    if (random_.chance(0.5)) hurt_at(sync_ + plan_.cycle.output_deadline);
  }

  /// Where another device makes SYNC the master counts from here on.
  void sync_arrived(Time end) {
    if (!plan_.cycle.makes_sync()) {
      sync_ = end;
      queue_outputs();
    }
    queue_inputs(end);
  }

  void queue_inputs(Time sync_end) {
    const bool all_late = random_.chance(0.5);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto& frame = rows_[i].frame;
      if (!frame.in_cycle || frame.kind != Traffic::tpdo) continue;
      if (cycle_ % frame.every != frame.turn.value_or(0)) continue;
      const auto limit = static_cast<std::uint32_t>(options_.device_time.count()) + 1;
      const Time own = all_late ? options_.device_time : Time{random_.below(limit)};
      queue(i, sync_end + own, sync_);
    }
    hurt_at(sync_end + options_.device_time);
  }

  /// What comes by itself comes now, if it may: of higher priority at once, the others one moment
  /// before, so that one of them has begun. In a flood it goes on as often as it may.
  void hurt_at(Time when) {
    if (random_.chance(0.1)) return;
    const bool flood = random_.chance(0.3);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto& frame = rows_[i].frame;
      auto& stream = streams_[i];
      const bool may_come = frame.by_itself() && frame.kind != Traffic::emcy;
      if (!may_come || when < stream.next || random_.chance(flood ? 0.05 : 0.2)) continue;
      Time ready = std::max(when - (random_.chance(0.7) ? moment : Time{}), stream.next);
      stream.next = std::max(stream.next, ready - frame.jitter);
      do {
        for (unsigned n = 0; n < frame.burst; ++n) queue(i, ready, ready);
        ready += frame.period;
        stream.next += frame.period;
      } while (flood && ready < when + plan_.cycle.period);
    }
  }

  void burst() {
    const Time when =
        sync_ + Time{static_cast<Time::rep>(
                    random_.next() % static_cast<std::uint64_t>(plan_.cycle.period.count()))};
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].frame.kind == Traffic::emcy) queue(i, when, when);
    }
  }

  void run_until(Time end) {
    sim::WireFrame wire;
    while (bus_.next_event() < end) {
      const Time now = bus_.next_event();
      if (bus_.step(now, wire) && wire.result == sim::WireResult::sent) arrived(wire);
    }
  }

  void arrived(const sim::WireFrame& wire) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      auto& stream = streams_[i];
      if (stream.frame.id != wire.frame.id || stream.frame.rtr != wire.frame.rtr) continue;
      if (stream.queued.empty()) continue;
      seen_[i].worst = std::max(seen_[i].worst, wire.end - stream.queued.front());
      ++seen_[i].frames;
      stream.queued.pop_front();
      if (rows_[i].frame.kind == Traffic::sync) sync_arrived(wire.end);
      return;
    }
  }

  const BusPlan& plan_;
  const std::vector<BudgetRow>& rows_;
  PhaseOptions options_;
  sim::Random random_;
  sim::VirtualBus bus_;
  sim::BusNodeIndex master_ = 0;
  std::vector<Stream> streams_;
  std::vector<SeenRow> seen_;
  unsigned cycle_ = 0;
  Time sync_{};
};

}  // namespace

std::vector<SeenRow> run_worst_phase(const BusPlan& plan, const BusBudget& budget,
                                     const PhaseOptions& options, sim::Random random) {
  return WorstPhase{plan, budget, options, random}.run();
}

}  // namespace takt
