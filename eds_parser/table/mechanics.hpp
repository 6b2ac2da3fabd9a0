#pragma once
#include <limits>
#include <optional>

namespace takt {

// The mechanics behind a simulated CiA 402 axis. All values are in SI units. The values of the load
// are referred to the shaft of the motor. The defaults describe a servo motor of 400 W. Positions
// of the axis are in counts in the table of a device, and in the unit of `units: position` in a
// specification.

struct MotorParameters {
  double inertia = 3e-5;        ///< kg m2
  double rated_torque = 1.27;   ///< N m
  double peak_torque = 3.81;    ///< N m
  double max_speed = 628.0;     ///< rad/s; the motor has no torque at this speed
  double breakaway = 1;         ///< dry friction at rest, as a multiple of that in motion
  double friction = 0.02;       ///< N m, dry
  double viscosity = 2e-5;      ///< N m s/rad
  double current_lag = 2.5e-4;  ///< s, time constant of the current controller
};

struct LoadParameters {
  double inertia = 9e-5;              ///< kg m2
  double breakaway = 1;               ///< dry friction at rest, as a multiple of that in motion
  double friction = 0.02;             ///< N m, dry
  double viscosity = 2e-5;            ///< N m s/rad
  double torque = 0;                  ///< N m, constant, for example weight
  std::optional<double> stiffness{};  ///< N m/rad of the coupling; empty: the coupling is rigid
  double damping = 0;                 ///< N m s/rad of the coupling
  double backlash = 0;                ///< rad, from contact to contact
};

struct ControllerParameters {
  double position_gain = 80;         ///< 1/s
  double velocity_bandwidth = 100;   ///< Hz
  double integral_time = 0.008;      ///< s
  double velocity_feed_forward = 0;  ///< fed-forward share of the velocity of the set-points
  double velocity_filter = 2.5e-4;   ///< s, time constant
};

struct EncoderParameters {
  double increments = 131072;  ///< increments in a turn of the motor
  double dead_time = 0;        ///< s, age of the actual values that the drive reports
};

struct BrakeParameters {
  double torque = 0;      ///< N m; 0: the axis has no brake
  double opening = 0.05;  ///< s
  double closing = 0.03;  ///< s
};

/// A range of positions.
struct ZoneParameters {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// The positions at which the axis meets stops, switches and the index pulse. They are positions of
/// the load before homing.
struct TravelParameters {
  std::optional<ZoneParameters> stops{};     ///< hard stops at both ends
  std::optional<ZoneParameters> switches{};  ///< limit switches: active outside
  std::optional<ZoneParameters> home{};      ///< home switch: active inside
  std::optional<ZoneParameters> probe_1{};   ///< inputs of the touch probe: active inside
  std::optional<ZoneParameters> probe_2{};
  std::optional<double> index{};  ///< place of an index pulse; empty: the seed determines it
};

/// `sim: {mechanics: ...}` of a node.
struct MechanicsTable {
  MotorParameters motor{};
  LoadParameters load{};
  ControllerParameters controller{};
  EncoderParameters encoder{};
  BrakeParameters brake{};
  TravelParameters travel{};
  double turn = 0;  ///< travel of the axis per turn of the motor; 0 = unknown (specification only)
};

/// The controllers and the integration of a simulated axis have this period, in seconds.
inline constexpr double mechanics_tick = 2.5e-4;
inline constexpr double mechanics_ticks = 4000;  ///< number of steps in a second
/// Largest number of steps of the integration within this period.
inline constexpr int most_mechanics_steps = 8;

/// Returns the angular frequency (rad/s) at which motor and load swing against each other without
/// damping. Returns 0 if the coupling is rigid.
double stiffest_mode(const MechanicsTable& table) noexcept;
/// Returns the number of equal steps into which the integration divides mechanics_tick. If it
/// exceeds most_mechanics_steps, the coupling is too stiff to be simulated.
int mechanics_steps(const MechanicsTable& table) noexcept;

}  // namespace takt
