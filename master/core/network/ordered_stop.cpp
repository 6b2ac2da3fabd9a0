#include "master/core/network/ordered_stop.hpp"

#include <algorithm>
#include <utility>

namespace takt {
namespace {

constexpr std::uint16_t axis_step = 0x800;  // index distance between two axes of one device
constexpr std::uint16_t axes_per_node = 8;
constexpr std::uint32_t fallback_cycles = 2;  // long enough for each device to receive the fallback

/// Returns std::nullopt if the device has no such axis, or if the master has no means to command
/// it.
std::optional<StopAxis> axis_of(const BusPlan& plan, std::uint8_t node_index, std::uint8_t number) {
  const auto at = [&](std::uint16_t base, bool output) {
    const auto index = static_cast<std::uint16_t>(base + number * axis_step);
    return plan.layout.find(node_index, {index, 0}, output);
  };
  StopAxis axis{.node_index = node_index,
                .number = number,
                .controlword = at(0x6040, true),
                .statusword = at(0x6041, false),
                .velocity = at(0x606C, false),
                .position = at(0x6064, false)};
  if (axis.statusword) axis.word_row = plan.layout.signals[*axis.statusword].row;
  const NodePlan& node = plan.nodes[node_index];
  const bool planned = std::ranges::find(node.axes, number, &AxisPlan::number) != node.axes.end();
  if (axis.controlword || (node.boot && (axis.statusword || planned))) return axis;
  return std::nullopt;
}

AxisPlan plan_of(const NodePlan& node, std::uint8_t number) {
  const auto found = std::ranges::find(node.axes, number, &AxisPlan::number);
  return found == node.axes.end() ? AxisPlan{.number = number} : *found;
}

/// Returns the knowledge about an axis before the stop. Even if the boot of its node has failed,
/// the axis may be enabled, because another master or a previous run may have enabled it. In CiA
/// 302-2, the status B means that no answer has come, and L means that the node was found
/// OPERATIONAL.
AxisPrior prior_of(const NodeStatus& node, const AxisMemory& memory) noexcept {
  if (node.boot_count != 0 || node.boot == BootState::ready) {
    return memory.disabled() ? AxisPrior::disabled : AxisPrior::exposed;
  }
  const bool operational =
      OrderedStop::says_operational(node) || node.boot_letter == 'L' || memory.operational();
  if (operational) return AxisPrior::foreign;
  const bool answered = node.boot_letter != 0 && node.boot_letter != 'B';
  return node.nmt != NmtState::unknown || answered ? AxisPrior::heard : AxisPrior::untouched;
}

}  // namespace

std::vector<StopAxis> OrderedStop::axes_of(const BusPlan& plan) {
  std::vector<StopAxis> axes;
  for (std::size_t node = 0; node < plan.nodes.size(); ++node) {
    if (!plan.nodes[node].cia402) continue;
    for (std::uint8_t number = 0; number < axes_per_node; ++number) {
      const auto axis = axis_of(plan, static_cast<std::uint8_t>(node), number);
      if (axis) axes.push_back(*axis);
    }
  }
  return axes;
}

OrderedStop::OrderedStop(const BusPlan& plan)
    : limits_{waits::stop_limits(plan.stop_timeout, plan.cycle.period)},
      axes_{axes_of(plan)},
      bootups_(axes_.size()),
      answers_(axes_.size()) {
  for (const StopAxis& axis : axes_) {
    plans_.push_back(plan_of(plan.nodes[axis.node_index], axis.number));
    stops_.emplace_back(plans_.back());
    sources_.push_back({.word = AxisSource{plan, axis.statusword},
                        .velocity = AxisSource{plan, axis.velocity},
                        .position = AxisSource{plan, axis.position}});
  }
}

void OrderedStop::begin(Time now, std::span<const NodeStatus> nodes, std::uint8_t node_index,
                        std::span<const AxisMemory> memory) noexcept {
  begun_ = now;
  node_index_ = node_index;
  enter(StopStage::fallback);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    stops_[i] = AxisStop{plans_[i]};
    answers_[i] = {};
    bootups_[i] = nodes[axes_[i].node_index].bootups;
    sources_[i].word.begin();
    sources_[i].velocity.begin();
    sources_[i].position.begin();
    const AxisMemory known = i < memory.size() ? memory[i] : AxisMemory{};
    const AxisPrior prior = prior_of(nodes[axes_[i].node_index], known);
    stops_[i].begin(now, reaches(i) ? prior : AxisPrior::untouched);
    if (i < memory.size() && !known.quiet()) stops_[i].note_command();
    if (known.quick_stop() != QuickStop::unread) {
      stops_[i].note_quick_stop(known.quick_stop() == QuickStop::coasts);
    }
  }
}

void OrderedStop::begin_idle(Time now) noexcept {
  begun_ = now;
  node_index_ = every_node;
  enter(StopStage::fallback);
  for (AxisStop& stop : stops_) {
    stop = AxisStop{};
    stop.begin(now, AxisPrior::untouched);
  }
}

void OrderedStop::take(std::size_t axis, const AxisSample& sample) noexcept {
  if (sample.statusword) answers_[axis].statusword = sample.statusword;
  if (sample.velocity) answers_[axis].velocity = sample.velocity;
  if (sample.position) answers_[axis].position = sample.position;
  if (sample.word_asked) answers_[axis].word_asked = sample.word_asked;
  if (sample.motion_asked) answers_[axis].motion_asked = sample.motion_asked;
}

/// Collects the samples: the values of TPDOs that have come since the previous step, and values
/// that were read by SDO.
void OrderedStop::look(Time now, const StopView& view) noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const std::uint32_t bootups = view.nodes[axes_[i].node_index].bootups;
    if (std::exchange(bootups_[i], bootups) != bootups) stops_[i].note_restart();
    AxisSample sample = std::exchange(answers_[i], AxisSample{});
    const bool exchanging = view.exchanging[axes_[i].node_index];
    if (stage_ == StopStage::fallback && steps_ == 1 && exchanging) {
      stops_[i].recall(sources_[i].word.newest(view.received),
                       sources_[i].velocity.newest(view.received));
    }
    const auto read = [&](AxisSource& source, std::optional<std::int64_t>& value,
                          std::optional<Time>& asked) {
      const auto received = source.take(now, view.received);
      if (!received || !exchanging) return;
      value = received;
      asked.reset();
    };
    read(sources_[i].word, sample.statusword, sample.word_asked);
    read(sources_[i].position, sample.position, sample.motion_asked);
    read(sources_[i].velocity, sample.velocity, sample.motion_asked);
    stops_[i].step(now, sample);
    if (axes_[i].controlword && exchanging) stops_[i].note_command();
  }
}

bool OrderedStop::all_settled(Time now, const StopView& view) const noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const bool unreachable =
        !view.exchanging[axes_[i].node_index] && stops_[i].silence(now) >= longest_silence;
    if (!stops_[i].settled() && !unreachable) return false;
  }
  return true;
}

/// An axis may have received an enabling controlword in the previous cycle, which its statusword
/// does not show yet. Therefore the result is false during the stage `fallback`, in which every
/// axis is commanded for some cycles.
bool OrderedStop::nothing_to_stop() const noexcept {
  if (stage_ == StopStage::fallback) return false;
  return std::ranges::all_of(stops_, [](const AxisStop& stop) {
    return stop.state() == AxisState::exempt || stop.state() == AxisState::rested;
  });
}

bool OrderedStop::all_confirmed() const noexcept {
  return std::ranges::all_of(stops_, &AxisStop::confirmed);
}

StopResult OrderedStop::result() const noexcept {
  if (stage_ == StopStage::running) return StopResult::none;
  if (!axes_done()) return StopResult::under_way;
  return all_confirmed() ? StopResult::confirmed : StopResult::unconfirmed;
}

Time OrderedStop::limit() const noexcept {
  switch (stage_) {
    case StopStage::running:
    case StopStage::done:
      return never;
    case StopStage::fallback:
      return begun_ + limits_.fallback;
    case StopStage::quick_stop:
      return begun_ + limits_.quick_stop;
    case StopStage::disable:
      return begun_ + limits_.disable;
    case StopStage::disarm:
      return begun_ + limits_.disarm;
    case StopStage::nmt:
      return begun_ + limits_.nmt;
  }
  return never;
}

void OrderedStop::enter(StopStage stage) noexcept {
  stage_ = stage;
  steps_ = 0;
}

/// The transitions of the stop:
///
///   stage       ends when                                                 next
///   fallback    the plan has no axes and the fallback acts, or its limit  disarm
///   fallback    the fallback acts, or its limit                           quick_stop
///   quick_stop  every axis is settled or unreachable                      disarm, nmt
///   quick_stop  its limit: the axes that still move are cut               disable
///   disable     every axis is settled or unreachable, or its limit        disarm, nmt
///   disarm      every device is disarmed, or its limit                    nmt
///   nmt         every command is sent, or its limit                       done
///
/// `disarm, nmt` means disarm if every axis is confirmed, otherwise nmt. `its limit` is the time
/// limit of the stage.
void OrderedStop::step(Time now, const StopView& view) noexcept {
  if (stage_ == StopStage::running || stage_ == StopStage::done) return;
  const bool out_of_time = now >= limit();
  // A statusword counts as an answer only after the controlword was sent.
  const bool seen = steps_++ >= fallback_cycles;
  if (!axes_done()) look(now, view);
  switch (stage_) {
    case StopStage::fallback:
      if (seen || out_of_time) enter(axes_.empty() ? StopStage::disarm : StopStage::quick_stop);
      break;
    case StopStage::quick_stop:
      if (seen && all_settled(now, view)) {
        leave_axes(StopStage::nmt);
      } else if (out_of_time) {
        for (AxisStop& stop : stops_) stop.cut();
        enter(StopStage::disable);
      }
      break;
    case StopStage::disable:
      if ((seen && all_settled(now, view)) || out_of_time) leave_axes(StopStage::nmt);
      break;
    case StopStage::disarm:
      if (view.disarmed || out_of_time) enter(StopStage::nmt);
      break;
    case StopStage::nmt:
      if (view.network_stopped || out_of_time) enter(StopStage::done);
      break;
    case StopStage::running:
    case StopStage::done:
      break;
  }
}

std::optional<std::int64_t> OrderedStop::controlword(std::size_t axis) const noexcept {
  if (!reaches(axis)) return std::nullopt;
  switch (stage_) {
    case StopStage::fallback:
      // If only one node is stopped, its outputs take no fallback, and its application continues.
      if (node_index_ != every_node) return stops_[axis].controlword();
      // The declared fallback may disable the axis, but an axis that may move must not be disabled.
      if (stops_[axis].confirmed()) return std::nullopt;
      return stops_[axis].controlword();
    case StopStage::quick_stop:
      return stops_[axis].controlword();
    case StopStage::disable:
    case StopStage::disarm:
    case StopStage::nmt:
      return disable_voltage_word;
    case StopStage::running:
    case StopStage::done:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace takt
