#include "eds_parser/budget/service_traffic.hpp"

#include <algorithm>

#include "eds_parser/plan/cycle_compiler.hpp"
#include "eds_parser/plan/frame_time.hpp"

namespace takt {
namespace {

constexpr Time long_cycle = std::chrono::milliseconds{50};  // such a cycle has several rounds
constexpr Time round_distance = std::chrono::milliseconds{10};

}  // namespace

ServiceShare service_share(const BusPlan& plan, double load_of_others) noexcept {
  const auto& cycle = plan.cycle;
  const TimeBudget wire = time_budget(plan);
  const Time pair = wire_time(2 * std::uint64_t{worst_frame_bits(longest_data)}, plan.bitrate);
  // The time that neither the cycle nor the other traffic needs.
  const Time left =
      std::chrono::duration_cast<Time>(cycle.period * std::max(0.0, 1.0 - load_of_others)) -
      cycle.quiet_before_sync;
  const Time slack = std::min<Time>(cycle.output_deadline - wire.inputs_wire, left);
  const Time round = cycle.period >= long_cycle ? round_distance : cycle.period;
  const Time share =
      std::max(slack, Time{0}) * round.count() / std::max<Time::rep>(cycle.period.count(), 1);
  // If no cycle has room for a request with its answer, the master still sends one in every
  // `cycles_to_relief` cycles.
  if (share < pair) return {.dialogues = 1, .round = cycles_to_relief * round};
  const auto most = std::max<Time::rep>(cycle.service_frames, 1);
  return {.dialogues = static_cast<unsigned>(std::min<Time::rep>(share / pair, most)),
          .round = round};
}

}  // namespace takt
