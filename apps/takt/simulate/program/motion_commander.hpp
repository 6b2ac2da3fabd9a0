#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_stream_t.hpp>
#include <vector>

#include "apps/takt/simulate/program/stream_path.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/motion_axes.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// Chooses the motions that a program commands. It sends a message every 20 ms, which may come 10
/// ms late; now and then it is silent for 300 ms, seldom for 2 s. Each process has its own limits
/// and timeout. The target of a move, in counts, has the number of the program in its low four
/// bits. Some processes also let an axis follow another axis, which any program may command, or
/// move an axis along the points of a stream.
class MotionCommander {
 public:
  /// `nodes` are those of the program, in the order of BusPlan::nodes.
  MotionCommander(const BusPlan& plan, const std::vector<bool>& nodes, unsigned number);

  /// Begins anew, as a new process of the program.
  void start(sim::Random random);
  /// Returns the next message if it is due. The caller fills in the fields for the sender and the
  /// time. A message of the kind "gear" has to be sent as gear() returns it, and one of the kinds
  /// "stream" (the first one of a stream) and "points" as stream() returns it.
  std::optional<motion_command_t> next(Time now);
  /// Returns the message with which the axes of `command`, which next() has returned last, follow
  /// their leader.
  motion_gear_t gear(const motion_command_t& command) const;
  /// Returns the message with the points of a stream, as gear() does.
  motion_stream_t stream(const motion_command_t& command) const;
  /// Returns the time of the newest point of the present stream, from its begin on.
  Time points_until() const noexcept { return path_.sent_until(); }
  /// Takes the present target position of the drive, in counts.
  void see(SignalIndex target, std::int64_t counts, Time now) noexcept;
  /// From now on each message is a stop of all axes.
  void leave() noexcept { leaves_ = true; }
  bool has_axes() const noexcept { return !axes_.empty(); }
  /// Returns true if this output is the target position or a velocity offset of one of the axes.
  bool leads(SignalIndex output) const noexcept;

 private:
  struct Axis {
    MotionAxis signals{};
    std::string node{};
    double scale = 1.0;         ///< scale of the target position
    double offset = 0.0;        ///< offset of the target position
    double speed = 0.0;         ///< velocity of a quick motion, in counts/s
    double acceleration = 0.0;  ///< acceleration of a quick motion, in counts/s^2
    double reach = 0.0;         ///< farthest target, in counts
    bool limited = false;       ///< `limits:` has a velocity and an acceleration
    double position = 0.0;      ///< present target position, in counts
    Time moved{};               ///< time of its newest change
    double pace = 1.0;          ///< part of the quick motion that this process chooses

    /// Returns the present target position in units.
    double place() const noexcept { return position * scale + offset; }
  };
  /// An axis of the bus that may lead another one.
  struct Leader {
    std::string node{};
    std::uint8_t number = 0;  ///< axis of the device, from 0
    std::string position{};   ///< name of its actual position
  };
  /// A stream that begins when its axis has come to rest, and at this time at the latest.
  struct Streaming {
    std::size_t axis = 0;
    Time until{};
  };
  static Axis axis_of(const BusPlan& plan, const MotionAxis& signals);
  std::int64_t target_of(const Axis& axis);
  motion_goal_t goal_of(const Axis& axis);
  motion_command_t motion();
  std::optional<motion_command_t> choose_gear();
  void plan_leading(motion_goal_t& follower, const Axis& axis);
  motion_command_t lead();
  void choose_stream(Time now);
  std::optional<motion_command_t> begin_stream(const Axis& axis, Time now);
  motion_command_t next_points(Time now);
  motion_command_t stop_all() const;
  Time pause();
  void add_goals(motion_command_t& command, bool all);
  double share(double least) { return least + (1 - least) * 1e-6 * random_.below(1'000'001); }

  std::vector<Axis> axes_;
  std::vector<Leader> leaders_;
  unsigned number_;
  sim::Random random_{0};
  Time due_{};         ///< time of the next message
  Time motion_due_{};  ///< time of the next message that is more than a sign of life
  std::int32_t timeout_ms_ = 0;
  std::int32_t id_ = 0;
  bool leaves_ = false;
  bool calm_ = false;   ///< the motions of the program come to rest before the next one
  bool gears_ = false;  ///< some of its motions are gears
  sim::Random gear_random_{0};
  motion_gear_t gear_{};                    ///< leader, phase and ratio of the newest gear
  std::optional<motion_goal_t> leading_{};  ///< next motion: the leader moves for the newest gear
  bool streams_ = false;                    ///< some of its motions are streams
  std::optional<Streaming> streaming_{};
  StreamPath path_{};
  motion_goal_t path_goal_{};
  motion_stream_t stream_{};  ///< newest points of the path
};

}  // namespace takt
