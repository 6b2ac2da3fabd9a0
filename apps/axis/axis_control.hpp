#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <takt/command_t.hpp>
#include <vector>

#include "apps/axis/axis_signals.hpp"
#include "apps/axis/drive_sequence.hpp"
#include "apps/axis/image_input.hpp"
#include "apps/axis/set_point_handshake.hpp"
#include "master/gateway/units.hpp"

namespace takt {

/// Modes of operation, 0x6060. CiA 402-2.
enum class DriveMode : std::int8_t {
  none = 0,
  profile_position = 1,
  profile_velocity = 3,
  profile_torque = 4,
  homing = 6,
  cyclic_position = 8,
  cyclic_velocity = 9,
  cyclic_torque = 10,
};

/// All axes of a bus as vectors in SI units: image in, command out, without LCM and without a
/// clock. Until an axis is in Operation enabled its target follows its position and its target
/// velocity and torque are zero, so that enabling never makes it jump. One that is enabled already
/// keeps the target that the image shows as sent, or its position where none is sent. No axis is
/// enabled before its position has arrived once, as far as it is mapped. In modes without target
/// positions (profile or cyclic velocity and torque, homing) these follow the position too.
class AxisControl {
 public:
  using Index = Eigen::Index;

  /// The layout is new: every axis is found again and shall be disabled.
  void set_layout(const ImageInput& input);
  /// Takes the newest image and steps the state machines. Call once an image.
  void on_image(const ImageInput& input);
  /// Set-points for all axes, computed from the last image. `utime`, `sender` and `time_to_live`
  /// are the caller's.
  command_t& command();

  Index size() const noexcept { return static_cast<Index>(axes_.size()); }
  const AxisSignals& signals(Index axis) const { return axes_[at(axis)].signals; }
  const std::string& name(Index axis) const { return signals(axis).name; }
  const DriveSequence& drive(Index axis) const { return axes_[at(axis)].drive; }
  std::uint16_t statusword(Index axis) const { return axes_[at(axis)].statusword; }
  /// Its statusword or position did not arrive with the newest image.
  bool stale(Index axis) const { return axes_[at(axis)].stale; }
  bool any_stale() const noexcept;
  bool all_enabled() const noexcept;
  bool all_reached() const noexcept;  ///< each axis is where set_goal() sent it

  const Eigen::VectorXd& positions() const noexcept { return positions_; }
  /// Target positions as the image shows them: sent to the drives before its SYNC.
  const Eigen::VectorXd& sent_positions() const noexcept { return sent_positions_; }
  const Eigen::VectorXd& velocities() const noexcept { return velocities_; }
  const Eigen::VectorXd& torques() const noexcept { return torques_; }
  const Eigen::VectorXd& target_positions() const noexcept { return target_positions_; }
  /// Target positions as sent_positions() will show them: in whole counts of the drives.
  Eigen::VectorXd target_positions_in_counts() const;

  void set_goal(DriveGoal goal);
  void set_goal(Index axis, DriveGoal goal) { axes_[at(axis)].drive.set_goal(goal); }
  void reset_faults();
  void set_mode(DriveMode mode) noexcept { mode_ = mode; }
  /// Whether every axis shows the mode (0x6061). Where that is not mapped, whether the mode is
  /// commanded (0x6060 is mapped); an axis with neither is in a mode that nobody knows: false.
  bool in_mode() const noexcept;

  // One value an axis. Axes that are not in Operation enabled keep to their position and rest;
  // those that are not in a position mode, as commanded and as shown, keep to their position.
  // One whose position is not mapped has no target position before set_positions() gave it one,
  // enabled or not. A position that is not finite leaves the target as it is; a velocity or torque
  // that is not finite is 0.
  void set_positions(const Eigen::Ref<const Eigen::VectorXd>& si);
  void set_velocities(const Eigen::Ref<const Eigen::VectorXd>& si);
  void set_torques(const Eigen::Ref<const Eigen::VectorXd>& si);
  /// Profile position: the targets are new; hands them over edge by edge.
  void begin_set_points();
  bool set_points_taken() const noexcept;

 private:
  struct Axis {
    AxisSignals signals;
    DriveSequence drive;
    SetPointHandshake handshake;
    std::uint16_t statusword = 0;
    std::uint16_t controlword = 0;
    std::int8_t shown_mode = 0;  // 0x6061; where it is not mapped, 0x6060 as the image shows it
    bool stale = false;
    bool seeded = false;  // its target position stands for something
  };

  static std::size_t at(Index axis) noexcept { return static_cast<std::size_t>(axis); }
  double read(AxisSignals::Position signal, const ImageInput& input) const;
  double to_si(std::size_t signal, std::int64_t raw) const;
  void step(Axis& axis, const ImageInput& input);
  bool takes_positions(const Axis& axis) const noexcept;
  void rest(Index axis, const ImageInput& input);
  void put(AxisSignals::Position signal, std::int64_t raw);
  void put_si(AxisSignals::Position signal, double si);

  std::vector<Axis> axes_;
  Units units_;
  DriveMode mode_ = DriveMode::cyclic_position;
  Eigen::VectorXd positions_;
  Eigen::VectorXd velocities_;
  Eigen::VectorXd torques_;
  Eigen::VectorXd sent_positions_;
  Eigen::VectorXd target_positions_;
  Eigen::VectorXd target_velocities_;
  Eigen::VectorXd target_torques_;
  command_t command_{};
};

}  // namespace takt
