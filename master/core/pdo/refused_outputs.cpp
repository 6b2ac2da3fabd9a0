#include "master/core/pdo/refused_outputs.hpp"

#include <chrono>

namespace takt {

RefusedOutputs::RefusedOutputs(const BusPlan& plan)
    : refused_(plan.limits.outputs.size()), held_(plan.nodes.size(), 0) {
  constexpr Time longest = std::chrono::seconds{1};
  outputs_.reserve(plan.limits.outputs.size());
  for (const OutputLimit& limit : plan.limits.outputs) {
    const Signal& signal = plan.layout.signals[limit.signal];
    std::uint64_t longest_pause = signal.fallback_cycles;
    if (longest_pause == 0 && plan.cycle.period > Time{0}) {
      longest_pause = static_cast<std::uint64_t>(longest / plan.cycle.period);
    }
    outputs_.push_back({.node_index = signal.node_index, .longest_pause = longest_pause});
  }
}

void RefusedOutputs::open(std::size_t node_index) noexcept {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (outputs_[i].node_index != node_index) continue;
    change(i, State::admitted);
    refused_[i] = {};
  }
}

void RefusedOutputs::change(std::size_t place, State state) noexcept {
  if (refused_[place].state == state) return;
  refused_[place].state = state;
  std::uint16_t& held = held_[outputs_[place].node_index];
  if (state == State::refused) {
    held_nodes_ += held++ == 0;
  } else {
    held_nodes_ -= --held == 0;
  }
}

bool RefusedOutputs::refuse(std::size_t place, std::uint64_t cycle) noexcept {
  const bool first = refused_[place].state == State::admitted;
  change(place, State::refused);
  refused_[place].cycle = cycle;
  return first;
}

void RefusedOutputs::end(std::size_t place, std::uint64_t cycle) noexcept {
  if (cycle > refused_[place].cycle) change(place, State::admitted);
}

void RefusedOutputs::end_old(std::uint64_t cycle) noexcept {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (refused_[i].state == State::admitted) continue;
    if (cycle > refused_[i].cycle + outputs_[i].longest_pause) change(i, State::admitted);
  }
}

}  // namespace takt
