#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "master/core/network/axis_memory.hpp"
#include "master/core/network/ordered_stop.hpp"
#include "master/core/network/stop_requests.hpp"
#include "master/rt/machines/bus_machines.hpp"

namespace takt {

/// Remembers for each axis whether it is disabled, whether a service may have enabled it since, and
/// what the drive does at a quick stop. The stops use this knowledge. Bus thread only.
template <Services S>
class AxisMemories {
 public:
  /// Keeps a reference to `bus`.
  explicit AxisMemories(BusMachines<S>& bus)
      : bus_{bus}, axes_{OrderedStop::axes_of(bus.plan)}, memories_(axes_.size()) {}

  std::span<const StopAxis> axes() const noexcept { return axes_; }
  std::span<const AxisMemory> all() const noexcept { return memories_; }
  AxisMemory& operator[](std::size_t axis) noexcept { return memories_[axis]; }

  /// Takes the received statuswords and the commanded controlwords. Call this once a cycle.
  void update() noexcept {
    for (std::size_t i = 0; i < memories_.size(); ++i) update(axes_[i], memories_[i]);
  }
  /// Notes a request that may bring a controlword to an axis. The content of an RPDO sent on
  /// request is not inspected: it counts as enabling.
  void note(const Request& request) noexcept {
    const bool writes = request.kind == RequestKind::sdo_download;
    if (!writes && request.kind != RequestKind::pdo_exchange) return;
    for (std::size_t i = 0; i < memories_.size(); ++i) {
      if (node_of(axes_[i]) != request.node) continue;
      if (writes && request.object != controlword_of(axes_[i])) continue;
      const bool known = writes && request.transfer == nullptr && request.size != 0;
      memories_[i].write(known ? std::to_integer<std::int64_t>(request.data[0]) : enabling_word);
    }
  }

  /// Takes the quick stop option codes that the boot of a node has read, and reports drives that
  /// coast.
  void learn(std::size_t node_index, std::span<const LimitReading> readings,
             OutputMoment moment) noexcept {
    for (std::size_t i = 0; i < memories_.size(); ++i) {
      const StopAxis& axis = axes_[i];
      if (axis.node_index != node_index) continue;
      memories_[i].note_quick_stop(quick_stop_of(axis, readings));
      if (memories_[i].quick_stop() != QuickStop::coasts) continue;
      bus_.events.push({.when = moment.now,
                        .cycle = moment.cycle,
                        .kind = EventKind::drive_coasts,
                        .node = node_of(axis),
                        .value = axis.number});
    }
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(memories_);
  }

 private:
  static constexpr std::int64_t enabling_word = 0x0F;  ///< "enable operation"

  static ObjectKey controlword_of(const StopAxis& axis) noexcept {
    return {StopRequests::controlword_of(axis), 0};
  }
  static QuickStop quick_stop_of(const StopAxis& axis,
                                 std::span<const LimitReading> readings) noexcept {
    const ObjectKey object = quick_stop_option(axis.number);
    const auto found = std::ranges::find(readings, object, &LimitReading::object);
    if (found == readings.end()) return QuickStop::unread;
    return found->value == 0 ? QuickStop::coasts : QuickStop::brakes;
  }
  std::uint8_t node_of(const StopAxis& axis) const noexcept {
    return bus_.plan.nodes[axis.node_index].id.value();
  }
  /// Returns true while a request that may bring a controlword to this axis is not answered yet.
  bool word_under_way(const StopAxis& axis) const noexcept {
    const std::uint8_t node = node_of(axis);
    return bus_.pdo_requests.reaches(node) || bus_.services.writes(node, controlword_of(axis));
  }
  void update(const StopAxis& axis, AxisMemory& memory) noexcept {
    const WorkingImage& image = bus_.pdos.image();
    std::optional<std::int64_t> statusword;
    const bool exchanging = bus_.exchanging[axis.node_index];
    if (axis.statusword && exchanging &&
        memory.has_new_frames(bus_.pdos.inputs().marks()[axis.word_row].received)) {
      statusword = image.values[*axis.statusword];
    }
    std::optional<std::int64_t> controlword;
    if (axis.controlword && exchanging && bus_.pdos.outputs().known(*axis.controlword)) {
      controlword = image.values[*axis.controlword];
    }
    if (memory.awaits_answer() && !word_under_way(axis)) memory.note_answer();
    memory.look(statusword, controlword);
    const NodeStatus& node = bus_.services.nodes()[axis.node_index];
    const bool found = node.boot_count == 0 && node.boot != BootState::ready;
    if (found && OrderedStop::says_operational(node)) memory.note_operational();
  }

  BusMachines<S>& bus_;
  std::vector<StopAxis> axes_;
  std::vector<AxisMemory> memories_;  ///< one element per axis
};

}  // namespace takt
