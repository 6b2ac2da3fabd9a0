#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/network_file/keys/read_devices.hpp"
#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt::test {

/// Returns the entries of share/devices.
const std::vector<DeviceData>& shipped_device_data();

/// Compiles a network whose nodes all have the device file `eds` of share/eds.
Compiled compile_device_file(const std::string& yaml, const std::string& eds,
                             std::span<const DeviceData> entries = shipped_device_data());

/// Like compile_device_file(), but with the text of a device file and the entries of share/devices.
Compiled compile_with_shipped(const std::string& yaml, const std::string& eds = tiny_eds());

/// Compiles a network with one node of this device; `rest` adds keys to the node.
Compiled drv28(const std::string& rest);
Compiled lenze8400(const std::string& rest);

/// Reads an entry from the text of a test, as the file my_drive.yaml.
std::optional<DeviceData> read_entry(const std::string& text, Findings& findings);
/// Compiles a network of devices of `eds` with an entry that must have no errors.
Compiled compile_with_entry(const std::string& entry, const std::string& yaml,
                            const std::string& eds = tiny_eds(),
                            const std::string& file = "tiny.eds");
/// Returns `line rule` for each finding of an entry that can't be used.
std::vector<std::string> errors_of_entry(const std::string& text);

/// Returns the boot steps of the first node that access an object.
std::vector<BootStep> steps_of(const Compiled& net, ObjectKey key);

}  // namespace takt::test
