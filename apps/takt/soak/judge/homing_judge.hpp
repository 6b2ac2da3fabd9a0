#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <takt/motion_t.hpp>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/motion_axes.hpp"
#include "master/wire/frame.hpp"

namespace takt::soak {

/// Checks the homing of axes by the frames on the wire and by the messages that programs receive:
/// an axis is homed only after a run that its drive has reported as good, and not after its node
/// was lost; and the set-points never jump while the drive follows them, not even at the begin and
/// the end of homing.
class HomingJudge {
 public:
  /// `velocity` is the largest one that programs command, in the unit of each axis per second.
  HomingJudge(const BusPlan& plan, Verdict& verdict, double velocity);

  /// Call this when a new process of the daemon begins, which has seen no homing run.
  void begin_anew(Time now);
  /// Call this with each frame on the wire, at its end.
  void heard(const Frame& frame, Time now);
  /// Call this with each message about motions that programs receive.
  void reported(const motion_t& motions, Time now);
  /// Call this when an absolute motion of an axis, counted as in motion_axes(), has ended well.
  /// `begin` is the time at which the program commanded it.
  void arrived(std::size_t axis, Time begin);

  /// Returns the number of runs that a drive has reported as good.
  std::uint64_t runs() const noexcept { return runs_; }
  /// Returns the number of set-points that were checked at an end of homing mode.
  std::uint64_t changes() const noexcept { return changes_; }

 private:
  struct Axis {
    std::uint64_t statusword = 0;
    std::uint64_t mode = 0;          ///< 6061
    double position = 0.0;           ///< 6064, in counts
    std::optional<double> target{};  ///< newest set-point of this boot, in counts
    Time sent_at{};                  ///< time at which the target was sent
    bool obeys = false;              ///< the drive follows set-points of position
    /// End of the good run since which the axis is homed; empty: not homed.
    std::optional<Time> homed_since{};
    Time unhomed_since{};  ///< time since which the axis is not homed
    Time heard{};          ///< time of the last TPDO
  };

  void take_inputs(std::size_t axis, const Frame& frame, Time now);
  void take_target(std::size_t axis, double counts, Time now);
  void judge_jump(std::size_t axis, double from, double to, unsigned cycles);
  void lose(std::size_t axis, Time now);
  double step_of(std::size_t axis) const noexcept;
  void report_violation(std::size_t axis, const char* invariant, const std::string& what);

  const BusPlan& plan_;
  Verdict& verdict_;
  double velocity_;
  std::vector<MotionAxis> signals_;
  std::vector<Axis> axes_;
  std::uint64_t runs_ = 0;
  std::uint64_t changes_ = 0;
};

}  // namespace takt::soak
