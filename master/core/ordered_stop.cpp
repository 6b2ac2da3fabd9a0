#include "master/core/ordered_stop.hpp"

#include <algorithm>

namespace takt {
namespace {

constexpr std::uint16_t axis_step = 0x800;  // between two axes of one device
constexpr std::uint16_t axes_per_node = 8;
constexpr std::uint32_t fallback_cycles = 2;  // enough that each device has seen it act

std::optional<SignalIndex> find(const ImageLayout& layout, std::uint8_t node_index,
                                std::uint16_t index, bool output) {
  for (std::size_t i = 0; i < layout.signals.size(); ++i) {
    const Signal& signal = layout.signals[i];
    if (signal.node_index == node_index && signal.object == ObjectKey{index, 0} &&
        signal.output == output) {
      return static_cast<SignalIndex>(i);
    }
  }
  return std::nullopt;
}

}  // namespace

OrderedStop::OrderedStop(const BusPlan& plan)
    : limits_{waits::stop_limits(plan.stop_timeout, plan.cycle.period)} {
  for (std::size_t node = 0; node < plan.nodes.size(); ++node) {
    if (!plan.nodes[node].cia402) continue;
    const auto node_index = static_cast<std::uint8_t>(node);
    for (std::uint16_t axis = 0; axis < axes_per_node; ++axis) {
      const auto at = [&](std::uint16_t base) {
        return static_cast<std::uint16_t>(base + axis * axis_step);
      };
      if (const auto controlword = find(plan.layout, node_index, at(0x6040), true)) {
        axes_.push_back({.node_index = node_index,
                         .controlword = *controlword,
                         .statusword = find(plan.layout, node_index, at(0x6041), false)});
      }
    }
  }
}

void OrderedStop::begin(Time now) noexcept {
  if (stage_ != StopStage::running) return;
  begun_ = now;
  steps_ = 0;
  stage_ = StopStage::fallback;
}

bool OrderedStop::all_disabled(const StopView& view) const noexcept {
  return std::ranges::all_of(axes_, [&](const StopAxis& axis) {
    if (!view.exchanging[axis.node_index]) return true;  // nothing more can be done for it
    return axis.statusword && disabled(view.values[*axis.statusword]);
  });
}

Time OrderedStop::limit() const noexcept {
  switch (stage_) {
    case StopStage::running:
      return never;
    case StopStage::fallback:
      return begun_ + limits_.fallback;
    case StopStage::quick_stop:
      return begun_ + limits_.quick_stop;
    case StopStage::disable:
      return begun_ + limits_.disable;
    case StopStage::nmt:
      return begun_ + limits_.nmt;
    case StopStage::done:
      return never;
  }
  return never;
}

void OrderedStop::advance() noexcept {
  stage_ = static_cast<StopStage>(static_cast<std::uint8_t>(stage_) + 1);
  steps_ = 0;
}

void OrderedStop::step(Time now, const StopView& view) noexcept {
  const bool out_of_time = now >= limit();
  // A word has to be on the bus before the answer to it can count.
  const bool seen = steps_++ >= fallback_cycles;
  switch (stage_) {
    case StopStage::fallback:
      if (axes_.empty() && seen) {
        stage_ = StopStage::nmt;
        steps_ = 0;
      } else if (seen || out_of_time) {
        advance();
      }
      break;
    case StopStage::quick_stop:
      if (seen && all_disabled(view)) {
        stage_ = StopStage::nmt;
        steps_ = 0;
      } else if (out_of_time) {
        advance();
      }
      break;
    case StopStage::disable:
      if ((seen && all_disabled(view)) || out_of_time) advance();
      break;
    case StopStage::nmt:
      if (view.network_stopped || out_of_time) advance();
      break;
    case StopStage::running:
    case StopStage::done:
      break;
  }
}

std::optional<std::int64_t> OrderedStop::controlword() const noexcept {
  switch (stage_) {
    case StopStage::quick_stop:
      return quick_stop_word;
    case StopStage::disable:
    case StopStage::nmt:
      return disable_voltage_word;
    case StopStage::running:
    case StopStage::fallback:
    case StopStage::done:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace takt
