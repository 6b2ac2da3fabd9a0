#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/device_data.hpp"

namespace takt {

/// One file of the device data. Errors are appended to `findings`; none: it can't be used.
std::optional<DeviceData> read_device_data(std::string_view text, const std::string& file,
                                           Findings& findings);

/// Where the device data lies: the folders of TAKT_DEVICES (`:` between them), then those that came
/// with takt: beside the program, where it was installed, in its source tree.
std::vector<std::filesystem::path> device_folders();

/// All entries of these folders, in their order, by name within one; of two with one name the
/// first counts.
std::vector<DeviceData> load_device_data(const std::vector<std::filesystem::path>& folders,
                                         Findings& findings);

}  // namespace takt
