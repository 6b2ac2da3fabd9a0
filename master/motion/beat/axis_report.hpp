#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "master/motion/beat/gear_player.hpp"
#include "master/motion/beat/motion_order.hpp"

namespace takt::motion {

/// What a drive tells in a cycle.
enum class AxisCondition : std::uint8_t {
  enabled,   ///< it follows set-points of position (CiA 402: Operation enabled)
  disabled,  ///< it does not, without a fault
  fault,
  lost,    ///< its node is not heard
  halted,  ///< it is enabled, but has a Halt: some drives follow set-points nevertheless
  silent,  ///< its statusword is missing, so it may follow set-points
  unsent,  ///< it is enabled, but its set-points of several cycles were not sent
  /// It is enabled, but takes no points: the mode interpolated position is not active.
  inactive,
};

/// What is known of the home position of an axis.
enum class HomingState : std::uint8_t {
  none,    ///< no homing run has ended well since the device was last heard of anew
  runs,    ///< a homing run
  homed,   ///< the last run has ended well
  failed,  ///< the drive has reported an error in the last run
};

struct AxisInput {
  AxisCondition condition = AxisCondition::disabled;
  HomingState homing = HomingState::none;
  State actual;
  /// The position that the drive is commanded, if others have commanded it. Empty: it is the
  /// commanded position of the last report.
  std::optional<double> set_point;
  /// Samples of measured leaders: of the gear that the axis follows, and of one that is due.
  std::array<LeaderSample, 2> leaders{};
  /// The set-point of the last beat was due on the bus, and was not sent.
  bool is_unsent = false;

  /// The sample of this signal. It is lost if there is none.
  LeaderSample sample_of(std::uint16_t signal) const noexcept {
    for (const LeaderSample& sample : leaders) {
      if (sample.signal == signal) return sample;
    }
    return {};
  }
};

enum class AxisState : std::uint8_t { unpowered, standing, moving, stopping };

/// Why a group stops.
enum class StopCause : std::uint8_t {
  none,
  sender_silent,    ///< longer than the timeout of the motion
  sender_left,      ///< it may not command the axis any longer, for example after its release
  disabled,         ///< an axis left Operation enabled
  inactive,         ///< the drive of an axis has ended the mode interpolated position
  fault,            ///< of an axis
  node_lost,        ///< of an axis
  halted,           ///< the controlword of an axis has a Halt
  no_statusword,    ///< of an axis
  following_error,  ///< of an axis, above its limit
  points_ended,     ///< the stream of an axis has no more points, and the axis is not at rest
  end_of_range,     ///< a later stop would leave the range of positions
  limit,            ///< a set-point of an axis was outside the limits of the network file
  no_sync,          ///< SYNC was missing in several periods
  not_sent,         ///< the set-points of an axis were not sent in several cycles
  ordered_stop,     ///< of the master
  nmt_command,      ///< the master stops the axis, because NMT ends its PDO exchange
  application,      ///< it asked for the stop
  leader_lost,      ///< the leader of a gear has failed, or its position is missing
  phase_error,      ///< of a gear, above its limit
};

/// The first stop of a group since the motion of the axis began: why, and which axis was the cause.
struct Stop {
  StopCause cause = StopCause::none;
  std::uint8_t axis = 0;  ///< 0 where no axis is the cause

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(cause, axis);
  }
};

enum class Outcome : std::uint8_t {
  none,
  done,      ///< the axis stands at the end of the motion
  stopped,   ///< by a stop, see Stop
  replaced,  ///< by a later order
  // The others are refusals: the order did not begin.
  unsound,            ///< see is_sound()
  second_in_cycle,    ///< the axis has got another order in the same cycle
  too_late,           ///< its first cycle had passed
  other_start,        ///< it does not begin where the axis is commanded to be
  no_rest,            ///< the end of its profile contradicts `ending`
  no_stop,            ///< a gear whose limits do not allow a stop in time and range
  not_powered,        ///< the drive does not follow set-points
  is_stopping,        ///< the axis must come to rest first
  sender_was_silent,  ///< longer than the timeout, before its first cycle
  group_incomplete,   ///< an order of the group is missing, or was refused
};

/// Returns true if an order with this outcome may have begun: one that waited can end by a stop or
/// a newer one, too.
constexpr bool has_begun(Outcome outcome) noexcept {
  return outcome == Outcome::done || outcome == Outcome::stopped || outcome == Outcome::replaced;
}

/// How an order ended.
struct EndedOrder {
  std::uint32_t id = 0;
  Outcome outcome = Outcome::none;
};

/// The orders of one axis that ended in one cycle: at most one that waited and was replaced by a
/// newer one, the newer one, and the motion that ran.
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

/// What an axis does in a cycle.
struct AxisReport {
  AxisState state = AxisState::unpowered;
  HomingState homing = HomingState::none;
  State commanded;
  State actual;
  double following_error = 0.0;  ///< last commanded position minus actual position
  std::uint32_t running = 0;     ///< id of the motion of this cycle, 0 for none
  CycleNumber cycles_left = 0;   ///< until the end of the profile that runs
  CycleNumber began = 0;         ///< first cycle of the motion, as if no beat had been missed since
  CycleNumber delay = 0;         ///< periods by which this beat has delayed the motion
  /// The sender of the newest motion is alive, or the axis moves: the drive has to stay enabled.
  bool kept_alive = false;
  GearPhase gear = GearPhase::none;  ///< of the gear that the axis follows
  double phase_error = 0.0;          ///< commanded position minus the one that the gear prescribes
  Stop stop;
  EndedOrders ended;  ///< in this cycle

  /// Not the orders that have ended: they are told in the cycle in which they end.
  template <class Archive>
  void keep(Archive& archive) noexcept {
    archive(state, homing, commanded, actual, following_error, running, cycles_left, began, delay,
            kept_alive, gear, phase_error, stop);
  }
};

}  // namespace takt::motion
