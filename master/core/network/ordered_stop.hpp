#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/waits.hpp"
#include "master/core/network/axis_memory.hpp"
#include "master/core/network/axis_source.hpp"
#include "master/core/network/axis_stop.hpp"
#include "master/core/node_status.hpp"
#include "master/core/stop_state.hpp"

namespace takt {

/// One CiA 402 axis and the places of its values in the image. Values that are not mapped are read
/// by SDO.
struct StopAxis {
  std::uint8_t node_index = 0;
  std::uint8_t number = 0;  ///< axis number within its device, from 0
  std::optional<SignalIndex> controlword;
  std::optional<SignalIndex> statusword;
  std::optional<SignalIndex> velocity;
  std::optional<SignalIndex> position;
  std::uint16_t word_row = PdoTable::no_row;  ///< TPDO of the statusword
};

/// Input of the ordered stop in one cycle.
struct StopView {
  ReceivedValues received;
  std::span<const bool> exchanging;  ///< by node index: the PDOs of the node are exchanged
  std::span<const NodeStatus> nodes;
  /// True if the disarming of every device is finished, with or without success.
  bool disarmed = false;
  /// True if all frames of the NMT part of the stop were sent.
  bool network_stopped = false;
};

/// The ordered stop of a bus. Its order is: fallback of each axis, quick stop, wait for the
/// standstill, disable the axes, disarm the supervision of the master (only if every axis is
/// confirmed), NMT command, end. Each stage has a time limit, and the whole stop ends within
/// BusPlan::stop_timeout. Bus thread only. CiA 402-2, state machine of the drive.
class OrderedStop {
 public:
  static constexpr std::int64_t quick_stop_word = AxisStop::quick_stop_word;
  static constexpr std::int64_t disable_voltage_word = AxisStop::disable_voltage_word;
  /// The longest time for which other axes wait for an axis that does not answer.
  static constexpr Time longest_silence = std::chrono::seconds{1};

  explicit OrderedStop(const BusPlan& plan);
  /// Returns the axes of all CiA 402 devices that the master can command or read.
  static std::vector<StopAxis> axes_of(const BusPlan& plan);

  /// Value of target() for a stop of all nodes.
  static constexpr std::uint8_t every_node = 0xFF;

  /// Returns true if the node itself has reported OPERATIONAL. After a broadcast, the state of a
  /// node is only an assumption of the master.
  static bool says_operational(const NodeStatus& node) noexcept {
    return node.nmt == NmtState::operational && node.last_heartbeat != Time{};
  }

  /// Begins a stop; the stage must be `running` or `done`. `node_index` restricts the stop to the
  /// axes of one node. `memory` holds one entry for each axis; an empty span means that nothing is
  /// remembered.
  void begin(Time now, std::span<const NodeStatus> nodes, std::uint8_t node_index = every_node,
             std::span<const AxisMemory> memory = {}) noexcept;
  /// Begins a stop without any action on the axes, for a master that only listens.
  void begin_idle(Time now) noexcept;
  /// Takes the values of an axis that were read by SDO; the next step() uses them.
  void take(std::size_t axis, const AxisSample& sample) noexcept;
  /// Notes that the device has refused the read of the statusword of this axis.
  void take_refusal(std::size_t axis, std::uint32_t abort_code) noexcept {
    stops_[axis].refuse(abort_code);
  }
  /// Notes that the device has no statusword of this axis and is no drive.
  void take_absence(std::size_t axis) noexcept { stops_[axis].absent(); }
  /// Advances the stop. Call this once a cycle, before the outputs are packed.
  void step(Time now, const StopView& view) noexcept;
  /// Cancels the stop; the stage is `running` again.
  void call_off() noexcept { stage_ = StopStage::running; }

  StopStage stage() const noexcept { return stage_; }
  /// Returns the result so far.
  StopResult result() const noexcept;
  std::span<const StopAxis> axes() const noexcept { return axes_; }
  const AxisStop& axis(std::size_t index) const noexcept { return stops_[index]; }
  /// Returns true if the stop covers this axis. All other axes follow their commands.
  bool reaches(std::size_t axis) const noexcept {
    return node_index_ == every_node || axes_[axis].node_index == node_index_;
  }
  /// Returns the node whose axes are stopped, or every_node.
  std::uint8_t target() const noexcept { return node_index_; }
  /// Returns true if every axis that is to be stopped was disabled when the stop began, or before.
  bool nothing_to_stop() const noexcept;
  /// Returns true if the axes are at rest, or their time is over.
  bool axes_done() const noexcept { return stage_ > StopStage::disable; }
  /// Returns true if no TPDO brings the statusword of this axis often enough: it has to be read by
  /// SDO.
  bool needs_word(std::size_t axis, Time now) const noexcept {
    return !sources_[axis].word.serves(now);
  }
  /// Returns true if no TPDO brings the velocity or the position of this axis often enough.
  bool needs_motion(std::size_t axis, Time now) const noexcept {
    return !sources_[axis].velocity.serves(now) && !sources_[axis].position.serves(now);
  }
  /// Returns the controlword that this axis has to receive now. std::nullopt means that the
  /// commanded one is sent.
  std::optional<std::int64_t> controlword(std::size_t axis) const noexcept;

  /// Returns true if the statusword shows that the power stage is off.
  static constexpr bool disabled(std::int64_t statusword) noexcept {
    return AxisStop::disabled(statusword);
  }

 private:
  void look(Time now, const StopView& view) noexcept;
  bool all_settled(Time now, const StopView& view) const noexcept;
  bool all_confirmed() const noexcept;
  Time limit() const noexcept;
  void enter(StopStage stage) noexcept;
  /// Ends the stages that concern the axes. If an axis is not confirmed, all devices keep their
  /// supervision of the master, because only the devices themselves can still react.
  void leave_axes(StopStage stage) noexcept { enter(all_confirmed() ? StopStage::disarm : stage); }

  /// The TPDOs that bring the values of one axis.
  struct Sources {
    AxisSource word;
    AxisSource velocity;
    AxisSource position;
  };

  waits::StopLimits limits_;
  std::vector<StopAxis> axes_;
  std::vector<AxisPlan> plans_;
  std::vector<AxisStop> stops_;
  std::vector<Sources> sources_;
  std::vector<std::uint32_t> bootups_;  // boot-up messages of the node of each axis until now
  std::vector<AxisSample> answers_;     // values that were read by SDO since the last step
  StopStage stage_ = StopStage::running;
  Time begun_{};
  std::uint32_t steps_ = 0;               ///< steps in this stage
  std::uint8_t node_index_ = every_node;  ///< node whose axes are stopped
};

}  // namespace takt
