#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "eds_parser/source.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"
#include "eds_parser/table/run_options.hpp"

namespace takt {

/// A network file and its EDS files, compiled. Usable only where `findings` holds no error.
struct LoadedNetwork {
  BusPlan plan;
  std::vector<DeviceTable> devices;  ///< one a node, for the simulation; same order as plan.nodes
  RealtimeOptions realtime;
  LcmOptions lcm;
  RecordingOptions recording;
  bool bus_named = false;  ///< the file names the bus or its interface; else plan.name is "sim"
  Findings findings;       ///< of the network file and of the device files it names
};

/// Whether devices get what the device data say of them; `ignored` only to show the difference.
enum class DeviceDataUse : std::uint8_t { applied, ignored };

/// Reads, checks and compiles a network file. All errors are listed at once.
LoadedNetwork load_network(const std::filesystem::path& path,
                           DeviceDataUse device_data = DeviceDataUse::applied);

}  // namespace takt
