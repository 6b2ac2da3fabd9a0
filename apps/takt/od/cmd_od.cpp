#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <optional>
#include <string>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/help_text.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/takt/od/od_entry.hpp"
#include "apps/takt/od/od_reader.hpp"
#include "apps/takt/od/od_text.hpp"
#include "apps/takt/service/sdo_route.hpp"
#include "apps/takt/service/shared_options.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

struct OdOptions : SdoRouteOptions {
  std::string range;
  std::string search;
  bool defaults = false;
};

void write_out(const std::string& lines) {
  std::fputs(printable_lines(lines).c_str(), stdout);
  std::fflush(stdout);
}

std::string title(const KnownDevice& device, bool live) {
  std::string who = device.id ? fmt::format("node {}", device.id->value()) : std::string{};
  if (!device.name.empty()) who += " " + device.name;
  return fmt::format("{}{}{}: {}\n", who, who.empty() ? "" : ", ", device.file,
                     live ? "values of the device" : "values of the file, no device was asked");
}

/// Prints the entries while it reads them. Returns the exit code.
int show(const KnownDevice& device, std::vector<OdEntry> entries, OdReader* reader, bool json) {
  const Interrupt interrupt;
  OdTable table{device, text_width()};
  if (!json) write_out(title(device, reader != nullptr) + '\n' + table.heading());
  for (OdEntry& entry : entries) {
    if (Interrupt::asked()) return complain("interrupted", 1);
    if (reader != nullptr) reader->read(entry);
    if (!json) write_out(table.row(entry));
  }
  if (json) std::puts(od_json(device, entries, reader != nullptr).c_str());
  if (reader == nullptr || !reader->silent()) return 0;
  return complain("the device stopped answering, so takt did not read the remaining objects", 1);
}

/// Throws a Failure if no device file is at hand.
void demand_dictionary(const KnownDevice& device) {
  if (device.dictionary) return;
  throw Failure{device.file.empty()
                    ? "the daemon does not report the device file of this node: name the file with "
                      "--eds FILE or --network FILE"
                    : "the device file " + device.file +
                          " of this node is on the machine of the daemon; name a copy with --eds "
                          "FILE",
                exit_wrong_use};
}

int browse(const OdOptions& options, const OdChoice& choice) {
  const bool from_file = options.defaults || (options.node.empty() && options.bus.empty());
  if (from_file && !options.device_files.given()) {
    throw Failure{options.defaults
                      ? "--defaults prints a device file: name it with --eds FILE or --network FILE"
                      : "name a node of the running bus, or a device file with --eds FILE",
                  exit_wrong_use};
  }
  if (options.node.empty() && (!from_file || options.device_files.eds.empty())) {
    throw Failure{"name the node whose objects are to be listed, by its name or node id",
                  exit_wrong_use};
  }
  std::optional<SdoRoute> route;
  std::optional<OdReader> reader;
  std::optional<KnownDevice> of_file;
  if (from_file) {
    of_file = device_of_files(options.device_files, options.node);
  } else {
    route.emplace(options);
    reader.emplace([&](ObjectKey key) { return route->upload(key); });
  }
  const KnownDevice& device = of_file ? *of_file : route->device();
  demand_dictionary(device);
  std::vector<OdEntry> entries = od_entries(device, choice);
  if (entries.empty()) {
    return complain(device.file +
                        " has no object that fits; without --search and range, all "
                        "objects are listed",
                    1);
  }
  if (from_file) take_file_values(entries);
  return show(device, std::move(entries), reader ? &*reader : nullptr, options.live.json);
}

/// Returns true for `6041` and `6000..6100`. These words can't be a node, because a node-ID has at
/// most three digits.
bool is_range(const std::string& word) {
  OdChoice unused;
  return word.size() > 3 && word.front() >= '0' && word.front() <= '9' && read_range(word, unused);
}

int run(const OdOptions& given) {
  OdOptions options = given;
  // In `takt od --eds FILE 6000..6100`, the first word is the range, not a node.
  if (options.range.empty() && is_range(options.node)) {
    std::swap(options.node, options.range);
  }
  OdChoice choice{.word = options.search};
  if (!options.range.empty() && !read_range(options.range, choice)) {
    throw Failure{"'" + options.range + "' is not a range of objects like 6000..6100, or an index",
                  exit_wrong_use};
  }
  return browse(options, choice);
}

}  // namespace

void add_od(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<OdOptions>(
      app, exit_code, "od", "lists the objects of a device with their values and meanings", run);
  verb.add_option("NODE,--node", options.node, "node id or name")->type_name("NODE");
  verb.add_option("RANGE", options.range, "only these objects, 6000..6100 or 6041 (hex)");
  verb.add_option("--search", options.search, "only objects with this in their name or index")
      ->type_name("WORD");
  verb.add_flag("--defaults", options.defaults,
                "print the values of the device file, and ask no device");
  add_sdo_route(verb, options, "read the device directly on can0 or unix:PATH, without a daemon");
  verb.footer(
      "takt od writes nothing to the device. It does not read objects that are write-only, files,\n"
      "and objects whose reading has an effect; their value column gives this reason. The column\n"
      "PDO names the PDOs that carry an object (T1: TPDO1, device to master; a dot: a PDO can\n"
      "carry it). Values have the units of the network file. `takt sdo` accepts the same names.\n"
      "Examples:\n  takt od shoulder\n  takt od shoulder --search position\n"
      "  takt od shoulder 6040..6064 --json\n"
      "  takt od --bus can0 --node 5 --eds drive.eds\n"
      "  takt od --eds drive.eds 1000..1018");
}

}  // namespace takt
