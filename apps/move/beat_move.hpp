#pragma once
#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <span>
#include <takt/axis.hpp>
#include <utility>
#include <vector>

#include "apps/move/set_points/motion_limits.hpp"

namespace takt {

/// A move of all axes of a group that taktd runs itself. taktd offers such moves if it answers a
/// sign of life with a motion_t that contains each axis. If taktd runs with `--no-motions`, it
/// answers with an event.
///
/// While the axes move, only this class sends: taktd refuses set-points of a moving axis.
class BeatMove {
 public:
  /// The states of a move.
  enum class Course : std::uint8_t {
    unanswered,  ///< taktd has not accepted the command yet.
    runs,        ///< At least one axis moves or stops.
    done,        ///< All axes are at their targets.
    stopped,     ///< taktd has stopped the move; its events say why.
    refused      ///< taktd has refused the move; its events say why.
  };

  explicit BeatMove(AxisGroup& group);

  /// Sends a sign of life if one is due. After a stop it sends none until a move begins.
  void keep_alive();
  /// Returns true if taktd reports that each axis follows motions.
  bool offered() const;
  /// Begins a move along a straight line, with limits for each axis. A newer move replaces it.
  void begin(const Eigen::VectorXd& to, std::span<const MotionLimits> limits);
  /// Stops the axes along their limits. The caller repeats the call until stands_after_stop(): it
  /// sends once for each image, and every 10 ms without one.
  void stop();
  /// Returns true if stop() has sent messages for enough images, so that no earlier command can
  /// still take effect, and if no axis moves. A move that taktd had not answered does not begin any
  /// more.
  bool stands_after_stop() const;
  /// Returns true if the reports of taktd differ from those of the last call. They differ in each
  /// cycle while an axis moves.
  bool take_news();
  /// Returns the id of the newest move.
  std::int32_t id() const noexcept { return id_; }
  /// Returns the commanded positions that taktd has reported last.
  Eigen::VectorXd positions() const;
  Course course() const;
  bool moving() const;

 private:
  using Clock = std::chrono::steady_clock;
  enum class Phase : std::uint8_t { lives, stops };
  using Report = std::pair<double, double>;  // commanded position and time left of an axis

  motion_command_t command_for(const char* kind) const;
  void send(motion_command_t command);
  template <class Is>
  bool all(Is is) const;

  AxisGroup& group_;
  std::int32_t id_;
  Phase phase_ = Phase::lives;
  Clock::time_point sent_{};
  std::int64_t stop_cycle_ = -1;  // cycle of the image from which the newest stop was sent
  int stopped_images_ = 0;        // number of images from which a stop was sent
  std::vector<Report> reports_;   // reports at the last call of take_news()
};

}  // namespace takt
