#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "apps/takt/learn/device_files.hpp"
#include "apps/takt/learn/learned_bus.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt::learn {

/// Options of learned_network().
struct LearnOptions {
  std::uint32_t bitrate_kbit = 1000;  ///< bit rate, kbit/s; a recording does not show it
  std::filesystem::path folder{};     ///< folder of the network file; paths are relative to it
  std::string stem = "learned";       ///< name of the network file without its ending
  std::vector<DeviceData> device_data{};
};

/// A network file and the device files that were made for it.
struct LearnedNetwork {
  std::string text;
  std::map<std::string, std::string> made_files{};  ///< content by name, beside the network file
  Findings findings{};
};

/// Writes the network file of a recorded bus. A device without a file in `files` gets a file that
/// is made from the recording.
LearnedNetwork learned_network(const LearnedBus& bus, const DeviceFiles& files,
                               const LearnOptions& options);

}  // namespace takt::learn
