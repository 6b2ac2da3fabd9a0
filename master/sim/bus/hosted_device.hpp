#pragma once
#include <vector>

#include "master/sim/device/device.hpp"
#include "master/sim/local_clock.hpp"

namespace takt::sim {

/// A device on the bus, with its clock and the state that the world keeps for it.
struct HostedDevice {
  HostedDevice(const DeviceTable& table, Random random, DeviceTimes times)
      : device{table, random, times} {
    ids.reserve(device.most_ids());
  }

  Device device;
  LocalClock clock;
  std::vector<CobId> ids;          ///< identifiers that are routed to the device
  std::vector<Object> overridden;  ///< the original objects
};

}  // namespace takt::sim
