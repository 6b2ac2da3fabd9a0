#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace takt {

/// Determines how far along a trajectory the bus has taken the set-points: each image shows which
/// set-points were sent. While taktd stalls, it sends no set-points, and afterwards it sends only
/// the newest one. During a stall, the motion must not run ahead of the axes.
class TakenSetPoints {
 public:
  /// At the beginning of the trajectory, the axes are at rest at `begin`, in the form in which an
  /// image shows it.
  explicit TakenSetPoints(const Eigen::VectorXd& begin);

  /// Records set-points that were sent. `time` is their time along the trajectory in seconds; a
  /// time that is not later than the last one is ignored. `shown` holds them as an image will show
  /// them.
  void sent(double time, const Eigen::VectorXd& shown);
  /// Takes the set-points that the newest image shows as sent.
  void seen(const Eigen::VectorXd& shown);
  /// Returns the time along the trajectory, in seconds, of the newest set-points that the bus has
  /// taken.
  double time() const noexcept { return time_; }
  /// Returns how far the set-points that the newest image shows are from the nearest ones that were
  /// sent, for each axis. Another program sends to the axes if this is more than the rounding of
  /// the devices.
  const Eigen::VectorXd& apart() const noexcept { return apart_; }

 private:
  struct SetPoint {
    double time = 0.0;
    Eigen::VectorXd shown;
  };
  static constexpr std::size_t most = 16;  // set-points that can be under way

  std::array<SetPoint, most> under_way_;  // oldest first, from the newest taken one on
  std::size_t count_ = 1;
  double time_ = 0.0;
  Eigen::VectorXd apart_;
};

}  // namespace takt
