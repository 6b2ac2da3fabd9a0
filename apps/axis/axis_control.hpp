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
#include "master/gateway/message/units.hpp"

namespace takt {

/// Modes of operation, the values of objects 0x6060 and 0x6061. CiA 402-2.
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

/// Presents all axes of a bus as Eigen vectors in SI units. The class turns each image into a
/// command; it uses neither LCM nor a clock. All calls come from one thread.
///
/// Until an axis is in Operation enabled, its target position follows its actual position, and its
/// target velocity and target torque are zero, so that enabling never makes the axis jump. An axis
/// that is found enabled keeps the target position that the image shows as sent, or its actual
/// position if none is sent. If the position of an axis is mapped, the axis is not enabled before
/// that position has arrived once. In modes without target positions (profile and cyclic velocity,
/// profile and cyclic torque, homing), the target position follows the actual position too.
///
/// An axis index is in the range 0..size()-1. Each vector has one element for each axis. A value
/// is in the unit that the layout states for its signal (rad, m, rad/s ...), or in raw counts if
/// the layout states no unit. An actual value that no PDO carries is 0.
class AxisControl {
 public:
  using Index = Eigen::Index;

  /// Finds the axes in a new layout. The goal of every axis becomes DriveGoal::disabled again.
  void set_layout(const ImageInput& input);
  /// Takes the values of the newest image and steps the state machine of each axis. The caller
  /// calls this function once for each image.
  void on_image(const ImageInput& input);
  /// Returns the set-points of all axes, computed from the last image. The caller fills in `utime`,
  /// `instance`, `sender`, `time_to_live` and `release`. The next call overwrites the message.
  command_t& command();

  /// Returns the number of axes.
  Index size() const noexcept { return static_cast<Index>(axes_.size()); }
  /// Returns the places of the values of this axis in the image.
  const AxisSignals& signals(Index axis) const { return axes_[at(axis)].signals; }
  /// Returns the name of this axis: the name of its node, or "gantry.2" for the second axis of a
  /// device.
  const std::string& name(Index axis) const { return signals(axis).name; }
  /// Returns the CiA 402 state machine of this axis.
  const DriveSequence& drive(Index axis) const { return axes_[at(axis)].drive; }
  /// Returns the last statusword (0x6041) that arrived from this axis.
  std::uint16_t statusword(Index axis) const { return axes_[at(axis)].statusword; }
  /// Returns true if the statusword or the position of this axis did not arrive with the newest
  /// image.
  bool stale(Index axis) const { return axes_[at(axis)].stale; }
  /// Returns true if stale() is true for at least one axis.
  bool any_stale() const noexcept;
  /// Returns true if all axes are in Operation enabled.
  bool all_enabled() const noexcept;
  /// Returns true if each axis has reached its goal. See DriveSequence::reached().
  bool all_reached() const noexcept;

  /// Returns the actual positions (0x6064).
  const Eigen::VectorXd& positions() const noexcept { return positions_; }
  /// Returns the target positions (0x607A) of the newest image. taktd sent them to the drives
  /// before the SYNC of that image.
  const Eigen::VectorXd& sent_positions() const noexcept { return sent_positions_; }
  /// Returns the actual velocities (0x606C).
  const Eigen::VectorXd& velocities() const noexcept { return velocities_; }
  /// Returns the actual torques (0x6077).
  const Eigen::VectorXd& torques() const noexcept { return torques_; }
  /// Returns the target positions (0x607A) of the next command.
  const Eigen::VectorXd& target_positions() const noexcept { return target_positions_; }
  /// Returns the target positions as sent_positions() will show them, rounded to whole counts of
  /// the drives. The unit is that of target_positions().
  Eigen::VectorXd target_positions_in_counts() const;

  /// Sets the goal of all axes.
  void set_goal(DriveGoal goal);
  /// Sets the goal of one axis.
  void set_goal(Index axis, DriveGoal goal) { axes_[at(axis)].drive.set_goal(goal); }
  /// Asks for one fault reset of each axis that has a fault. See DriveSequence::reset_fault().
  void reset_faults();
  /// Sets the mode of operation of all axes, at first DriveMode::cyclic_position. The commands
  /// carry it for each axis whose 0x6060 is mapped. Another mode than profile position ends the
  /// handshakes of begin_set_points().
  void set_mode(DriveMode mode) noexcept;
  /// Returns true if every axis shows the commanded mode (0x6061). If 0x6061 of an axis is not
  /// mapped, it is enough that the commands carry the mode (0x6060 is mapped). Returns false if
  /// neither object of an axis is mapped, for then its mode is unknown.
  bool in_mode() const noexcept;

  /// Sets the target position (0x607A) of each axis. The call changes only axes that are in
  /// Operation enabled and in a position mode, both as commanded and as the image shows; all
  /// others keep to their actual position. If the actual position of an axis is not mapped, the
  /// axis takes the target whether it is enabled or not, and the commands carry no target position
  /// before. A value that is not finite leaves the target as it is.
  void set_positions(const Eigen::Ref<const Eigen::VectorXd>& si);
  /// Sets the target velocity (0x60FF) of each axis that is in Operation enabled; all others rest.
  /// A value that is not finite counts as 0.
  void set_velocities(const Eigen::Ref<const Eigen::VectorXd>& si);
  /// Sets the target torque (0x6071) of each axis that is in Operation enabled; all others stay at
  /// zero. A value that is not finite counts as 0.
  void set_torques(const Eigen::Ref<const Eigen::VectorXd>& si);
  /// Starts the handshake that hands the new target positions to the drives. It goes on while they
  /// are in Operation enabled. See SetPointHandshake. Does nothing if the mode is not profile
  /// position, because the drives then take target positions without a handshake, or none.
  void begin_set_points();
  /// Returns true if no axis has a handshake left that begin_set_points() started.
  bool set_points_taken() const noexcept;

 private:
  struct Axis {
    AxisSignals signals;
    DriveSequence drive;
    SetPointHandshake handshake;
    std::uint16_t statusword = 0;
    std::uint16_t controlword = 0;
    std::int8_t shown_mode = 0;  // 0x6061 of the image, or its 0x6060 if 0x6061 is not mapped
    bool stale = false;
    bool seeded = false;  // true if the target position has been set from a valid value
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
