#pragma once
#include <cstdint>

#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/bus/world.hpp"
#include "master/sim/device/device.hpp"

namespace takt::soak {

/// The present state of an axis, read from its simulated drive and not from frames.
struct TrueAxis {
  std::int64_t statusword = 0;
  std::int64_t position = 0;
  std::int64_t velocity = 0;

  /// Returns true if the power stage is on. CiA 402-2, table of states.
  bool powered() const noexcept {
    const std::int64_t state = statusword & 0x6F;
    return state == 0x27 || state == 0x23 || state == 0x07 || (statusword & 0x4F) == 0x0F;
  }
};

/// Reads axis `number` of a device, counted from 0. Its objects lie 0x800 x number higher. A device
/// that is off or missing gives zeros.
inline TrueAxis true_axis(sim::World& world, NodeId node, unsigned number) noexcept {
  const sim::Device* const device = world.device(node);
  if (device == nullptr || device->state() == sim::DeviceState::off) return {};
  const auto read = [&](unsigned index) {
    return device->objects().number({static_cast<std::uint16_t>(index + 0x800U * number), 0});
  };
  return {.statusword = read(0x6041), .position = read(0x6064), .velocity = read(0x606C)};
}

}  // namespace takt::soak
