#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_stream_t.hpp>
#include <vector>

#include "apps/takt/soak/judge/motion/holder_judge.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/motion_axes.hpp"

namespace takt::soak {

/// Limits of a motion, in counts and seconds.
struct MotionBounds {
  double velocity = 0;
  double acceleration = 0;
  double jerk = 0;
};

/// A message about motions that a program has sent. A motion_gear_t has the kind "gear" here; the
/// first message of a stream has the kind "stream", with the end of its path as the position, and
/// the others have the kind "points".
struct SentMotion {
  const motion_command_t& command;
  SenderBit sender = 0;
  Time computed_from{};  ///< SYNC time of the image that the program has seen
  Time points_until{};   ///< time of the newest point of a stream, from the begin of the stream on
  const motion_gear_t* gear = nullptr;      ///< message of the kind "gear"
  const motion_stream_t* stream = nullptr;  ///< message of the kinds "stream" and "points"
};

/// A move, a jog, a gear or a stream of one axis that a program has sent.
struct OrderedMotion {
  std::uint64_t message = 0;  ///< number of the message; the same for all axes of a group
  std::size_t group_size = 1;
  bool creeps = false;  ///< the axis may be as slow as the slowest axis of its group
  SenderBit sender = 0;
  Time sent{};
  Time computed_from{};
  Time timeout{};
  MotionBounds bounds{};
  MotionBounds fastest{};                ///< largest limits of all motions that may have run before
  std::optional<std::int64_t> target{};  ///< target in counts; empty for a jog and a gear
  bool follows = false;  ///< the motion is a gear: the axis is at rest while its leader is at rest
  std::optional<std::int32_t> stream{};  ///< `id` of a stream; empty for other motions
  Time ended = never;                    ///< time after which the motion moves nothing
  Time points_end = never;  ///< end of the points of a stream that gets no further points
};

/// Determines from the messages of the programs which motions may run at this moment. A motion may
/// run while a message of its sender has come within the timeout, and then for as long as its stop
/// takes. For a jog, only the messages that name its axis count. The results are upper limits: a
/// message may have been refused, and a gear may have been replaced.
class MotionOrders {
 public:
  /// The longest time from the sending of a motion to its begin. Messages are not slower, and those
  /// that wait for longer while the front thread does not run are discarded.
  static constexpr Time longest_way = std::chrono::milliseconds{400};
  /// Returns an upper limit of the time of a stop within `bounds` from a motion within `fastest`.
  static Time stop_time(const MotionBounds& bounds, const MotionBounds& fastest) noexcept;

  explicit MotionOrders(const BusPlan& plan);

  void commanded(const SentMotion& sent, Time now);
  /// Call this when a new process of the daemon begins, which has received no motion.
  void begin_anew();
  /// Notes that the axis has been at standstill since this time. Forgets the motions that have
  /// therefore ended.
  void stood(std::size_t axis, Time since, Time now);
  /// Call this when the motion has come to rest at its target. The motion, and the motions that its
  /// sender has sent before, are then over.
  void arrived(std::size_t axis, const OrderedMotion& order);
  /// Notes that the drive of the axis did not follow at `now`. Its motion has ended, and the other
  /// axes of its group stop.
  void failed(std::size_t axis, Time now);

  /// Returns the number of the axis with this target position, or with this velocity offset.
  std::optional<std::size_t> axis_of(SignalIndex output) const noexcept;
  const std::vector<MotionAxis>& axes() const noexcept { return axes_; }
  bool may_move(std::size_t axis, Time now) const noexcept { return bounds(axis, now).has_value(); }
  /// Returns the largest limits of the motions that may run; empty if none may.
  std::optional<MotionBounds> bounds(std::size_t axis, Time now) const noexcept;
  /// Returns the sender of all motions that may run; 0 if there is none, or more than one.
  SenderBit mover(std::size_t axis, Time now) const noexcept;
  /// Returns true if a sender of motions may keep the outputs of the node valid.
  bool keeps_alive(std::size_t node_index, Time now) const noexcept;
  std::span<const OrderedMotion> orders(std::size_t axis) const noexcept { return orders_[axis]; }
  bool was_commanded(std::size_t axis) const noexcept;
  /// Returns the time at which the newest motion that is not over was sent; 0 if all motions are
  /// over.
  Time newest(std::size_t axis) const noexcept {
    return orders_[axis].empty() ? Time{} : orders_[axis].back().sent;
  }
  std::uint64_t motions() const noexcept { return motions_; }  ///< moves, jogs and gears
  std::uint64_t gears() const noexcept { return gears_; }
  std::uint64_t streams() const noexcept { return streams_; }

 private:
  /// `limits:` of one axis, in counts and seconds; 0 where there is none.
  using FileLimits = MotionBounds;
  static constexpr std::size_t most_senders = 32;

  void add(const SentMotion& sent, const motion_goal_t& goal, std::size_t axis, Time now);
  void take_points(const SentMotion& sent, OrderedMotion& order, Time now) const noexcept;
  MotionBounds bounds_of(const motion_goal_t& goal, std::size_t axis) const noexcept;
  /// Returns the end of an order of `axis`.
  Time end_of(std::size_t axis, const OrderedMotion& order) const noexcept;
  Time latest_begin(const OrderedMotion& order) const noexcept;
  Time heard(SenderBit sender) const noexcept;

  const BusPlan& plan_;
  std::vector<MotionAxis> axes_;
  std::vector<FileLimits> file_;
  std::vector<std::vector<OrderedMotion>> orders_;  // indexed by axis; the oldest motion first
  // Longest sum of timeout and stopping time, indexed by axis and sender.
  std::vector<std::array<Time, most_senders>> longest_;
  std::array<Time, most_senders> heard_{};
  // Time of the message that renews a jog, indexed by axis and sender.
  std::vector<std::array<Time, most_senders>> named_;
  std::uint64_t messages_ = 0;
  std::uint64_t motions_ = 0;
  std::uint64_t gears_ = 0;
  std::uint64_t streams_ = 0;
};

}  // namespace takt::soak
