#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/takt/learn/device_files.hpp"
#include "apps/takt/service/bus_scan.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// A node on the bus and the device file that fits it.
struct ScannedDevice {
  std::uint8_t id = 0;
  ScannedNode node;
  learn::DeviceFiles::Match file;
};

/// Scans a bus of this machine, and listens for at least `listen`. Throws a Failure if the bus
/// can't be opened or no frame can be sent. Ctrl-C ends the scan early.
BusScan scan_bus(const std::string& bus, Time timeout, Time listen);

/// Finds the device file of each node.
std::vector<ScannedDevice> with_files(const BusScan& scan, const learn::DeviceFiles& files);

}  // namespace takt
