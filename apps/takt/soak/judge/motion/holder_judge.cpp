#include "apps/takt/soak/judge/motion/holder_judge.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <fmt/format.h>

namespace takt::soak {

using namespace std::chrono_literals;

HolderJudge::HolderJudge(const BusPlan& plan, Verdict& verdict)
    : plan_{plan},
      verdict_{verdict},
      holders_(plan.nodes.size()),
      moved_(32),
      released_(32, -never) {}

void HolderJudge::note_move(SenderBit sender, Time now) {
  moved_[static_cast<std::size_t>(std::countr_zero(sender))] = now;
}

void HolderJudge::moved(std::size_t node_index, const Move& move, Time now) {
  Holder& holder = holders_[node_index];
  note_move(move.sender, now);
  if (holder.sender != 0 && holder.sender != move.sender && now < holder.until) {
    verdict_.report_violation(
        "no sender moves what another holds",
        fmt::format("program {1} moves {0}, but program {2} holds this axis for another {3} us",
                    plan_.nodes[node_index].name, std::countr_zero(move.sender),
                    std::countr_zero(holder.sender), (holder.until - now) / 1us));
  }
  if (holder.sender != move.sender) holder = {.sender = move.sender, .until = {}};
  // A value that was computed before the release may come to the wire later. It does not hold the
  // node.
  if (move.computed_from > released_[static_cast<std::size_t>(std::countr_zero(move.sender))]) {
    holder.until = std::max(holder.until, move.held_until);
  }
}

void HolderJudge::released(SenderBit sender, Time now) {
  released_[static_cast<std::size_t>(std::countr_zero(sender))] = now;
  for (Holder& holder : holders_) {
    if (holder.sender == sender) holder = {};
  }
}

void HolderJudge::begin_anew() { std::ranges::fill(holders_, Holder{}); }

Time HolderJudge::last_move(SenderBit sender) const noexcept {
  return moved_[static_cast<std::size_t>(std::countr_zero(sender))];
}

}  // namespace takt::soak
