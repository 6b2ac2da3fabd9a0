#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/axis_control.hpp>
#include <takt/command_t.hpp>
#include <takt/drive402.hpp>
#include <takt/image_input.hpp>
#include <vector>

#include "apps/drive402/set_point_handshake.hpp"
#include "master/units/units.hpp"

namespace takt {

/// The state and the functions of an AxisControl. Vectors have one element for each axis.
struct AxisControl::State {
  struct Axis {
    AxisSignals signals;
    DriveSequence drive;
    SetPointHandshake handshake;
    std::uint16_t statusword = 0;
    std::uint16_t controlword = 0;
    std::int8_t shown_mode = 0;  // 0x6061 of the image, or its 0x6060 if 0x6061 is not mapped
    bool stale = false;
    bool seeded = false;  // true if the target position has been set from a valid value
    DriveMode commanded_mode = DriveMode::cyclic_position;
    int lagging = 0;              // images in sequence in which the target position lags
    bool sends_position = false;  // controls() sends target positions instead of taktd
    bool halts = false;           // bit 8 of the controlword is set
    bool homes = false;           // bit 4 of the controlword is set in homing mode
  };

  /// Returns the mode in which an axis with these signals fulfils `wanted`.
  static DriveMode mode_for(const AxisSignals& signals, DriveMode wanted) noexcept {
    const bool points = signals.interpolates && wanted == DriveMode::cyclic_position;
    return points ? DriveMode::interpolated_position : wanted;
  }

  Axis& at(Index axis) { return axes[static_cast<std::size_t>(axis)]; }
  Index size() const noexcept { return static_cast<Index>(axes.size()); }

  void set_layout(const ImageInput& input);
  void on_image(const ImageInput& input);
  /// Writes the set-points of all axes to `command`.
  void make_command();
  /// Writes what AxisControl::controls() describes to `command`.
  void make_controls(std::span<const Index> chosen);
  bool in_mode(const Axis& axis) const noexcept;
  Eigen::VectorXd target_positions_in_counts() const;
  void set_positions(const Eigen::Ref<const Eigen::VectorXd>& si);

  double read(AxisSignals::Position signal, const ImageInput& input) const;
  double to_si(std::size_t signal, std::int64_t raw) const;
  void step(Axis& axis, const ImageInput& input);
  bool takes_positions(const Axis& axis) const noexcept;
  void rest(Index axis, const ImageInput& input);
  void put_position(Index axis);
  bool lags(Index axis) const;
  void put(AxisSignals::Position signal, std::int64_t raw);
  void put_si(AxisSignals::Position signal, double si);

  std::vector<Axis> axes;
  Units units;
  DriveMode mode_of_new_axes = DriveMode::cyclic_position;
  Eigen::VectorXd positions;
  Eigen::VectorXd velocities;
  Eigen::VectorXd torques;
  Eigen::VectorXd sent_positions;
  Eigen::VectorXd target_positions;
  Eigen::VectorXd target_velocities;
  Eigen::VectorXd target_torques;
  command_t command{};
};

}  // namespace takt
