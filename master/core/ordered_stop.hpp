#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/waits.hpp"
#include "master/core/axis_memory.hpp"
#include "master/core/axis_stop.hpp"
#include "master/core/node_status.hpp"

namespace takt {

/// How far the ordered stop of a bus is.
enum class StopStage : std::uint8_t {
  running,     ///< no stop asked for
  fallback,    ///< every output takes its declared fallback
  quick_stop,  ///< axes stop quickly; each is disabled when it was seen at standstill
  disable,     ///< the time is over: axes that are still enabled are disabled
  disarm,      ///< what the devices watch of the master is disarmed
  nmt,         ///< nodes get their last NMT command
  done,        ///< SYNC may end
};

/// Whether the ordered stop was seen to succeed. The numbers are those of `stop` in status_t.
enum class StopResult : std::uint8_t {
  none,         ///< no stop asked for
  under_way,    ///< it is not decided yet
  confirmed,    ///< every axis was seen at standstill and disabled, or was disabled before
  unconfirmed,  ///< some axis was not
};

/// One CiA 402 axis: where its words are in the image. What is not mapped is read by SDO.
struct StopAxis {
  std::uint8_t node_index = 0;
  std::uint8_t number = 0;  ///< of the axis within its device, from 0
  std::optional<SignalIndex> controlword;
  std::optional<SignalIndex> statusword;
  std::optional<SignalIndex> velocity;
  std::optional<SignalIndex> position;
};

/// What the ordered stop sees once a cycle.
struct StopView {
  std::span<const std::int64_t> values;  ///< the image
  std::span<const std::uint64_t> stale;  ///< of the image, a bit for each signal
  std::span<const bool> exchanging;      ///< per node: its PDOs are exchanged
  std::span<const NodeStatus> nodes;
  bool disarmed = false;
  bool network_stopped = false;
};

/// Fallback of each axis -> quick stop -> standstill seen -> disabled seen -> disarmed, where every
/// axis was confirmed -> NMT -> end. Each stage has a limit, the whole ends within
/// BusPlan::stop_timeout. CiA 402-2, state machine of the drive.
class OrderedStop {
 public:
  static constexpr std::int64_t quick_stop_word = AxisStop::quick_stop_word;
  static constexpr std::int64_t disable_voltage_word = AxisStop::disable_voltage_word;
  /// Other axes do not wait longer for one that can't be reached.
  static constexpr Time longest_silence = std::chrono::seconds{1};

  explicit OrderedStop(const BusPlan& plan);
  static std::vector<StopAxis> axes_of(const BusPlan& plan);

  static constexpr std::uint8_t every_node = 0xFF;

  /// The node itself says that it is OPERATIONAL: that it obeys a broadcast is only assumed.
  static bool says_operational(const NodeStatus& node) noexcept {
    return node.nmt == NmtState::operational && node.last_heartbeat != Time{};
  }

  /// From `running` or `done` on. `node_index`: only the axes of this node are stopped. `memory`:
  /// of each axis; empty: nothing is remembered.
  void begin(Time now, std::span<const NodeStatus> nodes, std::uint8_t node_index = every_node,
             std::span<const AxisMemory> memory = {}) noexcept;
  /// Nothing was asked for: a master that only listens stops nobody.
  void begin_idle(Time now) noexcept;
  /// What an SDO has read of an axis; used in the next step.
  void take(std::size_t axis, const AxisSample& sample) noexcept;
  /// The device has refused to tell the statusword of this axis.
  void take_refusal(std::size_t axis, std::uint32_t abort_code) noexcept {
    stops_[axis].refuse(abort_code);
  }
  /// The device has no statusword of this axis, and is no drive.
  void take_absence(std::size_t axis) noexcept { stops_[axis].absent(); }
  /// Once a cycle, before the outputs are packed.
  void step(Time now, const StopView& view) noexcept;
  /// No stop any more.
  void call_off() noexcept { stage_ = StopStage::running; }

  StopStage stage() const noexcept { return stage_; }
  StopResult result() const noexcept;
  std::span<const StopAxis> axes() const noexcept { return axes_; }
  const AxisStop& axis(std::size_t index) const noexcept { return stops_[index]; }
  /// This axis is stopped; the others go on as they are commanded.
  bool reaches(std::size_t axis) const noexcept {
    return node_index_ == every_node || axes_[axis].node_index == node_index_;
  }
  /// The node whose axes are stopped, or every_node.
  std::uint8_t target() const noexcept { return node_index_; }
  /// Every axis that is to be stopped was disabled when the stop began, or before.
  bool nothing_to_stop() const noexcept;
  /// The axes are at rest, or their time is over.
  bool axes_done() const noexcept { return stage_ > StopStage::disable; }
  /// What the controlword of this axis has to be now; none: what is commanded.
  std::optional<std::int64_t> controlword(std::size_t axis) const noexcept;

  static constexpr bool disabled(std::int64_t statusword) noexcept {
    return AxisStop::disabled(statusword);
  }

 private:
  void look(Time now, const StopView& view) noexcept;
  bool all_settled(Time now, const StopView& view) const noexcept;
  bool all_confirmed() const noexcept;
  Time limit() const noexcept;
  void enter(StopStage stage) noexcept;
  void leave_axes(StopStage stage) noexcept;

  waits::StopLimits limits_;
  std::vector<StopAxis> axes_;
  std::vector<AxisPlan> plans_;
  std::vector<AxisStop> stops_;
  std::vector<AxisSample> answers_;  // by SDO, since the last step
  StopStage stage_ = StopStage::running;
  Time begun_{};
  std::uint32_t steps_ = 0;               ///< in this stage
  std::uint8_t node_index_ = every_node;  ///< whose axes are stopped
};

}  // namespace takt
