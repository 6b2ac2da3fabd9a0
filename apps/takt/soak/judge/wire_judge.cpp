#include "apps/takt/soak/judge/wire_judge.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <fmt/format.h>

#include "apps/takt/soak/evidence/image_judge.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t target_position = 0x607A;
constexpr Time longest_lease = 1s;         // upper limit for every command
constexpr unsigned cycles_on_the_way = 4;  // longest way from the front thread to the wire
constexpr unsigned lease_tolerance = 5;    // a lease may end this much early

bool is_target(const Signal& signal) noexcept { return signal.object.index == target_position; }

}  // namespace

WireJudge::WireJudge(const BusPlan& plan, sim::World& world, Verdict& verdict)
    : plan_{plan},
      verdict_{verdict},
      outputs_(plan.layout.outputs()),
      holders_{plan, verdict},
      limits_{plan, world, verdict},
      motions_{plan, verdict, holders_} {}

void WireJudge::commanded(SignalIndex index, std::int64_t value, const SentCommand& command) {
  const Signal& signal = plan_.layout.signals[index];
  const Time period = plan_.cycle.period;
  Time span = longest_lease;
  if (signal.fallback_cycles != 0) span = signal.fallback_cycles * period;
  if (command.time_to_live != 0) span = std::min(span, command.time_to_live * period);
  Known& known = output(index).known[static_cast<std::uint64_t>(value) & mask_of(signal.bits)];
  known.senders |= command.sender;
  known.computed_from = std::max(known.computed_from, command.computed_from);
  known.until = std::max(known.until, command.computed_from + span + cycles_on_the_way * period);
  known.held_until =
      std::max(known.held_until, command.computed_from + span - lease_tolerance * period);
}

void WireJudge::forged(SignalIndex signal, std::int64_t value) {
  const std::uint64_t mask = mask_of(plan_.layout.signals[signal].bits);
  output(signal).known.try_emplace(static_cast<std::uint64_t>(value) & mask);
}

void WireJudge::begin_anew() {
  holders_.begin_anew();
  limits_.begin_anew();
  motions_.begin_anew();
}

void WireJudge::sent(std::span<const Frame> frames, Time now) {
  for (const Frame& frame : frames) {
    if (plan_.cycle.sync && frame.id == plan_.cycle.sync_cob_id) motions_.sync_sent();
    for (const PdoRow& row : plan_.pdos.rpdos) {
      if (row.cob_id != frame.id || row.on_request || row.multiplexed()) continue;
      for (const PdoField& field : plan_.pdos.fields_of(row)) {
        judge(field.signal, bits_of(frame, field.bit_offset, field.bits), now);
      }
    }
  }
  limits_.judge(now);
}

void WireJudge::judge(SignalIndex index, std::uint64_t value, Time now) {
  const Signal& signal = plan_.layout.signals[index];
  Output& output = this->output(index);
  // An output that was not sent for five periods begins with the value of the device (607A with
  // that of 6064).
  const bool begins = now > output.when + 5 * plan_.cycle.period;
  const bool differs = value != output.last;
  const bool changed = !begins && differs;
  limits_.sent(index, value, begins);
  output.last = value;
  output.when = now;
  const auto found = output.known.find(value);
  const Known* const known = found == output.known.end() ? nullptr : &found->second;
  const bool fresh = known != nullptr && now <= known->until;
  // While an axis does not follow its set-points, the master sends its actual position.
  const bool actual = is_target(signal) && limits_.is_actual(index, value);
  if (is_target(signal)) {
    const auto counts = static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
    motions_.sent(index, counts, {.begins = begins, .by_set_point = fresh || actual}, now);
  }
  if (by_motion(index, value, differs, now)) return;
  if (fresh) {
    if (is_target(signal) && changed) judge_holder(signal, *known, now);
    return;
  }
  if (actual) return;
  const bool old =
      known != nullptr && (is_target(signal) ? changed : !is_lasting(plan_, signal, value));
  const bool moved = changed && is_target(signal) && motions_.orders().axis_of(index);
  if (old || (known == nullptr && (moved || !is_lasting(plan_, signal, value)))) {
    report_stale_output(signal, value, known, now);
  }
}

/// Returns true if a motion may be the cause of the value: it sets the output, it has moved the
/// axis to its present position, it has set a velocity offset to 0, or its sender keeps the outputs
/// of the node valid.
bool WireJudge::by_motion(SignalIndex index, std::uint64_t value, bool differs,
                          Time now) const noexcept {
  const Signal& signal = plan_.layout.signals[index];
  if (motions_.explains(index, now)) return true;
  if (is_target(signal)) return !differs && motions_.was_led(index);
  const bool still = motions_.orders().axis_of(index) && value == 0;
  return still || (!differs && motions_.orders().keeps_alive(signal.node_index, now));
}

void WireJudge::judge_holder(const Signal& signal, const Known& known, Time now) {
  ++moves_;
  if (!std::has_single_bit(known.senders)) return;  // several programs have commanded the value
  holders_.moved(signal.node_index,
                 {.sender = known.senders,
                  .computed_from = known.computed_from,
                  .held_until = known.held_until},
                 now);
}

void WireJudge::report_stale_output(const Signal& signal, std::uint64_t value, const Known* known,
                                    Time now) {
  const auto index = static_cast<SignalIndex>(&signal - plan_.layout.signals.data());
  if (is_target(signal) && (known == nullptr || known->senders != 0) && motions_.was_led(index)) {
    return verdict_.report_violation(
        "an axis moves only while its sender commands it",
        fmt::format("{}.{} = {} is sent, but no program has commanded a motion or a set-point "
                    "within its timeout",
                    plan_.nodes[signal.node_index].name, signal.name,
                    static_cast<std::int32_t>(static_cast<std::uint32_t>(value))));
  }
  std::string what = plan_.nodes[signal.node_index].name + "." + signal.name + " = " +
                     hex(static_cast<std::uint32_t>(value)) + " is sent, which ";
  if (known == nullptr) {
    what += "no program has commanded";
  } else if (known->senders == 0) {
    what += "is forged";
  } else {
    what += "has been too old for " + std::to_string((now - known->until) / 1us) + " us";
  }
  verdict_.report_violation("no output is older than its time to live", what);
}

}  // namespace takt::soak
