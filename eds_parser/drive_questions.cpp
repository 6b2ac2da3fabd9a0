#include "eds_parser/drive_questions.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "eds_parser/object_units.hpp"
#include "eds_parser/profile_of.hpp"

namespace takt {
namespace {

/// Set-points that act in some modes of operation only.
constexpr std::array<std::uint16_t, 3> targets{0x607A, 0x60FF, 0x6071};

bool is_target(ObjectKey object) {
  return std::ranges::find(targets, first_axis(object.index)) != targets.end();
}

/// 0x6060 of the axis that an object belongs to.
ObjectKey mode_of(ObjectKey object) {
  const auto axis = static_cast<std::uint16_t>(object.index - first_axis(object.index));
  return {static_cast<std::uint16_t>(0x6060 + axis), 0};
}

bool is_sent(const NodePdos& node, ObjectKey object) {
  return std::ranges::any_of(node.pdos, [object](const EffectivePdo& pdo) {
    const bool sent = !pdo.is_tpdo && (pdo.use == PdoUse::exchanged || pdo.use == PdoUse::linked);
    return sent &&
           std::ranges::find(pdo.mapping, object, &EffectiveEntry::object) != pdo.mapping.end();
  });
}

/// By `sdo:` or by the values of a DCF.
bool is_written(const NodePdos& node, ObjectKey object) {
  const auto& list = node.node.spec->sdo;
  if (std::ranges::find(list, object, &SdoSpec::object) != list.end()) return true;
  const SubObject* sub = node.node.dictionary->find(object);
  return node.node.dictionary->is_dcf && sub != nullptr && sub->parameter_value.has_value();
}

void ask_for_mode(const NodePdos& node, NetworkReport& report) {
  std::vector<ObjectKey> asked;
  for (const EffectivePdo& pdo : node.pdos) {
    if (pdo.is_tpdo || pdo.use != PdoUse::exchanged) continue;
    for (const EffectiveEntry& entry : pdo.mapping) {
      const ObjectKey mode = mode_of(entry.object);
      const bool open = is_target(entry.object) && node.node.dictionary->find(mode) != nullptr &&
                        !is_sent(node, mode) && !is_written(node, mode);
      if (!open || std::ranges::find(asked, mode) != asked.end()) continue;
      asked.push_back(mode);
      report.warning(entry.pos, "mode",
                     pdo.label() + " of node `" + node.node.spec->name + "` carries " +
                         to_string(entry.object) + ", but nothing sets the mode of operation, " +
                         to_string(mode) + ": the drive may ignore the set-points. Map " +
                         hex(mode.index, 4) + " into an RPDO, or write `sdo: [{index: " +
                         hex(mode.index, 4) + ", value: 8}]` (cyclic synchronous position)");
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
  report.warning(first->pos, "on-loss",
                 "nothing says what the other drives do when one of " + names +
                     " is lost: they would go on. Write `on_loss: quick_stop` for them (the "
                     "drives of its group stop; without `group` all drives), or `on_loss: report` "
                     "where they are to go on");
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
}

}  // namespace takt
