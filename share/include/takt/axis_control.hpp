#pragma once
/// @file
/// All CiA 402 axes of a bus as Eigen vectors in SI units.
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <takt/command_t.hpp>
#include <takt/drive402.hpp>
#include <takt/image_input.hpp>

namespace takt {

/// Places of the values of one CiA 402 axis in the image. The objects are those of the first axis
/// of a device; those of each further axis are 0x800 higher.
struct AxisSignals {
  /// Index of a value in ImageInput::signals(). Empty if no PDO carries the value.
  using Position = std::optional<std::size_t>;

  std::string name;       ///< name of the node, or "gantry.2" for the second axis of a device
  std::int16_t node = 0;  ///< node-ID, 1..127

  Position statusword;    ///< 0x6041
  Position mode_display;  ///< 0x6061, modes of operation display
  Position position;      ///< 0x6064, position actual value
  Position velocity;      ///< 0x606C, velocity actual value
  Position torque;        ///< 0x6077, torque actual value

  Position controlword;      ///< 0x6040
  Position mode;             ///< 0x6060, modes of operation
  Position target_position;  ///< 0x607A, or 0x60C1:01 if `interpolates` is true
  Position target_velocity;  ///< 0x60FF
  Position target_torque;    ///< 0x6071
  Position velocity_offset;  ///< 0x60B1
  Position torque_offset;    ///< 0x60B2

  /// True if 0x60C1:01 is mapped and 0x607A is not: the axis follows positions in interpolated
  /// position mode (ip).
  bool interpolates = false;
};

/// Presents all axes of a bus as Eigen vectors in SI units. The class turns each image into a
/// command; it uses neither LCM nor a clock. All calls come from one thread.
///
/// Until an axis is in Operation enabled, its target position follows its actual position, and its
/// target velocity and target torque are zero, so that enabling never makes the axis jump. If an
/// axis is already enabled in the first image, it keeps the target position that the image shows as
/// sent, or its actual position if no target position was sent. If the position of an axis is
/// mapped, the axis is not enabled before that position has arrived once. In modes without target
/// positions (profile and cyclic velocity, profile and cyclic torque, homing), the target position
/// follows the actual position too.
///
/// An axis index is in the range 0..size()-1. Each vector has one element for each axis. A value
/// is in the unit that the layout states for its signal (rad, m, rad/s ...), or in raw counts if
/// the layout states no unit. An actual value that no PDO carries is 0.
///
/// AxisGroup owns an AxisControl and calls set_layout(), on_image() and command().
class AxisControl {
 public:
  /// Index of an axis, 0..size()-1.
  using Index = Eigen::Index;

  /// Has no axes until the first set_layout().
  AxisControl();
  ~AxisControl();
  /// Moves the axes; `other` may then only be destroyed or assigned to.
  AxisControl(AxisControl&& other) noexcept;
  /// Moves the axes; `other` may then only be destroyed or assigned to.
  AxisControl& operator=(AxisControl&& other) noexcept;

  /// Finds the axes in a new layout. The goal of every axis becomes DriveGoal::disabled again.
  void set_layout(const ImageInput& input);
  /// Takes the values of the newest image and steps the state machine of each axis. The caller
  /// calls this function once for each image.
  void on_image(const ImageInput& input);
  /// Returns the set-points of all axes, computed from the last image. The caller fills in `utime`,
  /// `instance`, `sender`, `time_to_live` and `release`. The next call overwrites the message.
  command_t& command();
  /// Returns the controlwords, modes, target velocities and target torques of these axes, for axes
  /// whose motions taktd runs. For an axis in profile position mode, the message also has a target
  /// position: the new target until the drive has taken it, otherwise the actual position. If an
  /// axis is not enabled and its target position stays far from its actual one, the message also
  /// has the actual position as the target. Therefore no mode begins with a jump. The caller fills
  /// in the same fields as for command(). The next call of this function or of command() overwrites
  /// the message.
  command_t& controls(std::span<const Index> axes);

  /// Returns the number of axes.
  Index size() const noexcept;
  /// Returns the places of the values of this axis in the image.
  const AxisSignals& signals(Index axis) const;
  /// Returns the name of this axis: the name of its node, or "gantry.2" for the second axis of a
  /// device.
  const std::string& name(Index axis) const { return signals(axis).name; }
  /// Returns the CiA 402 state machine of this axis.
  const DriveSequence& drive(Index axis) const;
  /// Returns the last statusword (0x6041) that arrived from this axis.
  std::uint16_t statusword(Index axis) const;
  /// Returns true if the statusword or the position of this axis did not arrive with the newest
  /// image.
  bool stale(Index axis) const;
  /// Returns true if stale() is true for at least one axis.
  bool any_stale() const noexcept;
  /// Returns true if all axes are in Operation enabled.
  bool all_enabled() const noexcept;
  /// Returns true if each axis has reached its goal. See DriveSequence::reached().
  bool all_reached() const noexcept;

  /// Returns the actual positions (0x6064).
  const Eigen::VectorXd& positions() const noexcept;
  /// Returns the target positions (0x607A) of the newest image. taktd sent them to the drives
  /// before the SYNC of that image.
  const Eigen::VectorXd& sent_positions() const noexcept;
  /// Returns the actual velocities (0x606C).
  const Eigen::VectorXd& velocities() const noexcept;
  /// Returns the actual torques (0x6077).
  const Eigen::VectorXd& torques() const noexcept;
  /// Returns the target positions (0x607A) of the next command.
  const Eigen::VectorXd& target_positions() const noexcept;
  /// Returns the target positions as sent_positions() will show them, rounded to whole counts of
  /// the drives. The unit is that of target_positions().
  Eigen::VectorXd target_positions_in_counts() const;

  /// Sets the goal of all axes.
  void set_goal(DriveGoal goal);
  /// Sets the goal of one axis.
  void set_goal(Index axis, DriveGoal goal);
  /// Asks for one fault reset of each axis that has a fault. See DriveSequence::reset_fault().
  void reset_faults();
  /// Asks for one fault reset of one axis if it has a fault.
  void reset_fault(Index axis);
  /// Sets the mode of operation of all axes. Before the first call, the mode is
  /// DriveMode::cyclic_position. The commands carry the mode for each axis whose 0x6060 is mapped.
  /// Another mode than profile position ends the handshakes of begin_set_points(). An axis with
  /// AxisSignals::interpolates gets DriveMode::interpolated_position instead of
  /// DriveMode::cyclic_position.
  void set_mode(DriveMode mode) noexcept;
  /// Sets the mode of operation of one axis. If the mode differs from the one before, the call also
  /// sets the target velocity and the target torque of the axis to 0.
  void set_mode(Index axis, DriveMode mode) noexcept;
  /// Returns the mode of operation that was set for this axis.
  DriveMode mode(Index axis) const;
  /// Sets bit 4 of the controlword of an axis that is in Operation enabled and whose commanded mode
  /// is DriveMode::homing; for other axes the call has no effect. The bit stays set until
  /// end_homing(), until another mode is set, or until the drive leaves Operation enabled. CiA
  /// 402-2, homing operation start.
  void start_homing(Index axis);
  /// Clears bit 4 of the controlword, which start_homing() sets. This ends a homing run that has
  /// not ended.
  void end_homing(Index axis);
  /// Sets bit 8 (Halt) of the controlword of this axis while its drive is in Operation enabled,
  /// until end_halt(). CiA 402-2, controlword.
  void halt(Index axis);
  /// Clears bit 8 (Halt) of the controlword of this axis.
  void end_halt(Index axis);
  /// Returns true if every axis shows the commanded mode (0x6061). If 0x6061 of an axis is not
  /// mapped, it is enough that the commands carry the mode (0x6060 is mapped). Returns false if
  /// neither object of an axis is mapped, because the mode of this axis is then unknown.
  bool in_mode() const noexcept;
  /// Returns true if this axis shows the commanded mode. See in_mode().
  bool in_mode(Index axis) const;

  /// Sets the target position (0x607A) of each axis. The call changes only axes that are in
  /// Operation enabled and in a position mode, both as commanded and as the image shows; all others
  /// keep to their actual position. If the actual position of an axis is not mapped, the axis takes
  /// the target whether it is enabled or not, and the commands carry no target position before the
  /// first call. A value that is not finite leaves the target as it is.
  void set_positions(const Eigen::Ref<const Eigen::VectorXd>& si);
  /// Sets the target velocity (0x60FF) of each axis that is in Operation enabled; for all others it
  /// stays at zero. A value that is not finite counts as 0.
  void set_velocities(const Eigen::Ref<const Eigen::VectorXd>& si);
  /// Sets the target torque (0x6071) of each axis that is in Operation enabled; for all others it
  /// stays at zero. A value that is not finite counts as 0.
  void set_torques(const Eigen::Ref<const Eigen::VectorXd>& si);
  /// Starts the handshake that hands the new target positions to the drives: bit 4 of the
  /// controlword rises and stays high until bit 12 of the statusword acknowledges it. CiA 402-2,
  /// new set-point. If a handshake is running, another one follows it. The handshakes go on while
  /// the drives are in Operation enabled. The call does nothing if the mode is not profile
  /// position, because in other modes the drives take target positions without a handshake, or take
  /// none.
  void begin_set_points();
  /// Starts the handshake of begin_set_points() for one axis.
  void begin_set_point(Index axis, SetPointTiming timing);
  /// Returns true if the drive of this axis has taken each set-point that begin_set_point() or
  /// begin_set_points() has announced: bit 12 of the statusword has answered bit 4.
  bool set_point_taken(Index axis) const;
  /// Returns true if each handshake that begin_set_points() has started is over.
  bool set_points_taken() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace takt
