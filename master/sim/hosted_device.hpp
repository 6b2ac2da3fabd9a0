#pragma once
#include <vector>

#include "master/sim/device.hpp"
#include "master/sim/local_clock.hpp"

namespace takt::sim {

/// A device in its place on the bus: with its clock and what the world has changed of it.
struct HostedDevice {
  HostedDevice(const DeviceTable& table, Random random, DeviceTimes times)
      : device{table, random, times} {
    ids.reserve(device.most_ids());
  }

  Device device;
  LocalClock clock;
  std::vector<CobId> ids;          ///< identifiers that are routed to it
  std::vector<Object> overridden;  ///< as they were
};

}  // namespace takt::sim
