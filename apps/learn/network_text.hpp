#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "apps/learn/device_files.hpp"
#include "apps/learn/learned_bus.hpp"
#include "eds_parser/device_data.hpp"

namespace takt {

struct LearnOptions {
  std::uint32_t bitrate_kbit = 1000;  ///< a recording does not say it
  std::filesystem::path folder{};     ///< of the network file; device files are named from there
  std::string stem = "learned";       ///< of the network file
  std::vector<DeviceData> device_data{};
};

/// A network file, and the device files that had to be made for it.
struct LearnedNetwork {
  std::string text;
  std::map<std::string, std::string> made_files{};  ///< name -> content, beside the network file
  Findings findings{};
};

/// The network file of a recorded bus. Devices without a file among `files` get one that is made
/// of what the recording shows.
LearnedNetwork learned_network(const LearnedBus& bus, const DeviceFiles& files,
                               const LearnOptions& options);

}  // namespace takt
