#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <takt/motion_command_t.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/motion_axes.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// Chooses the motions that a program commands. It sends a message every 20 ms, which may come
/// 10 ms late; now and then it is silent for 300 ms, seldom for 2 s. Each process has its own
/// limits and timeout. A target in counts has the number of the program in its low four bits.
class MotionCommander {
 public:
  /// `nodes` are those of the program, in the order of BusPlan::nodes.
  MotionCommander(const BusPlan& plan, const std::vector<bool>& nodes, unsigned number);

  /// Begins as a new process.
  void start(sim::Random random);
  /// Returns the next message if it is due. The caller fills in the fields that tell who sends it,
  /// and when.
  std::optional<motion_command_t> next(Time now);
  /// The target position that the drive has at present, in counts.
  void see(SignalIndex target, std::int64_t counts) noexcept;
  /// From now on each message is a stop of all axes.
  void leave() noexcept { leaves_ = true; }
  bool has_axes() const noexcept { return !axes_.empty(); }
  /// Returns true if this output is a target position or a velocity offset of one of the axes.
  bool leads(SignalIndex output) const noexcept;

 private:
  struct Axis {
    MotionAxis signals{};
    std::string node{};
    double scale = 1.0;         ///< of the target position
    double offset = 0.0;        ///< of the target position
    double speed = 0.0;         ///< a quick motion, in counts/s
    double acceleration = 0.0;  ///< of a quick motion, in counts/s^2
    double reach = 0.0;         ///< farthest target, in counts
    bool limited = false;       ///< `limits:` has a velocity and an acceleration
    double position = 0.0;      ///< present target position, in counts
    double pace = 1.0;          ///< part of the quick motion that this process chooses
  };
  static Axis axis_of(const BusPlan& plan, const MotionAxis& signals);
  std::int64_t target_of(const Axis& axis);
  motion_goal_t goal_of(const Axis& axis);
  motion_command_t motion();
  motion_command_t stop_all() const;
  void add_goals(motion_command_t& command, bool all);
  double share(double least) { return least + (1 - least) * 1e-6 * random_.below(1'000'001); }

  std::vector<Axis> axes_;
  unsigned number_;
  sim::Random random_{0};
  Time due_{};         ///< of the next message
  Time motion_due_{};  ///< of the next message that is more than a sign of life
  std::int32_t timeout_ms_ = 0;
  std::int32_t id_ = 0;
  bool leaves_ = false;
  bool calm_ = false;  ///< its motions come to rest before the next one
};

}  // namespace takt
