#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <takt/signal_t.hpp>
#include <vector>

namespace takt {

/// Places of the values of one CiA 402 axis in the image. The objects are those of the first axis
/// of a device; those of each further axis are 0x800 higher.
struct AxisSignals {
  /// Index of a value in the layout. Empty if no PDO carries the value.
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
  Position target_position;  ///< 0x607A
  Position target_velocity;  ///< 0x60FF
  Position target_torque;    ///< 0x6071
  Position velocity_offset;  ///< 0x60B1
  Position torque_offset;    ///< 0x60B2
};

/// Finds the axes of a layout. An axis has both a controlword and a statusword. The result is
/// sorted by node-ID, then by the number of the axis in its device.
std::vector<AxisSignals> find_axes(std::span<const signal_t> signals);

}  // namespace takt
