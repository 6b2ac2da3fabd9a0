#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <set>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/text_file.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/init/proposed_network.hpp"
#include "apps/takt/learn/yaml_text.hpp"
#include "apps/takt/service/scanned_devices.hpp"
#include "apps/takt/service/sdo_direct.hpp"
#include "apps/takt/service/shared_options.hpp"
#include "eds_parser/network_file/keys/read_devices.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/report/network_report.hpp"
#include "master/linux/can/can_link.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace init {
namespace {

namespace fs = std::filesystem;

struct InitArguments : BusScanOptions {
  std::string out;
  int bitrate_kbit = 0;
  bool force = false;
};

/// Reads a number from a device. Returns 0 if the device does not give it.
std::uint64_t number_of_device(SdoDirect& device, ObjectKey object) {
  try {
    const std::vector<std::byte> bytes = device.upload(object);
    return load_le<std::uint64_t>(std::span{bytes});
  } catch (const Failure& failure) {
    if (failure.code != 1) throw;
    return 0;
  }
}

/// Returns the counts per turn of the shaft behind the gear: encoder increments per motor
/// revolution (0x608F) times motor revolutions per shaft revolution (0x6091). CiA 402-2.
std::optional<double> counts_a_turn(const std::string& bus, const ScannedDevice& found,
                                    Time timeout) {
  const ObjectDictionary* const dictionary = found.file.dictionary.get();
  if (dictionary == nullptr || dictionary->find(ObjectKey{0x608F, 1}) == nullptr) return {};
  SdoDirect device{bus, *NodeId::from(found.id), timeout};
  const auto ratio = [&](std::uint16_t index) {
    const auto above = static_cast<double>(number_of_device(device, {index, 1}));
    const auto below = static_cast<double>(number_of_device(device, {index, 2}));
    return below > 0.0 ? above / below : 0.0;
  };
  const bool gear = dictionary->find(ObjectKey{0x6091, 1}) != nullptr;
  const double counts = ratio(0x608F) * (gear ? ratio(0x6091) : 1.0);
  return counts >= 1.0 ? std::optional{counts} : std::nullopt;
}

/// Returns the path of a device file for the network file: relative to the folder of the network
/// file if possible.
std::string path_from(const fs::path& network, const fs::path& file) {
  const fs::path folder = network.has_parent_path() ? network.parent_path() : fs::path{"."};
  std::error_code error;
  const fs::path near = fs::proximate(file, folder, error);
  return learn::yaml_word((error ? file : near).generic_string());
}

/// Returns the device data of the family of a device, or nullptr.
const DeviceData* family_of(const std::vector<DeviceData>& families, const ScannedDevice& found) {
  if (!found.file.dictionary) return nullptr;
  Findings ignored;
  NetworkReport report{found.file.path.string(), ignored};
  return find_device_data(families, NodeSpec{}, *found.file.dictionary, report);
}

/// Chooses the bit rate: the one that the user has given, else that of the interface, else 1000
/// kbit/s.
void choose_bitrate(const InitArguments& options, InitFacts& facts) {
  if (options.bitrate_kbit != 0) {
    facts.bitrate_kbit = static_cast<std::uint32_t>(options.bitrate_kbit);
    return;
  }
  const auto link = read_can_link(options.bus);
  if (link && link->bitrate && *link->bitrate >= 1000) {
    facts.bitrate_kbit = *link->bitrate / 1000;
    facts.bitrate_source = "the bit rate of " + options.bus;
  } else {
    facts.bitrate_source = "check: the interface reports no bit rate, so takt assumes this one";
  }
}

void report(const ProposedNetwork& network, std::size_t devices, const std::string& file) {
  complain(fmt::format("{}: {} of {} devices, SYNC every {} us; next: takt plan {}", file,
                       devices - network.missing, devices, network.period_us, file),
           0);
  if (network.missing != 0) {
    complain(fmt::format("{} devices have no entry yet; comments in the file say what is missing",
                         network.missing),
             0);
  }
  if (network.too_slow) {
    complain(
        "no period up to 100 ms leaves enough room on the bus: raise the bit rate, or "
        "exchange fewer PDOs (takt budget " +
            file + ")",
        0);
  }
}

/// Removes devices that are only the second SDO channel of another device.
void drop_second_channels(std::vector<DeviceToWrite>& devices) {
  std::set<std::uint8_t> second;
  for (DeviceToWrite& device : devices) {
    for (const DeviceToWrite& other : devices) {
      if (!is_second_channel(device, other)) continue;
      device.second_id = other.found.id;
      second.insert(other.found.id);
    }
  }
  std::erase_if(devices,
                [&](const DeviceToWrite& device) { return second.contains(device.found.id); });
}

std::vector<DeviceToWrite> devices_on(const InitArguments& options, const learn::DeviceFiles& files,
                                      const std::vector<DeviceData>& families) {
  const std::chrono::milliseconds timeout{options.timeout_ms};
  const BusScan scan = scan_bus(options);
  if (Interrupt::asked()) throw Failure{"interrupted; no file was written", 1};
  if (scan.met_another_client()) {
    throw Failure{"another program sends SDO requests on " + options.bus +
                  ": stop taktd before takt init, because answers would be mixed up"};
  }
  std::vector<DeviceToWrite> devices;
  for (ScannedDevice& found : with_files(scan, files)) {
    DeviceToWrite& device = devices.emplace_back();
    device.data = family_of(families, found);
    device.counts_a_turn = counts_a_turn(options.bus, found, timeout);
    if (!found.file.path.empty()) device.file = path_from(options.out, found.file.path);
    device.found = std::move(found);
  }
  drop_second_channels(devices);
  return devices;
}

int run(const InitArguments& options) {
  std::error_code ignored;
  const fs::path out{options.out};
  if (fs::exists(out, ignored) && !options.force) {
    throw Failure{options.out + ": exists already; --force overwrites it", exit_wrong_use};
  }
  if (out.has_parent_path() && !fs::is_directory(out.parent_path(), ignored)) {
    throw Failure{out.parent_path().string() + ": there is no such folder", exit_wrong_use};
  }
  const learn::DeviceFiles files = device_files_in(options.folders);
  Findings findings;
  const std::vector<DeviceData> families = load_device_data(device_folders(), findings);
  const std::vector<DeviceToWrite> devices = devices_on(options, files, families);
  if (devices.empty()) return complain_of_silence(options.bus);
  InitFacts facts{.file = out, .interface = options.bus};
  choose_bitrate(options, facts);
  const ProposedNetwork network = proposed_network(devices, facts);
  value_or_fail(write_whole_file(out, network.text), 1);
  report(network, devices.size(), options.out);
  return judge_written(options.out, load_network(options.out).findings);
}

}  // namespace
}  // namespace init

void add_init(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<init::InitArguments>(
      app, exit_code, "init", "makes a network file from the devices on a bus", init::run);
  add_bus(verb, options.bus, "can0, vcan0, unix:PATH")->required()->type_name("IFACE");
  verb.add_option("--eds-dir", options.folders,
                  "folder with the EDS and DCF files of the devices; takt searches subfolders, too")
      ->required()
      ->type_name("DIR");
  verb.add_option("-o,--output", options.out, "network file to write")
      ->required()
      ->type_name("NET.yaml");
  add_number(verb, "--bitrate", options.bitrate_kbit,
             "bit rate, kbit/s; default: that of the interface")
      ->check(CLI::Range(10, 1000))
      ->type_name("KBIT");
  add_scan_times(verb, options);
  verb.add_flag("--force", options.force, "overwrite the network file if it exists");
  verb.footer(
      "takt init scans the bus as `takt scan` does and changes nothing on it. Stop taktd before.\n"
      "takt init finds the device file of each device by vendor id, product code and revision.\n"
      "The network file contains PDOs that fit the profile of each device, limits with their\n"
      "source, and a SYNC period that leaves room on the bus. Its comments say what to check, and\n"
      "what is missing for devices without a file.\n"
      "Examples:\n  takt init --bus can0 --eds-dir vendor/ -o machine.yaml\n"
      "  takt plan machine.yaml");
}

}  // namespace takt
