#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "master/motion/beat/gear_player.hpp"
#include "master/motion/beat/motion_order.hpp"

namespace takt::motion {

/// The condition of a drive in a cycle, as far as it concerns motions.
enum class AxisCondition : std::uint8_t {
  enabled,   ///< the drive follows position set-points (CiA 402: Operation enabled)
  disabled,  ///< the drive follows no set-points and has no fault
  fault,
  lost,    ///< the node of the drive does not exchange PDOs
  halted,  ///< the drive is enabled, with Halt in its controlword; some drives follow set-points
           ///< nevertheless
  silent,  ///< the statusword is missing, so the drive may follow set-points
  unsent,  ///< the drive is enabled, but its set-points of several cycles were not sent
  /// The drive is enabled, but takes no points: the mode interpolated position is not active.
  inactive,
};

/// The knowledge about the home position of an axis.
enum class HomingState : std::uint8_t {
  none,  ///< no homing run has succeeded since the node began to exchange PDOs, or the last run was
         ///< broken off
  runs,  ///< a homing run is in progress
  homed,   ///< the last homing run has succeeded
  failed,  ///< the drive has reported an error in the last homing run
};

struct AxisInput {
  AxisCondition condition = AxisCondition::disabled;
  HomingState homing = HomingState::none;
  State actual;
  /// The commanded position of the drive, if something other than a motion has commanded it. If it
  /// is empty, the commanded position of the last report applies.
  std::optional<double> set_point;
  /// Samples of measured leaders: for the gear that the axis follows, and for a gear that is due.
  std::array<LeaderSample, 2> leaders{};
  /// The set-point of the last beat was due on the bus, and was not sent.
  bool is_unsent = false;

  /// Returns the sample of this signal. If there is none, the age of the result is `lost`.
  LeaderSample sample_of(std::uint16_t signal) const noexcept {
    for (const LeaderSample& sample : leaders) {
      if (sample.signal == signal) return sample;
    }
    return {};
  }
};

enum class AxisState : std::uint8_t { unpowered, standing, moving, stopping };

/// The reason why a group stops.
enum class StopCause : std::uint8_t {
  none,
  sender_silent,  ///< the sender was silent for longer than the timeout of the motion
  sender_left,    ///< the sender may not command the axis any longer, for example after its release
  disabled,       ///< an axis left Operation enabled
  inactive,       ///< the drive of an axis has ended the mode interpolated position
  fault,          ///< an axis has a fault
  node_lost,      ///< the node of an axis does not exchange PDOs
  halted,         ///< the controlword of an axis has the bit Halt
  no_statusword,  ///< the statusword of an axis is missing
  following_error,  ///< the following error of an axis is above its limit
  points_ended,     ///< the stream of an axis has no more points, and the axis is not at rest
  end_of_range,     ///< a later stop would leave the range of positions
  limit,            ///< a set-point of an axis was outside the limits of the network file
  no_sync,          ///< SYNC was missing in several periods
  not_sent,         ///< the set-points of an axis were not sent in several cycles
  ordered_stop,     ///< the ordered stop of the master has begun
  nmt_command,      ///< the master stops the axis, because NMT ends its PDO exchange
  application,      ///< the application has requested the stop
  leader_lost,      ///< the leader of a gear has failed, or its position is missing
  phase_error,      ///< the phase error of a gear is above its limit
};

/// The first stop of a group since the motion of the axis began: its cause, and the causing axis.
struct Stop {
  StopCause cause = StopCause::none;
  std::uint8_t axis = 0;  ///< axis that has caused the stop; 0 if the cause concerns no single axis

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(cause, axis);
  }
};

enum class Outcome : std::uint8_t {
  none,
  done,      ///< the axis is at rest at the end of the motion
  stopped,   ///< a stop has ended the order, see Stop
  replaced,  ///< a later order has replaced this order
  // The following outcomes are refusals: the order did not begin.
  unsound,          ///< the order does not pass is_sound()
  second_in_cycle,  ///< the axis has received another order in the same cycle
  too_late,         ///< the first cycle of the order had passed
  other_start,      ///< the order does not begin in the commanded state of the axis
  no_rest,          ///< the end of its profile contradicts `ending`
  no_stop,      ///< the limits of a gear do not allow a stop within the permitted time and range
  not_powered,  ///< the drive does not follow set-points
  is_stopping,  ///< the axis must come to rest first
  sender_was_silent,  ///< the sender was silent for longer than the timeout, before the first cycle
  group_incomplete,   ///< an order of the group is missing, or was refused
};

/// Returns true if an order with this outcome may have begun. A stop or a newer order can also end
/// an order that waits.
constexpr bool has_begun(Outcome outcome) noexcept {
  return outcome == Outcome::done || outcome == Outcome::stopped || outcome == Outcome::replaced;
}

/// The end of an order.
struct EndedOrder {
  std::uint32_t id = 0;
  Outcome outcome = Outcome::none;
};

/// The orders of one axis that ended in one cycle: at most an order that waited and was replaced by
/// a newer order, this newer order, and the motion that ran.
class EndedOrders {
 public:
  static constexpr std::size_t capacity = 3;

  void add(EndedOrder order) noexcept {
    if (size_ < capacity) orders_[size_++] = order;
  }
  void clear() noexcept { size_ = 0; }
  std::span<const EndedOrder> orders() const noexcept { return std::span{orders_}.first(size_); }

 private:
  std::array<EndedOrder, capacity> orders_{};
  std::size_t size_ = 0;
};

/// The state and the motion of an axis in a cycle.
struct AxisReport {
  AxisState state = AxisState::unpowered;
  HomingState homing = HomingState::none;
  State commanded;
  State actual;
  double following_error = 0.0;  ///< last commanded position minus actual position
  std::uint32_t running = 0;     ///< id of the motion of this cycle, 0 for none
  CycleNumber cycles_left = 0;   ///< number of cycles until the end of the profile that runs
  /// First cycle of the motion, plus the periods by which missed beats have delayed the motion
  /// since.
  CycleNumber began = 0;
  CycleNumber delay = 0;  ///< periods by which this beat has delayed the motion
  /// The sender of the newest motion is alive, or the axis moves: the drive has to stay enabled.
  bool kept_alive = false;
  GearPhase gear = GearPhase::none;  ///< phase of the gear that the axis follows
  double phase_error = 0.0;          ///< commanded position minus the one that the gear prescribes
  Stop stop;
  EndedOrders ended;  ///< orders that ended in this cycle

  /// Does not keep `ended`: the orders are reported in the cycle in which they end.
  template <class Archive>
  void keep(Archive& archive) noexcept {
    archive(state, homing, commanded, actual, following_error, running, cycles_left, began, delay,
            kept_alive, gear, phase_error, stop);
  }
};

}  // namespace takt::motion
