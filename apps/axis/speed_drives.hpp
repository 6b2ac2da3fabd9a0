#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <string>
#include <takt/axis.hpp>
#include <takt/command_t.hpp>
#include <utility>
#include <vector>

#include "apps/axis/speed_axis.hpp"

namespace takt {

/// The speed axes that an Axes commands, in its order. It computes the values of one command_t from
/// each image; the owner of this object sends them. taktd lets the drives stop when no command
/// comes.
class SpeedDrives {
 public:
  using Index = Eigen::Index;

  explicit SpeedDrives(std::vector<SpeedAxis> axes) : axes_{std::move(axes)} {}

  Index size() const noexcept { return static_cast<Index>(axes_.size()); }
  SpeedAxis& at(Index axis) { return axes_[static_cast<std::size_t>(axis)]; }
  const SpeedAxis& at(Index axis) const { return axes_[static_cast<std::size_t>(axis)]; }

  void set_goal(SpeedGoal goal);
  /// The axes stop: their set speeds go to 0 with the acceleration of the newest run.
  void stop();
  void run(const Eigen::Ref<const Eigen::VectorXd>& speeds, const Eigen::VectorXd& accelerations);
  /// Ends the run of the axes that run: their set speeds are 0 at once.
  void end_run();
  /// Takes the status words of the newest image.
  void read(const ImageInput& input);
  /// Computes the commands, once for each image, after read().
  void step(const ImageInput& input);
  /// Returns the command of all axes.
  command_t command() const;

  bool all_ready() const;
  bool all_stand() const;
  bool all_run() const;
  bool any_in_fault() const;
  bool any_wants_to_run() const;
  template <class Is>
  bool any(const Is& is) const {
    return std::ranges::any_of(axes_, is);
  }
  /// Returns true if at least one axis is to run, or is not at standstill.
  bool moving() const;
  /// Returns true if this is the node-ID of an axis.
  bool has_node(std::int16_t node) const;
  /// Returns sentences on what blocks the axes.
  std::string why_not_ready(const AxisGroup& group) const;

 private:
  std::vector<SpeedAxis> axes_;
  std::vector<double> accelerations_;  // accelerations of the newest run
};

}  // namespace takt
