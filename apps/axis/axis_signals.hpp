#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <takt/signal_t.hpp>
#include <vector>

namespace takt {

/// Where in the image the values of one CiA 402 axis are; none where the PDOs do not carry it.
struct AxisSignals {
  using Position = std::optional<std::size_t>;

  std::string name;  ///< of the node; "gantry.2" for the second axis of a device
  std::int16_t node = 0;

  Position statusword;    // 6041
  Position mode_display;  // 6061
  Position position;      // 6064
  Position velocity;      // 606C
  Position torque;        // 6077

  Position controlword;      // 6040
  Position mode;             // 6060
  Position target_position;  // 607A
  Position target_velocity;  // 60FF
  Position target_torque;    // 6071
  Position velocity_offset;  // 60B1
  Position torque_offset;    // 60B2
};

/// The axes of a layout: what has both a controlword and a statusword, by node and axis.
std::vector<AxisSignals> find_axes(std::span<const signal_t> signals);

}  // namespace takt
