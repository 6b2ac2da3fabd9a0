#include "eds_parser/plan/cycle_compiler.hpp"

#include <algorithm>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/frame_time.hpp"

namespace takt {
namespace {

constexpr unsigned longest_data = 8;
constexpr std::uint32_t service_pair_bits = 2 * worst_frame_bits(longest_data);
// The largest number of SDO requests for each 10 ms, unless the network file sets `service_frames`.
constexpr Time::rep usual_service_frames = 16;
// If the cycle has this length or is longer, the master processes services every 10 ms.
constexpr Time long_cycle = std::chrono::milliseconds{50};
constexpr int event_share = 4;  ///< Event-driven outputs get at most a quarter of the period.
constexpr Time longest_window = std::chrono::milliseconds{50};
constexpr Time shortest_margin = std::chrono::microseconds{20};
constexpr Time longest_margin = std::chrono::microseconds{200};

std::int64_t us(Time time) { return time / std::chrono::microseconds{1}; }

Time row_time(const PdoRow& row, std::uint32_t bitrate) {
  return wire_time(worst_frame_bits(row.length, row.cob_id.is_extended()), bitrate);
}

Time frame_time(std::uint32_t bitrate) {
  return wire_time(worst_frame_bits(longest_data), bitrate);
}

/// Returns how long before SYNC the master's own frames must have ended. The time covers the
/// longest frame that may be on the wire, and 2 % of the period (20..200 us) for the answer to that
/// frame and for delays. If another device produces SYNC, the time also covers a SYNC that is
/// early.
Time quiet_time(const BusPlan& plan) {
  const CyclePlan& cycle = plan.cycle;
  const Time margin = std::clamp<Time>(cycle.period / 50, shortest_margin, longest_margin);
  const Time early = cycle.sync && cycle.sync_followed ? cycle.followed_tolerance() : Time{0};
  return frame_time(plan.bitrate) + margin + early;
}

class CycleCompiler {
 public:
  CycleCompiler(const NetworkSpec& spec, std::span<const NodePdos> nodes, BusPlan& plan,
                NetworkReport& report)
      : spec_{spec}, nodes_{nodes}, plan_{plan}, cycle_{plan.cycle}, report_{report} {}

  void run() {
    cycle_.quiet_before_sync = quiet_time(plan_);
    const TimeBudget wire = time_budget(plan_);
    cycle_.output_deadline = std::max<Time>(
        cycle_.period - cycle_.quiet_before_sync - wire.outputs_wire, wire.inputs_wire);
    set_receive_window(wire);
    set_service_frames(wire);
    judge(wire);
    judge_device_windows(wire);
    judge_types();
  }

 private:
  SourcePos period_pos() const {
    return plan_.cycle.sync ? spec_.master.sync_period_us.pos : spec_.master.pos;
  }

  /// Sets the receive window to the middle of the time between the earliest arrival of all inputs
  /// and the outputs. A device may then be late by half of this time, and an application still has
  /// the other half. The window is at most 80 % of the period, and at most 50 ms so that services
  /// do not wait longer, unless the inputs take longer to arrive.
  void set_receive_window(const TimeBudget& wire) {
    if (spec_.receive_window_us.given) {
      cycle_.receive_window = std::chrono::microseconds{*spec_.receive_window_us};
      if (cycle_.receive_window >= cycle_.period) {
        report_.error(spec_.receive_window_us.pos, "out-of-range", "`receive_window_us` of ",
                      us(cycle_.receive_window), " us is not shorter than the period of ",
                      us(cycle_.period), " us");
      }
      return;
    }
    const Time middle = wire.earliest + (cycle_.output_deadline - wire.earliest) / 2;
    cycle_.receive_window =
        std::min<Time>({std::max<Time>(wire.earliest, middle), cycle_.period * 4 / 5,
                        std::max<Time>(wire.earliest, longest_window)});
  }

  /// Sets how many SDO requests with their answers fit into the time that SYNC and the PDOs leave
  /// free.
  void set_service_frames(const TimeBudget& wire) {
    const Time left =
        cycle_.period - wire.inputs_wire - wire.outputs_wire - cycle_.quiet_before_sync;
    const Time pair = wire_time(service_pair_bits, plan_.bitrate);
    const Time span = cycle_.period < long_cycle ? cycle_.period : Time{0};
    const Time::rep usual =
        usual_service_frames * std::max<Time::rep>(span / std::chrono::milliseconds{10}, 1);
    cycle_.service_frames = spec_.master.service_frames.value_or(
        static_cast<std::uint16_t>(std::clamp<Time::rep>(left / pair, 1, usual)));
  }

  void judge(const TimeBudget& wire) {
    if (!plan_.cycle.sync) return;
    const std::string frames =
        concat(us(wire.inputs_wire), " us of SYNC and TPDOs and ", us(wire.outputs_wire),
               " us of RPDOs at ", plan_.bitrate / 1000, " kbit/s");
    if (!fits_period(plan_)) {
      report_.error(
          period_pos(), "does-not-fit", frames, ", and ", us(cycle_.quiet_before_sync),
          " us of quiet before SYNC, do not fit into a period of ", us(cycle_.period),
          " us: a longer `sync_period`, fewer or shorter PDOs, or slower types (n SYNCs)");
      return;
    }
    const TimeBudget budget = time_budget(plan_);
    if (!budget.next_sync) {
      report_.warning(period_pos(), "no-time-budget", frames,
                      " leave no time for an application in a period of ", us(cycle_.period),
                      " us: what the application computes from SYNC k acts at SYNC k+2");
    }
  }

  /// Warns if synchronous RPDOs arrive after the synchronous window of a device (0x1007), because
  /// the device drops them.
  void judge_device_windows(const TimeBudget& wire) {
    if (!plan_.cycle.sync) return;
    const Time sent = cycle_.output_deadline + wire.outputs_wire;
    for (const NodePdos& node : nodes_) {
      const bool listens = std::ranges::any_of(node.pdos, [](const EffectivePdo& pdo) {
        return pdo.use == PdoUse::exchanged && !pdo.is_tpdo && pdo.synchronous();
      });
      const SubObject* object = node.node.dictionary->find(ObjectKey{0x1007, 0});
      if (!listens || object == nullptr) continue;
      const auto device = integer_of(object->value());
      const std::int64_t window = spec_.master.sync_window_us.given
                                      ? std::int64_t{*spec_.master.sync_window_us}
                                      : device.value_or(0);
      if (window <= 0 || std::chrono::microseconds{window} >= sent) continue;
      report_.warning(
          spec_.master.sync_window_us.given ? spec_.master.sync_window_us.pos : node.node.spec->pos,
          "sync-window", "node `", node.node.spec->name, "` accepts synchronous RPDOs until ",
          window, " us after SYNC (0x1007), but the outputs go out between ",
          us(cycle_.output_deadline), " and ", us(sent), " us");
    }
  }

  void judge_types() {
    if (plan_.cycle.sync) return;
    for (const NodePdos& node : nodes_) {
      for (const EffectivePdo& pdo : node.pdos) {
        if (pdo.use != PdoUse::exchanged || !pdo.synchronous()) continue;
        report_.warning(
            pdo.pos, "no-sync", pdo.label(*node.node.spec), " is synchronous (type ",
            pdo.transmission,
            "), but the network has no SYNC: set `sync_period` of `master`, or transmission 255");
      }
    }
  }

  const NetworkSpec& spec_;
  std::span<const NodePdos> nodes_;
  BusPlan& plan_;
  CyclePlan& cycle_;
  NetworkReport& report_;
};

}  // namespace

TimeBudget time_budget(const BusPlan& plan) noexcept {
  TimeBudget budget;
  if (plan.cycle.sync) {
    budget.inputs_wire =
        wire_time(worst_frame_bits(plan.cycle.sync_overflow != 0 ? 1 : 0), plan.bitrate);
  }
  for (const PdoRow& row : plan.pdos.tpdos) {
    if (row.cyclic()) budget.inputs_wire += row_time(row, plan.bitrate);
  }
  Time by_event{};
  for (const PdoRow& row : plan.pdos.rpdos) {
    (row.synchronous() ? budget.outputs_wire : by_event) += row_time(row, plan.bitrate);
  }
  // Event-driven RPDOs rarely all change in the same cycle. RPDOs that do not fit into a cycle are
  // sent in the next one.
  budget.outputs_wire += std::min<Time>(by_event, plan.cycle.period / event_share);
  budget.earliest = budget.inputs_wire + frame_time(plan.bitrate);
  budget.latest = plan.cycle.output_deadline;
  budget.next_sync = budget.latest > budget.earliest;
  return budget;
}

bool fits_period(const BusPlan& plan) noexcept {
  if (!plan.cycle.sync) return true;
  const TimeBudget wire = time_budget(plan);
  return wire.inputs_wire + wire.outputs_wire + plan.cycle.quiet_before_sync <= plan.cycle.period;
}

void compile_cycle(const NetworkSpec& spec, std::span<const NodePdos> nodes, BusPlan& plan,
                   NetworkReport& report) {
  CycleCompiler{spec, nodes, plan, report}.run();
}

}  // namespace takt
