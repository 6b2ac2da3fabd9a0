#pragma once
#include <cstdint>

#include "master/motion/beat/gear_task.hpp"
#include "master/motion/profile.hpp"

namespace takt::motion {

/// Estimates the position, velocity and acceleration of a leader from its counter, which may be
/// coarse and noisy and may wrap. The estimate is a motion with a constant jerk in each cycle. It
/// is a filter of fourth order with four equal time constants and one zero. At a constant velocity,
/// it has no delay and no error of position; at an acceleration a, it lags by 6 a filter_time^2.
class LeaderEstimate {
 public:
  /// The shortest filter time, in cycles. A shorter filter time is replaced by this one.
  static constexpr double shortest_filter = 5.0;
  /// A leader is lost after this number of cycles in a row without a new position.
  static constexpr std::uint8_t most_missing = 3;

  /// Starts again with the next sample.
  void begin() noexcept { *this = {}; }
  /// Takes the sample of this cycle, `time` seconds after the last one.
  void take(const LeaderSample& sample, const GearTask& task, double time, double period) noexcept;
  /// Returns true if the velocity is known. Before that, the velocity is measured for one filter
  /// time.
  bool is_ready() const noexcept { return ready_; }
  bool is_lost() const noexcept { return lost_ || missing_ >= most_missing; }
  /// Returns the state `task.lead` seconds after the sample, in the unit of the leader.
  State state(const GearTask& task) const noexcept;
  double jerk() const noexcept { return jerk_; }  ///< jerk of the last cycle

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(origin_, last_, total_, elapsed_, state_, jerk_, slope_, missing_, begun_, ready_, lost_);
  }

 private:
  double counted(std::int64_t counts, const GearTask& task) noexcept;

  double origin_ = 0.0;    ///< position of the first sample
  std::int64_t last_ = 0;  ///< counts of the last sample
  double total_ = 0.0;     ///< counts since the first sample
  double elapsed_ = 0.0;   ///< s since the first sample
  State state_;            ///< state at the last sample, relative to the first one
  double jerk_ = 0.0;
  double slope_ = 0.0;  ///< the sum of the filter
  std::uint8_t missing_ = 0;
  bool begun_ = false;
  bool ready_ = false;
  bool lost_ = false;
};

}  // namespace takt::motion
