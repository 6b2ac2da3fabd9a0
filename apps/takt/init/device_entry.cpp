#include "apps/takt/init/device_entry.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numbers>

#include "apps/takt/init/proposed_pdos.hpp"
#include "eds_parser/dictionary/profile_of.hpp"

namespace takt::init {
namespace {

constexpr std::size_t comment_column = 40;

std::string hex32(std::optional<std::uint32_t> value) {
  return value ? fmt::format("0x{:08X}", *value) : "unknown";
}

/// Returns a line with a comment, which begins in the same column in all lines.
std::string commented(std::string line, const std::string& comment) {
  if (line.size() < comment_column) line.append(comment_column - line.size(), ' ');
  return line + "  # " + comment + '\n';
}

/// Returns a text of a device without control characters, so that it fits in one line of a comment.
std::string plain(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\x7F'; }, ' ');
  return text;
}

std::string identity_text(const DeviceToWrite& device) {
  const ScannedNode& node = device.found.node;
  return fmt::format("node {}: {}{}vendor {}, product {}, revision {}, serial {}", device.found.id,
                     plain(node.name), node.name.empty() ? "" : ", ", hex32(node.identity[0]),
                     hex32(node.identity[1]), hex32(node.identity[2]), hex32(node.identity[3]));
}

bool is_inverter(const DeviceToWrite& device) {
  return device.data != nullptr && device.data->speed_axis.is_stated();
}

/// Returns the units of an axis. They are in rad if the number of counts per turn is known, else in
/// counts.
std::string units_text(const DeviceToWrite& device) {
  const bool turns = device.counts_a_turn.has_value();
  const double scale = turns ? 2.0 * std::numbers::pi / *device.counts_a_turn : 1.0;
  const std::string unit = turns ? "rad" : "counts";
  const auto line = [&](const char* quantity, const char* per) {
    return fmt::format("      {}: {{scale: {}, unit: {}{}}}", quantity, scale, unit, per);
  };
  std::string text = commented(
      "    units:",
      turns ? fmt::format("{} counts a turn of the shaft: 608F and 6091, read from the device",
                          *device.counts_a_turn)
            : "608F and 6091 of the device do not give the counts of a turn: enter the scale");
  text += line("position", "") + '\n';
  text += commented(line("velocity", "/s"), "check: some drives count rpm");
  text += commented(line("acceleration", "/s^2"), "check");
  return text;
}

/// Returns the reason for a limit. An object is the reason if the device file gives it a value.
std::string source_of(const ProposedLimit& limit) {
  const bool object =
      !limit.because.empty() && limit.because.front() >= '0' && limit.because.front() <= '9';
  return limit.because + (object ? " of the device file" : "");
}

/// Returns the entry in `objects: [{index: 0x6411}]`, or an empty text for other limits.
std::string object_of(const ProposedLimit& limit) {
  constexpr std::string_view before = "objects: [";
  if (!limit.entry.starts_with(before)) return {};
  return limit.entry.substr(before.size(), limit.entry.size() - before.size() - 1);
}

/// Returns `limits:`, with the source of each limit. Limits without numbers become comments.
std::string limits_text(const std::vector<ProposedLimit>& limits) {
  if (limits.empty()) return {};
  const bool any = std::ranges::any_of(limits, &ProposedLimit::has_numbers);
  std::string text = commented(any ? "    limits:" : "    # limits:",
                               "takt does not send a command outside these limits");
  for (const ProposedLimit& limit : limits) {
    if (!object_of(limit).empty()) continue;
    const std::string line = (limit.has_numbers() ? "      " : "      # ") + limit.entry;
    text += commented(line, source_of(limit));
  }
  const auto is_object = [](const ProposedLimit& limit) { return !object_of(limit).empty(); };
  if (std::ranges::none_of(limits, is_object)) return text;
  const bool active = std::ranges::any_of(
      limits, [&](const ProposedLimit& limit) { return is_object(limit) && limit.has_numbers(); });
  text += commented(active ? "      objects:" : "      # objects:",
                    "replace ... by numbers; objects that are bit fields need no limits");
  for (const ProposedLimit& limit : limits) {
    if (!is_object(limit)) continue;
    const std::string line =
        (limit.has_numbers() ? "        - " : "        # - ") + object_of(limit);
    text += limit.has_numbers() ? commented(line, source_of(limit)) : line + '\n';
  }
  return text;
}

/// Returns the notes about the device file, as comments for the user.
std::string file_notes(const DeviceToWrite& device) {
  std::string text;
  if (device.found.file.other_revision) {
    text += "  # The device file is of another revision: ask the manufacturer whether it fits.\n";
  }
  if (device.found.file.rivals != 0) {
    text += fmt::format("  # {} other device files fit as well.\n", device.found.file.rivals);
  }
  if (device.second_id != 0) {
    text += fmt::format("  # It answers as node {}, too: that is its second SDO channel.\n",
                        device.second_id);
  }
  if (device.data != nullptr) {
    text += fmt::format("  # Device family: {}; the rules of {}.yaml apply.\n", device.data->name,
                        device.data->id);
  }
  return text;
}

}  // namespace

bool is_second_channel(const DeviceToWrite& device, const DeviceToWrite& other) {
  if (device.data == nullptr || device.found.node.identity != other.found.node.identity) {
    return false;
  }
  return std::ranges::any_of(device.data->sdo_servers, [&](const SdoServerFact& server) {
    return server.request + device.found.id == 0x600 + other.found.id &&
           server.answer + device.found.id == 0x580 + other.found.id;
  });
}

std::string node_name(const DeviceToWrite& device) {
  const ObjectDictionary* const dictionary = device.found.file.dictionary.get();
  std::string kind = "node";
  if (is_inverter(device)) {
    kind = "inverter";
  } else if (dictionary != nullptr) {
    const std::int64_t profile = profile_of(*dictionary);
    if (profile == 401) kind = "io";
    if (profile == 402) kind = "axis";
    if (profile == 406) kind = "encoder";
  }
  return fmt::format("{}_{}", kind, device.found.id);
}

std::string device_entry(const DeviceToWrite& device, Detail detail,
                         const std::vector<ProposedLimit>& limits) {
  const ObjectDictionary& dictionary = *device.found.file.dictionary;
  const bool drive = profile_of(dictionary) == 402 && has_drive_words(dictionary);
  std::string text = "  # " + identity_text(device) + '\n' + file_notes(device);
  text += fmt::format("  {}:\n    node_id: {}\n    dcf: {}\n", node_name(device), device.found.id,
                      device.file);
  if (detail == Detail::file_only) {
    return text + "    # PDOs and heartbeat are those of the device file.\n" + limits_text(limits);
  }
  const SubObject* const heartbeat = dictionary.find(ObjectKey{0x1017, 0});
  if (heartbeat != nullptr && heartbeat->is_configurable()) {
    text += commented("    heartbeat_producer: 100", "ms");
  } else {
    text +=
        "    # The device file has no 0x1017, so no heartbeat shows that the device is lost.\n"
        "    # If the device has 0x100C, set `guard_time`: the master then guards the device.\n";
  }
  const ProposedPdos pdos = detail == Detail::whole ? proposed_pdos(dictionary, device.data)
                                                    : pdos_of_file(dictionary, device.data);
  if (drive) {
    text += "    profile: cia402\n";
    text += commented("    on_loss: quick_stop", "if this drive is lost, the others stop, too");
    if (pdos.commands_position) text += units_text(device);
    text += commented("    on_timeout: {fallback: quick_stop, after: 200}",
                      "ms without a command of the application");
  }
  std::vector<ProposedLimit> all = limits;
  if (is_inverter(device) && device.data->speed_axis.set_speed) {
    all.insert(all.begin(), {"velocity: ...", device.data->speed_axis.set_speed->unit +
                                                  ": enter the highest set speed of the machine"});
  }
  text += limits_text(all);
  return text + pdos.text;
}

std::string missing_entry(const DeviceToWrite& device, const std::string& reason) {
  std::string text = "  # " + identity_text(device) + '\n';
  text += "  # " + reason + '\n';
  return text + fmt::format("  # {}: {{node_id: {}, dcf: FILE.eds}}\n", node_name(device),
                            device.found.id);
}

}  // namespace takt::init
