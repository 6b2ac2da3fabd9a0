#pragma once
#include "master/motion/beat/gear_servo.hpp"
#include "master/motion/beat/gear_task.hpp"
#include "master/motion/beat/leader_estimate.hpp"

namespace takt::motion {

/// The progress of an axis that follows a leader.
enum class GearPhase : std::uint8_t {
  none,         ///< the axis has no gear
  approaching,  ///< the axis has not yet reached the position that the gear prescribes
  locked,       ///< the axis has the position that the gear prescribes, within the lock window
  released,     ///< the axis keeps its velocity until the next motion begins
};

/// The state of the leader in a cycle. For a measured leader, a LeaderSample replaces `state`.
struct LeaderState {
  State state;
  bool is_lost = false;
};

/// Makes an axis follow a leader, step by step. It allocates nothing.
class GearPlayer {
 public:
  /// Number of cycles for which the axis keeps its velocity after a release.
  static constexpr std::uint8_t most_released = 20;

  void begin(const GearTask& task, const Limits& limits) noexcept;
  const GearTask& task() const noexcept { return task_; }
  /// Returns the state of the axis `period` seconds after `from`. `elapsed` is the time since the
  /// last step in s: more than `period` if a SYNC was missing. During this time, a measured leader
  /// has continued its motion, while the axis and a commanded leader have waited.
  State step(const State& from, const LeaderState& leader, const LeaderSample& sample,
             double elapsed, double period) noexcept;
  /// Ends the gear: the axis no longer follows its leader.
  void release() noexcept { phase_ = GearPhase::released; }
  /// Returns the state of a released axis one step after `from`.
  State released(const State& from, double time) const noexcept {
    return servo_.step_to_cruise(from, time);
  }

  GearPhase phase() const noexcept { return phase_; }
  double phase_error() const noexcept { return error_; }  ///< phase error of the last step
  /// Returns true if the leader was lost before the last step.
  bool has_lost_leader() const noexcept { return lost_; }
  /// Returns true if the phase error is above its limit.
  bool is_off() const noexcept;
  /// Returns true if no motion has begun in time after a release.
  bool is_forgotten() const noexcept { return released_ > most_released; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(task_, limits_, estimate_, last_, offset_, error_, phase_, matched_, started_, locked_,
          lost_, released_);
    servo_ = GearServo{limits_};
  }

 private:
  State follow(const State& from, const LeaderState& leader, double time) noexcept;
  void choose_turns(const State& from, const State& leader) noexcept;
  void judge(const State& axis, const State& target, double time) noexcept;

  GearTask task_;
  Limits limits_;
  GearServo servo_;
  LeaderEstimate estimate_;
  State last_;           ///< target of the last step
  double offset_ = 0.0;  ///< prescribed position minus ratio * position of the leader
  double error_ = 0.0;
  GearPhase phase_ = GearPhase::none;
  bool matched_ = false;  ///< the offset is known
  bool started_ = false;  ///< follow() has run since begin()
  bool locked_ = false;   ///< the axis has been locked since begin()
  bool lost_ = false;
  std::uint8_t released_ = 0;  ///< steps since the release
};

}  // namespace takt::motion
