#include "apps/takt/soak/judge/wire_judge.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <fmt/format.h>

#include "apps/takt/soak/judge/image_judge.hpp"

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
      holders_(plan.nodes.size()),
      moved_(32),
      released_(32, -never),
      limits_{plan, world, verdict} {}

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

void WireJudge::released(SenderBit sender, Time now) {
  released_[static_cast<std::size_t>(std::countr_zero(sender))] = now;
  for (Holder& holder : holders_) {
    if (holder.sender == sender) holder = {};
  }
}

void WireJudge::begin_anew() {
  std::ranges::fill(holders_, Holder{});
  limits_.begin_anew();
}

Time WireJudge::last_move(SenderBit sender) const noexcept {
  return moved_[static_cast<std::size_t>(std::countr_zero(sender))];
}

void WireJudge::sent(std::span<const Frame> frames, Time now) {
  for (const Frame& frame : frames) {
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
  // The first value of an output is the one that the device has (607A from 6064).
  const bool begins = now > output.when + 5 * plan_.cycle.period;
  const bool changed = !begins && value != output.last;
  limits_.sent(index, value, begins);
  output.last = value;
  output.when = now;
  const auto found = output.known.find(value);
  const Known* const known = found == output.known.end() ? nullptr : &found->second;
  if (known != nullptr && now <= known->until) {
    if (is_target(signal) && changed) judge_holder(signal, *known, now);
    return;
  }
  // While an axis does not obey, the master itself sends its actual position.
  if (is_target(signal) && limits_.is_actual(index, value)) return;
  const bool old =
      known != nullptr && (is_target(signal) ? changed : !is_lasting(plan_, signal, value));
  if (old || (known == nullptr && !is_lasting(plan_, signal, value))) {
    report_stale_output(signal, value, known, now);
  }
}

void WireJudge::judge_holder(const Signal& signal, const Known& known, Time now) {
  Holder& holder = holders_[signal.node_index];
  ++moves_;
  if (!std::has_single_bit(known.senders)) return;  // two programs commanded the same value
  const auto sender = static_cast<std::size_t>(std::countr_zero(known.senders));
  moved_[sender] = now;
  if (holder.sender != 0 && holder.sender != known.senders && now < holder.until) {
    verdict_.report_violation(
        "no sender moves what another holds",
        fmt::format("{} is moved by program {}, but program {} holds it for another {} us",
                    plan_.nodes[signal.node_index].name, std::countr_zero(known.senders),
                    std::countr_zero(holder.sender), (holder.until - now) / 1us));
  }
  if (holder.sender != known.senders) holder = {.sender = known.senders, .until = {}};
  // A value from before the release may come to the wire later; it does not hold the node.
  if (known.computed_from > released_[sender]) {
    holder.until = std::max(holder.until, known.held_until);
  }
}

void WireJudge::report_stale_output(const Signal& signal, std::uint64_t value, const Known* known,
                                    Time now) {
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
