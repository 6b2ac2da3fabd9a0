#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/network_file/yaml/key_table.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {

/// Reads one file of the device data. Appends errors to `findings`; returns std::nullopt if the
/// file cannot be used.
std::optional<DeviceData> read_device_data(std::string_view text, const std::string& file,
                                           Findings& findings);

KeyRows device_data_rows();

/// Returns the folders of the device data: first those of TAKT_DEVICES (separated by `:`), then
/// those that came with takt: beside the program, in the place of installation, in its source tree.
std::vector<std::filesystem::path> device_folders();

/// Loads all entries of the folders in their order, sorted by name within a folder. If two entries
/// have the same name, the first one counts.
std::vector<DeviceData> load_device_data(const std::vector<std::filesystem::path>& folders,
                                         Findings& findings);

}  // namespace takt
