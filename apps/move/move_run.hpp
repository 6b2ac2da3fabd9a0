#pragma once
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <takt/axis.hpp>
#include <vector>

#include "apps/move/beat_move.hpp"
#include "apps/move/move_options.hpp"
#include "apps/move/move_sizes.hpp"
#include "apps/move/progress.hpp"
#include "apps/move/set_points/following.hpp"
#include "apps/move/set_points/paced_motion.hpp"
#include "apps/move/set_points/synchronised_move.hpp"

namespace takt {

/// One run of takt-move: finds the axes of a bus, enables them, moves them, disables them one after
/// the other and prints a summary.
class MoveRun {
 public:
  /// `stop` becomes 1 with the first signal, which ends the motion, and 2 with the second one,
  /// which ends the wait for axes that do not confirm that they are disabled.
  MoveRun(AxisGroup& group, const MoveOptions& options, const volatile std::sig_atomic_t& stop);

  /// Runs the whole program. Returns the exit code of takt-move.
  int run();

 private:
  using Trajectory = std::function<Eigen::VectorXd(double seconds)>;
  /// The restarts of a move after pauses, and their success.
  struct NewBegins {
    double whole;                  ///< first distance from the target
    double distance_then = whole;  ///< distance at the newest restart
    int count = 0;                 ///< number of all restarts
    int vain = 0;  ///< number of restarts in sequence that came no nearer to the target

    void next(double distance);
  };

  bool hear_bus();
  bool fits();
  void begin();
  bool devices_answer();
  bool fits_time();
  bool enable();
  std::vector<MotionLimits> limits() const;
  std::optional<SynchronisedMove> planned_move(const Eigen::VectorXd& from);
  bool move();
  bool swing(double seconds);
  bool knows_beat();
  bool watch_beat(const Eigen::VectorXd& to);
  void wait_before_begin();
  std::string watch_course();
  std::string objection(BeatMove::Course course, const NewBegins& begins,
                        const Eigen::VectorXd& to);
  std::string silence(double seconds) const;
  double beat_end() const;
  double bus_seconds(Input newest = Input::nothing) const;
  double cycle_seconds() const;
  bool follow(const char* what, double duration, const Trajectory& trajectory);
  Hold take_input(Input input);
  void compare(const char* what);
  double period() const;
  double longest_step() const;
  double real_step();
  bool sent_own(const PacedMotion& motion);
  bool axes_lost();
  bool axes_taken(int sequence);
  bool is_over(AxisControl::Index axis) const;
  bool not_taken();
  void disable();
  /// Takes images and sends commands until `done` is true, and then returns true. Returns false
  /// after `seconds`, after `stops` signals, or if taktd has restarted.
  bool hold_until(const std::function<bool()>& done, double seconds, int stops = 1);
  std::string verdict() const;
  std::string too_far() const;
  int sum_up() const;
  Eigen::VectorXd target(Eigen::VectorXd from) const;

  AxisGroup& group_;
  AxisControl& axes_;
  const MoveOptions& options_;
  const volatile std::sig_atomic_t& stop_;
  BeatMove beat_;
  Progress progress_;
  Following following_{0};
  std::vector<MoveSizes> sizes_;    // one for each axis
  std::vector<std::string> units_;  // one for each axis
  bool good_ = true;
  bool commanding_ = false;  // false while takt-move only listens until the devices answer
  bool restarted_ = false;
  std::optional<double> beat_begin_;  // time in bus_seconds() at which taktd has begun the move
  Hold holding_ = Hold::no;
  int stale_images_ = 0;
  int holds_ = 0;
  std::int64_t last_cycle_ = 0;
};

}  // namespace takt
