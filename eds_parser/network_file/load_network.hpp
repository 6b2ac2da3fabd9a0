#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "eds_parser/report/source.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"
#include "eds_parser/table/run_options.hpp"

namespace takt {

/// A compiled network file with its EDS files. It is usable only if `findings` holds no error.
struct LoadedNetwork {
  BusPlan plan;
  std::vector<DeviceTable> devices;  ///< devices for the simulation; in the order of plan.nodes
  /// Absolute paths of the EDS and DCF files, in the order of plan.nodes; empty if not found.
  std::vector<std::string> device_files;
  RealtimeOptions realtime;
  LcmOptions lcm;
  RecordingOptions recording;
  bool bus_named = false;  ///< the file names the bus or its interface; else plan.name is "sim"
  Findings findings;       ///< findings of the network file and of the device files it names
};

/// States whether the device data apply to the nodes. `ignored` is only meant for a comparison that
/// shows their effect.
enum class DeviceDataUse : std::uint8_t { applied, ignored };

/// Reads, checks and compiles a network file. The result lists all errors at once.
LoadedNetwork load_network(const std::filesystem::path& path,
                           DeviceDataUse device_data = DeviceDataUse::applied);

}  // namespace takt
