#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace takt {

/// How well the axes follow: each position against the target that was to be reached by it. What
/// image k shows as sent acts at SYNC k and is reached at SYNC k+1.
class Following {
 public:
  static constexpr std::int64_t cycles_to_reach = 1;

  explicit Following(Eigen::Index axes);

  /// The targets that the image of this cycle shows as sent.
  void sent(std::int64_t cycle, const Eigen::VectorXd& target);
  /// The position in the image of this cycle.
  void seen(std::int64_t cycle, const Eigen::VectorXd& position);

  const Eigen::VectorXd& error() const noexcept { return error_; }      ///< newest
  const Eigen::VectorXd& largest() const noexcept { return largest_; }  ///< absolute
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
