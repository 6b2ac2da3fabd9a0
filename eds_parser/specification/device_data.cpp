#include "eds_parser/specification/device_data.hpp"

#include <algorithm>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

constexpr std::string_view no_entry = "none";

std::uint32_t first_known(const Sourced<std::uint32_t>& given, std::uint32_t of_object,
                          std::uint32_t of_info) noexcept {
  if (given.given) return *given;
  return of_object != 0 ? of_object : of_info;
}

bool applies(const ObjectEdit& edit, std::optional<Firmware> firmware) noexcept {
  if (edit.from && (!firmware || *firmware < *edit.from)) return false;
  return !edit.below || (firmware && *firmware < *edit.below);
}

void apply(const ObjectEdit& edit, ObjectDictionary& dictionary) {
  const auto object = std::ranges::find(dictionary.objects, edit.object.index, &Object::index);
  if (object == dictionary.objects.end()) return;
  const auto meant = [&](const SubObject& sub) { return edit.whole || sub.sub == edit.object.sub; };
  if (edit.access) {
    for (SubObject& sub : object->subs) {
      if (meant(sub)) sub.access = *edit.access;
    }
    return;
  }
  std::erase_if(object->subs, meant);
  if (object->subs.empty()) dictionary.objects.erase(object);
}

const DeviceData* by_name(std::span<const DeviceData> entries, const NodeSpec& node,
                          NetworkReport& report) {
  if (*node.device == no_entry) return nullptr;
  const auto found = std::ranges::find(entries, *node.device, &DeviceData::id);
  if (found != entries.end()) return &*found;
  std::vector<std::string_view> known{no_entry};
  for (const DeviceData& entry : entries) known.push_back(entry.id);
  std::string list;
  for (const std::string_view name : known) list += (list.empty() ? "" : ", ") + std::string{name};
  report.error(node.device.pos, "unknown-value", "`device: ", node.device->substr(0, 60),
               "` of node `", node.name, "` is not an entry of the device data; the entries are ",
               list, did_you_mean(*node.device, known));
  return nullptr;
}

}  // namespace

const PdoRule* DeviceData::rule(bool is_tpdo, std::uint16_t number) const noexcept {
  const auto found = std::ranges::find_if(pdos, [&](const PdoRule& rule) {
    return rule.is_tpdo == is_tpdo && rule.numbers.contains(number);
  });
  return found == pdos.end() ? nullptr : &*found;
}

std::string DeviceData::place(SourcePos at) const {
  const std::size_t slash = file.find_last_of('/');
  return file.substr(slash == std::string::npos ? 0 : slash + 1) + ":" + std::to_string(at.line);
}

std::string DeviceData::cite(const DeviceFact& fact) const {
  return (fact.reason.empty() ? "" : ": " + fact.reason) + " (" + place(fact.pos) +
         (manual.empty() ? "" : ", after " + manual) + ")";
}

DeviceIdentity identity_of(const NodeSpec& node, const ObjectDictionary& dictionary) noexcept {
  const DeviceInfo& info = dictionary.device;
  return {.vendor = first_known(node.vendor_id, unsigned32_of(dictionary, {0x1018, 1}),
                                info.vendor_number),
          .product = first_known(node.product_code, unsigned32_of(dictionary, {0x1018, 2}),
                                 info.product_number),
          .revision = first_known(node.revision_number, unsigned32_of(dictionary, {0x1018, 3}),
                                  info.revision_number)};
}

const DeviceData* find_device_data(std::span<const DeviceData> entries, const NodeSpec& node,
                                   const ObjectDictionary& dictionary, NetworkReport& report) {
  if (node.device.given) return by_name(entries, node, report);
  const DeviceIdentity identity = identity_of(node, dictionary);
  if (identity.vendor == 0) return nullptr;
  const auto found = std::ranges::find_if(entries, [&](const DeviceData& entry) {
    return std::ranges::any_of(entry.matches,
                               [&](const DeviceMatch& match) { return match.contains(identity); });
  });
  return found == entries.end() ? nullptr : &*found;
}

std::optional<Firmware> firmware_of(const DeviceData* data, const NodeSpec& node,
                                    const ObjectDictionary& dictionary) noexcept {
  if (node.firmware.given) return *node.firmware;
  if (node.sim.firmware.given) return *node.sim.firmware;
  if (data == nullptr || !data->revision_is_firmware) return {};
  const std::uint32_t revision = identity_of(node, dictionary).revision;
  if (revision == 0) return {};
  return Firmware::of_revision(revision);
}

std::optional<FirmwarePlan> firmware_plan(const DeviceData& data,
                                          std::optional<Firmware> firmware) {
  if (!firmware) return {};
  FirmwarePlan plan{
      .assumed = *firmware,
      .object = data.revision_is_firmware ? ObjectKey{0x1018, 3} : ObjectKey{0x100A, 0}};
  if (data.sync.own_tpdos_from) {
    plan.rules.push_back({.from = data.sync.own_tpdos_from,
                          .below = {},
                          .text = "a SYNC that the device sends triggers its own TPDOs"});
  }
  for (const ObjectEdit& edit : data.objects) {
    if (!edit.from && !edit.below) continue;
    const std::string name = edit.whole ? hex(edit.object.index).substr(2) : to_string(edit.object);
    const std::string what =
        edit.access ? "these objects have a different access: " : "these objects are missing: ";
    const auto same = std::ranges::find_if(plan.rules, [&](const FirmwareRule& rule) {
      return rule.from == edit.from && rule.below == edit.below && rule.text.starts_with(what);
    });
    if (same == plan.rules.end()) {
      plan.rules.push_back({.from = edit.from, .below = edit.below, .text = what + name});
    } else {
      same->text += ", " + name;
    }
  }
  if (plan.rules.empty()) return {};
  return plan;
}

ObjectDictionary with_object_edits(const ObjectDictionary& dictionary, const DeviceData& data,
                                   std::optional<Firmware> firmware) {
  ObjectDictionary edited = dictionary;
  for (const ObjectEdit& edit : data.objects) {
    if (applies(edit, firmware)) apply(edit, edited);
  }
  return edited;
}

}  // namespace takt
