#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/takt/live/screen.hpp"
#include "apps/takt/live/text/node_words.hpp"
#include "apps/takt/live/text/table.hpp"
#include "apps/takt/service/scanned_devices.hpp"
#include "apps/takt/service/shared_options.hpp"

namespace takt {
namespace {

struct ScanOptions : BusScanOptions {
  bool json = false;
};

std::string hex(std::optional<std::uint32_t> value) {
  return value ? fmt::format("0x{:08X}", *value) : "-";
}

std::string state(const ScannedNode& node) {
  return node.state == NmtState::unknown ? "no heartbeat" : nmt_name(static_cast<int>(node.state));
}

std::string profile(const ScannedNode& node) {
  if (!node.device_type) return node.answers ? "-" : "silent";
  const std::uint32_t number = *node.device_type & 0xFFFF;
  return number == 0 ? "no profile" : fmt::format("CiA {}", number);
}

std::string file_text(const ScannedDevice& found) {
  if (found.file.path.empty()) return "no file fits";
  std::string text = found.file.path.string();
  if (found.file.other_revision) text += " (of another revision)";
  if (found.file.rivals != 0) text += fmt::format(" ({} more fit)", found.file.rivals);
  return text;
}

void print(const std::vector<ScannedDevice>& nodes, bool with_files) {
  std::vector<Column> columns{{.title = "NODE", .kind = Cell::number},
                              {.title = "STATE"},
                              {.title = "PROFILE"},
                              {.title = "VENDOR"},
                              {.title = "PRODUCT"},
                              {.title = "REVISION"},
                              {.title = "SERIAL"},
                              {.title = "NAME", .kind = Cell::name, .least = 16}};
  if (with_files) columns.push_back({.title = "FILE", .kind = Cell::name, .least = 32});
  Table table{std::move(columns)};
  for (const ScannedDevice& found : nodes) {
    std::vector<PaintedText> row{
        {std::to_string(found.id)}, {state(found.node)}, {profile(found.node)}};
    for (const auto& number : found.node.identity) row.push_back({hex(number)});
    row.push_back({found.node.name, Paint::title});
    if (with_files) row.push_back({file_text(found), Paint::dim});
    table.add(std::move(row));
  }
  const std::size_t width = output_width();
  print_lines(table.text(width).all(), width);
}

nlohmann::json to_json(const ScannedDevice& found) {
  static constexpr std::array names{"vendor_id", "product_code", "revision_number",
                                    "serial_number"};
  const auto number = [](std::optional<std::uint32_t> value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
  };
  nlohmann::json json{{"node_id", found.id},
                      {"state", nmt_name(static_cast<int>(found.node.state))},
                      {"answers_sdo", found.node.answers},
                      {"device_type", number(found.node.device_type)},
                      {"name", found.node.name},
                      {"eds", nullptr}};
  for (std::size_t i = 0; i < names.size(); ++i) json[names[i]] = number(found.node.identity[i]);
  if (!found.file.path.empty()) {
    json["eds"] = found.file.path.string();
    json["eds_of_another_revision"] = found.file.other_revision;
  }
  return json;
}

int run(const ScanOptions& options) {
  const learn::DeviceFiles files = device_files_in(options.folders);
  const BusScan scan = scan_bus(options);
  if (scan.met_another_client()) {
    complain("another program sends SDO requests on " + options.bus +
                 " (a running taktd?), so answers may be mixed up; `takt status` asks the daemon",
             0);
  }
  const std::vector<ScannedDevice> nodes = with_files(scan, files);
  if (options.json) {
    nlohmann::json all = nlohmann::json::array();
    for (const ScannedDevice& found : nodes) all.push_back(to_json(found));
    const nlohmann::json document{{"bus", options.bus}, {"nodes", std::move(all)}};
    std::puts(json_text(document, 1).c_str());
  } else if (!nodes.empty()) {
    print(nodes, !options.folders.empty());
  }
  if (!nodes.empty()) return 0;
  return complain_of_silence(options.bus);
}

}  // namespace

void add_scan(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<ScanOptions>(
      app, exit_code, "scan", "lists the devices on a bus: node, state, identity, device file",
      run);
  verb.footer(
      "takt scan reads 0x1000, 0x1018 and 0x1008 of all node ids and listens to heartbeats. The\n"
      "command changes nothing.\n"
      "Examples:\n  takt scan --bus can0\n  takt scan --bus can0 --eds-dir vendor/ --json");
  add_bus(verb, options.bus, "can0, vcan0, unix:PATH")->required()->type_name("IFACE");
  verb.add_option("--eds-dir", options.folders,
                  "folder with EDS and DCF files to match with the devices")
      ->type_name("DIR");
  add_scan_times(verb, options);
  verb.add_flag("--json", options.json, "print one JSON document");
}

}  // namespace takt
