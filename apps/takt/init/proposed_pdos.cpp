#include "apps/takt/init/proposed_pdos.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <optional>
#include <utility>
#include <vector>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/dictionary/profile_of.hpp"

namespace takt::init {
namespace {

constexpr unsigned pdo_bits = 64;
constexpr std::uint8_t every_sync = 1;

/// The objects that the master commands and watches in one kind of operation, with the indices of
/// the first axis.
struct AxisObjects {
  std::array<std::uint16_t, 3> commands;
  std::array<std::uint16_t, 3> answers;
};

constexpr AxisObjects position_axis{{0x6040, 0x607A, 0x6060}, {0x6041, 0x6064, 0x6061}};
constexpr AxisObjects velocity_axis{{0x6040, 0x60FF, 0x6060}, {0x6041, 0x606C, 0x6061}};
constexpr AxisObjects speed_axis{{0x6040, 0x6042, 0x6060}, {0x6041, 0x6044, 0x6061}};

bool can_be_mapped(const ObjectDictionary& dictionary, ObjectKey key, bool is_tpdo) {
  const SubObject* const sub = dictionary.find(key);
  if (sub == nullptr || !sub->pdo_mappable || bit_width(sub->type) == 0) return false;
  return is_tpdo ? sub->access != Access::wo : sub->is_writable();
}

/// The PDOs of one direction, to which axes are assigned one after the other.
class Direction {
 public:
  Direction(const ObjectDictionary& dictionary, bool is_tpdo)
      : dictionary_{dictionary}, is_tpdo_{is_tpdo} {
    for (PdoDescription& pdo : describe_pdos(dictionary)) {
      if (pdo.is_tpdo == is_tpdo) pdos_.push_back(std::move(pdo));
    }
  }

  /// Maps the objects of an axis. Returns false if the device has too few PDOs.
  bool add_axis(const std::array<std::uint16_t, 3>& objects, unsigned axis) {
    std::string mapping;
    unsigned bits = 0;
    for (const std::uint16_t index : objects) {
      const ObjectKey key = axis_object(axis, index);
      if (!can_be_mapped(dictionary_, key, is_tpdo_)) continue;
      const unsigned width = bit_width(dictionary_.find(key)->type);
      if (bits + width > pdo_bits) {
        if (!add_pdo(mapping, axis)) return false;
        mapping.clear();
        bits = 0;
      }
      mapping += fmt::format("{}0x{:04X}", mapping.empty() ? "" : ", ", key.index);
      bits += width;
    }
    return mapping.empty() || add_pdo(mapping, axis);
  }

  std::string text() const {
    if (lines_.empty()) return {};
    std::string text = is_tpdo_ ? "    tpdo:    # device to master, with every SYNC\n"
                                : "    rpdo:    # master to device, valid at SYNC\n";
    text += lines_;
    for (std::size_t i = used_; i < pdos_.size(); ++i) {
      if (pdos_[i].valid) text += fmt::format("      {}: {{enabled: false}}\n", pdos_[i].number);
    }
    return text;
  }

 private:
  bool add_pdo(const std::string& mapping, unsigned axis) {
    if (used_ == pdos_.size()) return false;
    lines_ += fmt::format("      {}: {{transmission: {}, cob_id: auto, mapping: [{}]}}{}\n",
                          pdos_[used_++].number, every_sync, mapping,
                          axis == 0 ? "" : fmt::format("  # axis {}", axis + 1));
    return true;
  }

  const ObjectDictionary& dictionary_;
  bool is_tpdo_;
  std::vector<PdoDescription> pdos_;
  std::size_t used_ = 0;
  std::string lines_;
};

/// Returns the objects that move an axis: those for positions if the drive supports them.
const AxisObjects* objects_of(const ObjectDictionary& dictionary, unsigned axis) {
  for (const AxisObjects* objects : {&position_axis, &velocity_axis, &speed_axis}) {
    if (can_be_mapped(dictionary, axis_object(axis, objects->commands[1]), false)) return objects;
  }
  return nullptr;
}

/// Returns the PDOs of a CiA 402 drive, or std::nullopt if its mapping is fixed or it has too few
/// PDOs.
std::optional<ProposedPdos> drive_pdos(const ObjectDictionary& dictionary) {
  if (mappable_record(dictionary) == nullptr) return std::nullopt;
  Direction outputs{dictionary, false};
  Direction inputs{dictionary, true};
  ProposedPdos proposed;
  for (unsigned axis = 0; axis < most_axes; ++axis) {
    if (!can_be_mapped(dictionary, axis_object(axis, 0x6040), false)) continue;
    const AxisObjects* const objects = objects_of(dictionary, axis);
    if (objects == nullptr) return std::nullopt;
    if (objects == &position_axis) proposed.commands_position = true;
    if (!outputs.add_axis(objects->commands, axis) || !inputs.add_axis(objects->answers, axis)) {
      return std::nullopt;
    }
  }
  proposed.text = inputs.text() + outputs.text();
  if (proposed.text.empty()) return std::nullopt;
  return proposed;
}

bool can_follow_sync(const PdoRule* rule) {
  return rule == nullptr || rule->types.empty() ||
         std::ranges::any_of(rule->types,
                             [](const NumberRange& range) { return range.contains(every_sync); });
}

}  // namespace

ProposedPdos proposed_pdos(const ObjectDictionary& dictionary, const DeviceData* data) {
  if (has_drive_words(dictionary) && (data == nullptr || !data->speed_axis.is_stated())) {
    if (auto proposed = drive_pdos(dictionary)) return *proposed;
  }
  return pdos_of_file(dictionary, data);
}

ProposedPdos pdos_of_file(const ObjectDictionary& dictionary, const DeviceData* data) {
  std::string lines[2];  // lines for RPDOs, and for TPDOs
  std::string notes;
  ProposedPdos proposed;
  for (const PdoDescription& pdo : describe_pdos(dictionary)) {
    if (!pdo.valid || pdo.mapping.empty()) continue;
    const PdoRule* const rule = data == nullptr ? nullptr : data->rule(pdo.is_tpdo, pdo.number);
    if (rule != nullptr && rule->function == PdoFunction::parameter_channel) {
      if (pdo.is_tpdo) {
        notes += fmt::format(
            "    # PDO{} is the parameter channel of the device, see `takt param`.\n", pdo.number);
      }
      continue;
    }
    if (!can_follow_sync(rule)) continue;
    std::string& text = lines[pdo.is_tpdo ? 1 : 0];
    text += fmt::format("      {}: {{transmission: {}}}\n", pdo.number, every_sync);
    const auto is_target = [](const MappedObject& entry) { return entry.key.index == 0x607A; };
    if (!pdo.is_tpdo && std::ranges::any_of(pdo.mapping, is_target)) {
      proposed.commands_position = true;
    }
  }
  proposed.text = notes;
  if (!lines[1].empty()) {
    proposed.text +=
        "    tpdo:    # device to master, with every SYNC; the mapping of the device\n" + lines[1];
  }
  if (!lines[0].empty()) {
    proposed.text +=
        "    rpdo:    # master to device, valid at SYNC; the mapping of the device\n" + lines[0];
  }
  return proposed;
}

}  // namespace takt::init
