#include "apps/takt/smooth/pdo_map.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "apps/command_line/live_arguments.hpp"
#include "apps/takt/learn/learned_pdos.hpp"
#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/values/little_endian.hpp"
#include "eds_parser/values/number_in.hpp"

namespace takt::smooth {
namespace {

/// Returns the index of the same object on the first axis, for example 0x607A for 0x687A.
unsigned of_first_axis(unsigned index) {
  return index >= 0x6000 && index < 0xA000 ? 0x6000 + (index - 0x6000) % 0x800 : index;
}

std::optional<unsigned> usual_width(ObjectKey key) {
  struct Width {
    unsigned index;
    unsigned bits;
  };
  constexpr std::array<Width, 17> widths{{{0x6040, 16},
                                          {0x6041, 16},
                                          {0x603F, 16},
                                          {0x6060, 8},
                                          {0x6061, 8},
                                          {0x6064, 32},
                                          {0x606C, 32},
                                          {0x607A, 32},
                                          {0x6071, 16},
                                          {0x6077, 16},
                                          {0x6081, 32},
                                          {0x60B1, 32},
                                          {0x60B2, 16},
                                          {0x60C1, 32},
                                          {0x60F4, 32},
                                          {0x60FD, 32},
                                          {0x60FF, 32}}};
  const auto found = std::ranges::find(widths, of_first_axis(key.index), &Width::index);
  return found == widths.end() ? std::nullopt : std::optional{found->bits};
}

bool is_output(ObjectKey key) {
  constexpr std::array outputs{0x6040U, 0x6060U, 0x6071U, 0x607AU, 0x6081U,
                               0x60B1U, 0x60B2U, 0x60C1U, 0x60FFU};
  return std::ranges::find(outputs, of_first_axis(key.index)) != outputs.end();
}

bool writes(BootAction action) {
  return action == BootAction::write || action == BootAction::write_if_differs ||
         action == BootAction::write_if_changed;
}

void add_boot(MapNode& node, const BootPlan& boot) {
  for (const BootStep& step : boot.steps) {
    if (!writes(step.action) || step.value.empty() || step.value.size() > 8) continue;
    node.values[step.object] = from_little_endian(step.value);
  }
}

/// The mapping of a PDO as it is put together from a device file and from SDO transfers.
struct Parts {
  std::optional<std::uint32_t> cob_id{};
  std::optional<unsigned> transmission{};
  std::vector<MapField> fields{};
};

/// PDOs of a device: first of RPDOs, then of TPDOs, by number.
using PartsByNumber = std::map<std::pair<bool, std::uint16_t>, Parts>;

void take_file(PartsByNumber& pdos, const ObjectDictionary& dictionary) {
  for (const PdoDescription& pdo : describe_pdos(dictionary)) {
    Parts& parts = pdos[{pdo.is_tpdo, pdo.number}];
    parts.cob_id = pdo.cob_id_raw;
    if (pdo.transmission_type) parts.transmission = *pdo.transmission_type;
    for (const MappedObject& object : pdo.mapping) {
      parts.fields.push_back({object.key, object.bit_offset, object.bits});
    }
  }
}

void take_learned(PartsByNumber& pdos, const learn::LearnedValues& values) {
  for (const learn::LearnedPdo& pdo : learn::learned_pdos(values)) {
    Parts& parts = pdos[{pdo.is_tpdo, pdo.number}];
    if (pdo.cob_id) parts.cob_id = pdo.cob_id;
    if (pdo.transmission) parts.transmission = *pdo.transmission;
    if (pdo.count == 0) parts.fields.clear();
    if (!pdo.mapping) continue;
    parts.fields.clear();
    unsigned offset = 0;
    for (const std::uint32_t entry : *pdo.mapping) {
      const unsigned bits = entry & 0xFFU;
      parts.fields.push_back({learn::mapped_object(entry), offset, bits});
      offset += bits;
    }
  }
}

/// Returns the identifier that a PDO 1 to 4 has unless the device is configured otherwise.
std::optional<std::uint32_t> predefined_id(bool is_tpdo, std::uint16_t number, std::uint8_t node) {
  if (number > 4) return {};
  return (is_tpdo ? 0x080U : 0x100U) + 0x100U * number + node;
}

void add_device(PdoMap& map, std::uint8_t id, const PartsByNumber& pdos) {
  for (const auto& [key, parts] : pdos) {
    const auto cob_id = parts.cob_id ? parts.cob_id : predefined_id(key.first, key.second, id);
    if (!cob_id || (*cob_id & cob_id_off) != 0 || parts.fields.empty()) continue;
    const CobId at = CobId::of_object(*cob_id);
    map.pdos[at] = {at, id, !key.first, parts.transmission, parts.fields};
  }
}

/// Returns true if the boot that the recording shows is complete: it begins with the boot-up
/// message and configures the device.
bool shows_boot(const learn::LearnedNode& node) {
  return node.booted_up && node.configuration().size() >= 3;
}

}  // namespace

void add_plan(PdoMap& map, const BusPlan& plan) {
  map.sync_id = plan.cycle.sync_cob_id;
  if (plan.cycle.sync) map.sync_period = plan.cycle.period;
  map.bitrate = plan.bitrate;
  for (const NodePlan& node : plan.nodes) {
    MapNode& known = map.nodes[node.id.value()];
    known.name = node.name;
    known.boot_seen = node.boot;
    add_boot(known, node.boot_plan);
  }
  const auto add = [&](const PdoRow& row, bool is_rpdo) {
    MapPdo pdo{.id = row.cob_id,
               .node = row.node.value(),
               .is_rpdo = is_rpdo,
               .transmission = row.transmission};
    for (const PdoField& field : plan.pdos.fields_of(row)) {
      pdo.fields.push_back(
          {plan.layout.signals[field.signal].object, field.bit_offset, field.bits});
    }
    map.pdos[row.cob_id] = std::move(pdo);
  };
  for (const PdoRow& row : plan.pdos.rpdos) add(row, true);
  for (const PdoRow& row : plan.pdos.tpdos) add(row, false);
}

void add_learned(PdoMap& map, const learn::LearnedBus& bus, const learn::DeviceFiles& files) {
  std::map<std::uint8_t, const learn::LearnedNode*> nodes;
  for (const learn::LearnedNode* node : bus.devices()) nodes[node->id] = node;
  for (const std::uint8_t id : files.assigned()) nodes.try_emplace(id, nullptr);
  for (const auto& [id, node] : nodes) {
    const learn::LearnedValues values = node == nullptr ? learn::LearnedValues{} : node->values();
    const auto match = files.find(id, learn::identity_of(values));
    PartsByNumber pdos;
    if (match.dictionary) take_file(pdos, *match.dictionary);
    take_learned(pdos, values);
    add_device(map, id, pdos);
    MapNode& known = map.nodes[id];
    if (node == nullptr) continue;
    known.boot_seen = known.boot_seen || shows_boot(*node);
    for (const auto& [key, value] : values) {
      if (const auto number = value.number()) known.values[key] = *number;
    }
    for (const learn::LearnedWrite& write : node->later) {  // an application may set the mode
      const auto& bytes = write.transfer.value;
      if (bytes.empty() || bytes.size() > 8) continue;
      known.values[write.transfer.object] = from_little_endian(std::as_bytes(std::span{bytes}));
    }
    for (const learn::LearnedWrite& write : node->refused) {
      known.refused.push_back(write.transfer.object);
    }
    if (const auto period = values.number({0x1006, 0});
        period && *period != 0 && !map.sync_period) {
      map.sync_period = std::chrono::microseconds{*period};
    }
    if (const auto sync = values.number({0x1005, 0}); sync && (*sync & 0x7FFU) != 0) {
      map.sync_id = CobId::of_object(static_cast<std::uint32_t>(*sync));
    }
  }
}

std::expected<void, std::string> add_pdo(PdoMap& map, const std::string& text) {
  const auto trouble = [&](const std::string& what) {
    return std::unexpected{"--pdo " + text + ": " + what + ", for example 0x205=6040,607A"};
  };
  const std::size_t equals = text.find('=');
  const auto id = parse_unsigned(std::string_view{text}.substr(0, equals), 16);
  if (equals == std::string::npos || !id || *id > 0x7FF || (*id & 0x7FU) == 0) {
    return trouble("give a COB-ID and its objects");
  }
  MapPdo pdo{.id = CobId::base(*id), .node = static_cast<std::uint8_t>(*id & 0x7FU)};
  unsigned offset = 0;
  for (std::size_t from = equals + 1; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    const std::string_view part = std::string_view{text}.substr(from, to - from);
    const std::size_t slash = part.find('/');
    const auto object = parse_object(part.substr(0, slash));
    auto bits = object ? usual_width(*object) : std::nullopt;
    if (slash != std::string_view::npos) bits = number_in<unsigned>(part.substr(slash + 1), 10);
    if (!object) return trouble("'" + std::string{part} + "' is no object");
    if (!bits || *bits == 0 || offset + *bits > 64) {
      return trouble("'" + std::string{part} +
                     "' needs its width in bits behind /, at most 64 in all");
    }
    pdo.is_rpdo = pdo.is_rpdo || is_output(*object);
    pdo.fields.push_back({*object, offset, *bits});
    offset += *bits;
    from = to + 1;
  }
  map.nodes.try_emplace(pdo.node);
  map.pdos[pdo.id] = std::move(pdo);
  return {};
}

}  // namespace takt::smooth
