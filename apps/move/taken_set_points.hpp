#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace takt {

/// How far along a trajectory the bus has taken its set-points: the image shows which ones were
/// sent. Those of a daemon that stood still collapse into the newest, and none is sent while it
/// does; the motion shall not run away from the axes meanwhile.
class TakenSetPoints {
 public:
  /// The axes rest at the trajectory's beginning.
  explicit TakenSetPoints(const Eigen::VectorXd& begin);

  /// Set-points of a time along the trajectory, seconds; never an earlier one than before.
  /// `shown`: as an image will show them.
  void sent(double time, const Eigen::VectorXd& shown);
  /// What the newest image shows as sent.
  void seen(const Eigen::VectorXd& shown);
  /// Of the newest set-points that the bus has taken. Seconds along the trajectory.
  double time() const noexcept { return time_; }

 private:
  struct SetPoint {
    double time = 0.0;
    Eigen::VectorXd shown;
  };
  static constexpr std::size_t most = 16;  ///< that can be under way

  std::array<SetPoint, most> under_way_;  ///< oldest first; the first is the newest one taken
  std::size_t count_ = 1;
  double time_ = 0.0;
};

}  // namespace takt
