#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace takt {

/// Measures how well the axes follow: compares each actual position with the target position that
/// the axis had to reach at that time. A target that image k shows as sent acts at SYNC k and is
/// reached at SYNC k+1.
class Following {
 public:
  static constexpr std::int64_t cycles_to_reach = 1;

  explicit Following(Eigen::Index axes);

  /// Records the target positions that the image of this cycle shows as sent.
  void sent(std::int64_t cycle, const Eigen::VectorXd& target);
  /// Compares the actual positions in the image of this cycle.
  void seen(std::int64_t cycle, const Eigen::VectorXd& position);

  /// Returns the newest following error of each axis, with its sign.
  const Eigen::VectorXd& error() const noexcept { return error_; }
  /// Returns the largest absolute following error of each axis.
  const Eigen::VectorXd& largest() const noexcept { return largest_; }
  /// Returns the number of images that were compared.
  std::int64_t samples() const noexcept { return samples_; }

 private:
  struct Target {
    std::int64_t cycle = -1;
    Eigen::VectorXd position;
  };
  std::array<Target, 8> targets_;
  Eigen::VectorXd error_;
  Eigen::VectorXd largest_;
  std::int64_t samples_ = 0;
};

}  // namespace takt
