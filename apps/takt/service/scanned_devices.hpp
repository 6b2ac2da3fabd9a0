#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/takt/learn/device_files.hpp"
#include "apps/takt/service/bus_scan.hpp"

namespace takt {

/// A node on the bus and the device file that fits it.
struct ScannedDevice {
  std::uint8_t id = 0;
  ScannedNode node;
  learn::DeviceFiles::Match file;
};

/// Options of a command that scans a bus.
struct BusScanOptions {
  std::string bus;
  std::vector<std::string> folders;  ///< folders with device files
  int timeout_ms = 200;              ///< longest silence of a node
  int listen_ms = 1200;              ///< shortest time to listen to heartbeats
};

/// Scans a bus of this machine. Throws a Failure if the bus can't be opened or no frame can be
/// sent. Ctrl-C ends the scan early.
BusScan scan_bus(const BusScanOptions& options);

/// Finds the device files in these folders. Throws a Failure if a folder can't be read.
learn::DeviceFiles device_files_in(const std::vector<std::string>& folders);

/// Finds the device file of each node.
std::vector<ScannedDevice> with_files(const BusScan& scan, const learn::DeviceFiles& files);

/// Says that no device answers on the bus. Returns the exit code.
int complain_of_silence(const std::string& bus);

}  // namespace takt
