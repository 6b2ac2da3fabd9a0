#include "apps/takt/soak/judge/output_judge.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "apps/takt/soak/evidence/image_judge.hpp"
#include "master/wire/nmt.hpp"

namespace takt::soak {
OutputJudge::OutputJudge(const BusPlan& plan, Verdict& verdict)
    : plan_{plan},
      verdict_{verdict},
      commands_(plan.layout.outputs()),
      count_(plan.layout.outputs(), 0) {}

void OutputJudge::commanded(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live,
                            Time now) {
  const std::size_t output = signal - plan_.layout.inputs;
  const std::uint64_t mask = mask_of(plan_.layout.signals[signal].bits);
  // The time to live is extended by two cycles and a quarter: one until the bus thread takes the
  // command, one in which the command is sent late, and a quarter before that.
  commands_[output][count_[output]++ % depth] = {
      .value = static_cast<std::uint64_t>(value) & mask,
      .until = now + (time_to_live + 2) * plan_.cycle.period + plan_.cycle.period / 4};
}

void OutputJudge::sent(std::span<const Frame> frames, Time now) {
  for (const Frame& frame : frames) {
    note_nmt(frame, now);
    if (plan_.cycle.sync && frame.id == plan_.cycle.sync_cob_id) judge_sync(frame, now);
    for (const PdoRow& row : plan_.pdos.rpdos) {
      if (row.cob_id == frame.id && !row.on_request && !row.multiplexed()) {
        judge_pdo(row, frame, now);
      }
    }
  }
}

void OutputJudge::judge_sync(const Frame& frame, Time now) {
  if (last_sync_ > Time{} && now - last_sync_ < plan_.cycle.period * 45 / 100) {
    verdict_.report_violation("no burst of SYNCs", std::to_string((now - last_sync_).count()) +
                                                       " ns after the SYNC before");
  }
  last_sync_ = now;
  if (plan_.cycle.sync_overflow < 2 || frame.length == 0) return;
  judge_counter(frame.data[0], now);
  last_counter_ = frame.data[0];
}

/// Notes the NMT commands that let the SYNC counter start at 1. CiA 301, 7.2.5.2.
void OutputJudge::note_nmt(const Frame& frame, Time now) {
  const auto nmt = decode_nmt(frame);
  if (!nmt) return;
  const bool stops = nmt->command == NmtCommand::stop;
  if (is_reset(nmt->command) ? nmt->node == 0 : stopped_ && !stops) restarts_ = now;
  if (nmt->node == 0) stopped_ = stops;
}

/// Checks the SYNC counter. It may restart up to ten cycles before its NMT command leaves, if the
/// bus is full.
void OutputJudge::judge_counter(std::uint8_t counter, Time now) {
  const Time time_limit = 10 * plan_.cycle.period;
  const unsigned wanted = last_counter_ % plan_.cycle.sync_overflow + 1U;
  if (counter != wanted && counter != 1) {
    verdict_.report_violation("the SYNC counter has no gap",
                              std::to_string(counter) + " after " + std::to_string(last_counter_));
  }
  if (counter != wanted && counter == 1) {
    if (own_orders_ == 0) {
      restarted_ = now;
    } else {
      --own_orders_;
    }
  }
  if (restarted_ == never) return;
  if (restarts_ >= restarted_ - time_limit) {
    restarted_ = never;
  } else if (now - restarted_ > time_limit) {
    restarted_ = never;
    verdict_.report_violation("the SYNC counter has no gap",
                              "the counter restarted at 1 without a reason");
  }
}

bool OutputJudge::fresh(std::size_t output, std::uint64_t value, Time now) const noexcept {
  return std::ranges::any_of(commands_[output], [&](const Command& command) {
    return command.value == value && command.until >= now;
  });
}

void OutputJudge::judge_pdo(const PdoRow& row, const Frame& frame, Time now) {
  for (const PdoField& field : plan_.pdos.fields_of(row)) {
    const Signal& signal = plan_.layout.signals[field.signal];
    const std::uint64_t value = bits_of(frame, field.bit_offset, field.bits);
    const bool lasting = signal.fallback == Fallback::hold || is_lasting(plan_, signal, value);
    if (lasting || fresh(field.signal - plan_.layout.inputs, value, now)) continue;
    verdict_.report_violation(
        "no stale output",
        fmt::format("RPDO{} of node {} sends {} = {}, which no program has commanded "
                    "within its time to live",
                    row.number, row.node.value(), signal.name,
                    hex(static_cast<std::uint32_t>(value))));
  }
}

}  // namespace takt::soak
