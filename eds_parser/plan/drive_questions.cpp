#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/profile_of.hpp"
#include "eds_parser/plan/device/node_objects.hpp"
#include "eds_parser/plan/network_parts.hpp"
#include "eds_parser/specification/object_units.hpp"

namespace takt {
namespace {

/// A set-point that has an effect only in some modes of operation. `mode` is the one of these modes
/// in which the drive takes a set-point with each SYNC (CiA 402-2, 0x6060).
struct Target {
  std::uint16_t index;
  int mode;
  std::string_view mode_name;
};
constexpr std::array<Target, 4> targets{{{0x607A, 8, "cyclic synchronous position"},
                                         {0x60C1, 7, "interpolated position"},
                                         {0x60FF, 9, "cyclic synchronous velocity"},
                                         {0x6071, 10, "cyclic synchronous torque"}}};

/// Returns nullptr if the object is none of `targets`.
const Target* target_of(ObjectKey object) {
  const auto found = std::ranges::find(targets, first_axis(object.index), &Target::index);
  return found == targets.end() ? nullptr : &*found;
}

/// Returns the object 0x6060 of the axis that an object belongs to.
ObjectKey mode_of(ObjectKey object) {
  const auto axis = static_cast<std::uint16_t>(object.index - first_axis(object.index));
  return {static_cast<std::uint16_t>(0x6060 + axis), 0};
}

bool is_sent(const NodePdos& node, ObjectKey object) {
  return std::ranges::any_of(node.pdos, [object](const EffectivePdo& pdo) {
    return !pdo.is_tpdo && pdo.is_used() && pdo.maps(object);
  });
}

bool is_received(const NodePdos& node, ObjectKey object) {
  return std::ranges::any_of(node.pdos, [object](const EffectivePdo& pdo) {
    return pdo.is_tpdo && pdo.use == PdoUse::exchanged && pdo.maps(object);
  });
}

/// Returns true if the boot or a DCF sets the mode of operation. The value 0 is no mode.
bool is_set(const NodePdos& node, ObjectKey mode) {
  const NodeSpec& spec = *node.node.spec;
  if (*spec.boot && spec.written(mode) != nullptr) return written_object(node.node, mode) != 0;
  const SubObject* sub = node.node.dictionary->find(mode);
  if (!node.node.dictionary->is_dcf || sub == nullptr) return false;
  return integer_of(sub->parameter_value).value_or(0) != 0;
}

std::string lack_of(const NodeSpec& node, ObjectKey mode) {
  const std::string text = "the mode of operation, " + to_string(mode);
  if (node.written(mode) == nullptr) return "nothing sets " + text;
  return *node.boot ? "`sdo` sets " + text + ", to 0, which is no mode"
                    : "nothing sets " + text + " (`boot: false` writes no `sdo`)";
}

/// Returns a text that advises the user how to set the mode. If `sdo` sets it, applications can see
/// the mode only in 0x6061, so the text may also ask for this object in a TPDO.
std::string advice_for(const NodePdos& node, const Target& target, ObjectKey mode) {
  const std::string map = "Map " + hex(mode.index, 4) + " into an RPDO";
  if (!*node.node.spec->boot) return map;
  const ObjectKey display{static_cast<std::uint16_t>(mode.index + 1), 0};
  const bool is_hidden =
      node.node.dictionary->find(display) != nullptr && !is_received(node, display);
  return concat(map, ", or write `sdo: [{index: ", hex(mode.index, 4), ", value: ", target.mode,
                "}]` (", target.mode_name, ")",
                is_hidden ? " and map " + hex(display.index, 4) + " into a TPDO" : "");
}

void ask_for_mode(const NodePdos& node, NetworkReport& report) {
  if (node.node.spec->has_rpdo_errors) return;  // The faulty part of `rpdo` may set the mode.
  std::vector<ObjectKey> asked;
  for (const EffectivePdo& pdo : node.pdos) {
    if (pdo.is_tpdo || pdo.use != PdoUse::exchanged) continue;
    for (const EffectiveEntry& entry : pdo.mapping) {
      const Target* target = target_of(entry.object);
      const ObjectKey mode = mode_of(entry.object);
      const bool open = target != nullptr && node.node.dictionary->find(mode) != nullptr &&
                        !is_sent(node, mode) && !is_set(node, mode);
      if (!open || std::ranges::find(asked, mode) != asked.end()) continue;
      asked.push_back(mode);
      report.warning(entry.pos, "mode", pdo.label(*node.node.spec), " carries ", entry.object,
                     ", but ", lack_of(*node.node.spec, mode),
                     ": the drive may ignore the set-points. ", advice_for(node, *target, mode));
    }
  }
}

void ask_for_loss(std::span<const NodePdos> nodes, NetworkReport& report) {
  const NodeSpec* first = nullptr;
  std::string names;
  std::size_t drives = 0;
  for (const NodePdos& node : nodes) {
    if (!is_cia402(node.node)) continue;
    ++drives;
    if (node.node.spec->on_loss.given) continue;
    if (first == nullptr) first = node.node.spec;
    names += (names.empty() ? "`" : ", `") + node.node.spec->name + "`";
  }
  if (drives < 2 || first == nullptr) return;
  report.warning(
      first->pos, "on-loss", "the file does not say what the other drives do when one of ", names,
      " is lost: they would continue. Write `on_loss: quick_stop` for them (the drives of its "
      "group stop; without `group` all drives), or `on_loss: report` if they should continue");
}

constexpr std::int64_t quick_stop_command = 3;  // value of 0x6007, CiA 402-2

/// Returns the object 0x6007 of each axis of the node that is not configured for a quick stop. NMT
/// stop ends the exchange of PDOs. A drive then makes a quick stop only if its 0x6007 is 3.
std::vector<ObjectKey> axes_without_quick_stop(const NodeSource& node) {
  std::vector<ObjectKey> objects;
  for (unsigned axis = 0; axis < most_axes; ++axis) {
    const ObjectKey option = axis_object(axis, 0x6007);
    if (node.dictionary->find(axis_object(axis, 0x6040)) == nullptr) continue;
    if (configured_object(node, option) != quick_stop_command) objects.push_back(option);
  }
  return objects;
}

bool is_stopped_with(const NodeSpec& node, const NodeSpec& lost) {
  if (&node == &lost) return true;
  return *lost.on_loss == LossReaction::stop_group && lost.group.given && node.group.given &&
         *node.group == *lost.group;
}

/// Returns the `sdo:` entries with which a network file sets these objects to 3, for a message.
std::string written_as_quick_stop(const std::set<std::uint16_t>& objects) {
  std::string entries;
  for (const std::uint16_t index : objects) {
    entries += (entries.empty() ? "" : ", ") + std::string{"{index: "} + hex(index) + ", value: 3}";
  }
  return entries.empty() ? "" : "`sdo: [" + entries + "]`, or ";
}

/// Warns of drives whose reaction to NMT stop is unknown. `on_loss: stop_node` and `stop_group`
/// send NMT stop at once, and the configuration of a moving drive decides what the drive does then.
void ask_for_stopped_drives(const NodeSpec& lost, std::span<const NodePdos> nodes,
                            NetworkReport& report) {
  std::string names;
  std::string missing;
  std::set<std::uint16_t> writable;
  for (const NodePdos& node : nodes) {
    if (!is_cia402(node.node) || !is_stopped_with(*node.node.spec, lost)) continue;
    const std::string name = "`" + node.node.spec->name + "`";
    const std::vector<ObjectKey> axes = axes_without_quick_stop(node.node);
    const auto is_missing = [&](ObjectKey object) {
      return node.node.dictionary->find(object) == nullptr;
    };
    for (const ObjectKey object : axes) {
      if (!is_missing(object)) writable.insert(object.index);
    }
    if (!axes.empty()) names += (names.empty() ? "" : ", ") + name;
    if (std::ranges::any_of(axes, is_missing)) missing += (missing.empty() ? "" : ", ") + name;
  }
  if (names.empty()) return;
  if (!missing.empty()) missing = " (not in the device file of " + missing + ")";
  report.warning(lost.on_loss.pos, "on-loss", "when node `", lost.name,
                 "` is lost, the master sends NMT stop to ", names,
                 " at once, without a quick stop: a moving drive reacts as its 0x6007 says",
                 missing, ", and takt does not know whether this object is 3 (quick stop). Write ",
                 written_as_quick_stop(writable), "`on_loss: quick_stop`");
}

}  // namespace

bool is_cia402(const NodeSource& node) {
  if (node.spec->profile.given) return *node.spec->profile == "cia402";
  return profile_of(*node.dictionary) == 402 && has_drive_words(*node.dictionary);
}

void ask_about_drives(std::span<const NodePdos> nodes, NetworkReport& report) {
  for (const NodePdos& node : nodes) {
    if (is_cia402(node.node)) ask_for_mode(node, report);
  }
  ask_for_loss(nodes, report);
  for (const NodePdos& node : nodes) {
    const LossReaction reaction = *node.node.spec->on_loss;
    if (reaction == LossReaction::stop_node || reaction == LossReaction::stop_group) {
      ask_for_stopped_drives(*node.node.spec, nodes, report);
    }
  }
}

}  // namespace takt
