#pragma once
#include <optional>

#include "apps/takt/soak/judge/motion/path_verdict.hpp"
#include "eds_parser/values/time.hpp"

namespace takt::soak {

/// Compares the target positions of an axis with those of the axis that it follows. Once the axis
/// is locked, its position minus the ratio times that of its leader is constant. The axis has to be
/// locked after the longest time of its phase-in. It is also considered locked if it has moved with
/// a constant difference for some time.
class GearWatch {
 public:
  /// The values that the gear prescribes.
  struct Task {
    double ratio = 1.0;             ///< counts of the axis in a count of the leader
    std::optional<double> phase{};  ///< difference in counts; empty: the difference at the begin
    Time phase_in{};                ///< longest time until the velocities are equal
    /// Velocity in counts/s by which the axis can be faster than its leader.
    double catch_up = 1.0;
  };
  /// Positions of a cycle, in counts.
  struct Positions {
    double leader = 0.0;
    double own = 0.0;
    bool within = false;  ///< the axis can follow the leader within its limits
    bool alone = false;   ///< nothing else can be the cause of a movement of the axis
  };

  /// `begun` is the time at which the gear has begun, unless it was refused.
  GearWatch(const Task& task, Time begun) : task_{task}, since_{begun} {}

  PathVerdict judge(const Positions& at, Time now);
  bool is_locked() const noexcept { return is_locked_ && has_begun_; }

 private:
  /// Smallest and largest values of some cycles.
  struct Span {
    double low = 0.0;  ///< lower bound of the difference
    double high = 0.0;
    double own_low = 0.0;  ///< lower bound of the position
    double own_high = 0.0;
    unsigned cycles = 0;
  };
  Time longest_phase_in(double difference) const;
  bool keeps(double difference) const noexcept;
  void take(double difference, double own, Time now) noexcept;

  Task task_;
  Time since_;                   // time since which the axis can follow its leader
  std::optional<Time> lock_at_;  // time by which the axis is locked
  std::optional<Span> span_;     // time span with a constant difference
  std::optional<double> last_own_;
  bool is_locked_ = false;
  bool has_begun_ = false;  // the gear was seen to move the axis
};

}  // namespace takt::soak
