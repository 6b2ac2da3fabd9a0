#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/network_file/read_devices.hpp"
#include "test/unit/plan/tiny_network.hpp"

namespace takt::test {

/// The entries of share/devices.
const std::vector<DeviceData>& shipped_device_data();

/// A network whose nodes all have the device file `eds` of share/eds.
Compiled compile_device_file(const std::string& yaml, const std::string& eds,
                             std::span<const DeviceData> entries = shipped_device_data());

/// The same with the text of a device file.
Compiled compile_with_shipped(const std::string& yaml, const std::string& eds = tiny_eds());

/// One node each, with `rest` among its keys.
Compiled drv28(const std::string& rest);
Compiled lenze8400(const std::string& rest);

/// An entry that is written down in the test, of the file my_drive.yaml.
std::optional<DeviceData> read_entry(const std::string& text, Findings& findings);
/// What an entry without errors does to a network of devices of `eds`.
Compiled compile_with_entry(const std::string& entry, const std::string& yaml,
                            const std::string& eds = tiny_eds(),
                            const std::string& file = "tiny.eds");
/// `line rule` of each finding of an entry that can't be used.
std::vector<std::string> errors_of_entry(const std::string& text);

/// The boot steps of the first node that deal with an object.
std::vector<BootStep> steps_of(const Compiled& net, ObjectKey key);

}  // namespace takt::test
