#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/takt/init/device_entry.hpp"

namespace takt::init {

/// Facts for the head of a network file.
struct InitFacts {
  std::filesystem::path file;         ///< network file that is to be written
  std::string interface;              ///< can0, or unix:PATH
  std::uint32_t bitrate_kbit = 1000;  ///< bit rate, kbit/s
  std::string bitrate_source{};       ///< source of the bit rate, for a comment
};

struct ProposedNetwork {
  std::string text{};
  std::uint32_t period_us = 0;  ///< proposed period of SYNC, us
  std::size_t missing = 0;      ///< number of devices without an entry
  bool too_slow = false;        ///< true if not even this period suits the bus
};

/// Proposes a network file for the devices. Each entry is read as taktd would read it. An entry
/// that causes an error is replaced by one with less content. The period of SYNC is the shortest of
/// a list with which all frames fit on the bus and process data fill at most 60 % of it. Each trial
/// is written to a file in the same folder, because the paths in it are relative, and the file is
/// then removed.
ProposedNetwork proposed_network(const std::vector<DeviceToWrite>& devices, const InitFacts& facts);

}  // namespace takt::init
