#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/live/daemon_client.hpp"
#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Files on the command line that describe a device.
struct DeviceFileOptions {
  std::string network;
  std::string eds;

  bool given() const noexcept { return !network.empty() || !eds.empty(); }
};

/// A signal of a device: an object that one of its PDOs carries.
struct KnownSignal {
  std::string name;
  ObjectKey object;
  DataType type = DataType::unknown;
  bool output = false;  ///< true: an RPDO carries it
  std::string pdo{};    ///< for example "TPDO1"; empty if only the layout of a daemon is known
  double scale = 1.0;
  double offset = 0.0;
  std::string unit{};
};

/// The data of one device from files and from a daemon.
struct KnownDevice {
  std::string name{};          ///< name in the network file; empty if only an EDS is known
  std::optional<NodeId> id{};  ///< empty if only an EDS is known, and nobody gave a node-ID
  std::string file{};          ///< path of the EDS or DCF; empty if the path is not known
  std::optional<ObjectDictionary> dictionary{};  ///< empty if the file can't be read here
  std::vector<KnownSignal> signals{};
};

/// Reads an EDS or DCF. Throws a Failure if it can't be read.
KnownDevice device_of_eds(const std::string& path, std::optional<NodeId> id);
/// Finds a node of a network file by its name or its node-ID. Throws a Failure if the network file
/// has errors or no such node.
KnownDevice device_of_network(const std::string& path, const std::string& node);
/// Reads the files that the user gave. `node` is the name or node-ID of the device.
KnownDevice device_of_files(const DeviceFileOptions& files, const std::string& node);
/// Asks a daemon for the device file and for the signals of one of its nodes. The device file can
/// be read only on the machine of the daemon.
KnownDevice device_of_daemon(DaemonClient& daemon, const LiveOptions& options, std::int16_t id);

}  // namespace takt
