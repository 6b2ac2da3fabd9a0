#include "eds_parser/read/compact_pdos.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <string_view>
#include <utility>

#include "eds_parser/read/compact.hpp"

namespace takt {
namespace {

/// Appends one sub-object to a record that CompactPDO implies.
SubObject& add_sub(Object& object, std::uint8_t sub, DataType type, std::uint64_t value) {
  auto& made = object.subs.emplace_back();
  made.sub = sub;
  made.type = type;
  made.type_code = static_cast<std::uint16_t>(type);
  made.access = Access::rw;
  made.default_value = value;
  made.default_text = std::to_string(value);
  return made;
}

constexpr std::uint64_t off = 0x8000'0000;  // COB-ID, bit 31

/// Adds the default COB-ID. PDO 1 to 4 get that of the predefined connection set. Other PDOs are
/// switched off, and so are the PDOs that a DCF does not list. CiA 306, 5.3.3.1.
void add_cob_id(Object& object, std::uint16_t number, bool is_tpdo,
                const ObjectDictionary& dictionary) {
  auto& sub = add_sub(object, 1, DataType::unsigned32, off);
  sub.name = "COB-ID";
  sub.default_text = "0x80000000";
  if (number > 4) return;
  const unsigned base = (is_tpdo ? 0x180U : 0x200U) + 0x100U * (number - 1U);
  const auto value = [&dictionary](std::uint64_t constant) {
    return dictionary.node_id ? std::optional<Value>{constant + dictionary.node_id->value()}
                              : std::nullopt;
  };
  sub.default_text = "$NODEID+" + hex(base, 3);
  sub.default_value = value(base);
  if (!dictionary.is_dcf) return;
  sub.parameter_text = "$NODEID+" + hex(off + base);
  sub.parameter_value = value(off + base);
}

/// Returns the record at `first` + `number` - 1 without sub-objects.
Object pdo_record(unsigned first, std::uint16_t number, bool is_tpdo, std::string_view what) {
  Object object;
  object.index = static_cast<std::uint16_t>(first + number - 1);
  object.name = is_tpdo ? "TPDO " : "RPDO ";
  object.name.append(std::to_string(number)).append(what);
  object.type = ObjectType::record;
  object.list = ObjectList::optional;
  return object;
}

Object communication_record(std::uint16_t number, bool is_tpdo,
                            const ObjectDictionary& dictionary) {
  struct Optional {
    std::uint8_t sub;
    std::string_view name;
    DataType type;
    std::uint64_t value;
  };
  constexpr Optional optional[] = {{2, "Transmission type", DataType::unsigned8, 255},
                                   {3, "Inhibit time", DataType::unsigned16, 0},
                                   {4, "Reserved", DataType::unsigned8, 0},
                                   {5, "Event timer", DataType::unsigned16, 0},
                                   {6, "SYNC start value", DataType::unsigned8, 0}};
  auto object = pdo_record(is_tpdo ? 0x1800 : 0x1400, number, is_tpdo, " communication");
  const unsigned mask = dictionary.device.compact_pdo & 0x3FU;
  object.subs.reserve(7);
  object.subs.push_back(count_sub(object, static_cast<std::uint8_t>(std::bit_width(mask))));
  if ((mask & 0x01) != 0) add_cob_id(object, number, is_tpdo, dictionary);
  for (const auto& each : optional) {
    if ((mask >> (each.sub - 1U) & 1U) == 0) continue;
    add_sub(object, each.sub, each.type, each.value).name = each.name;
  }
  return object;
}

Object mapping_record(std::uint16_t number, bool is_tpdo) {
  constexpr unsigned entries = 64;
  auto object = pdo_record(is_tpdo ? 0x1A00 : 0x1600, number, is_tpdo, " mapping");
  object.subs.reserve(entries + 1);
  add_sub(object, 0, DataType::unsigned8, 0).name = "Number of mapped objects";
  for (unsigned sub = 1; sub <= entries; ++sub) {
    auto& entry = add_sub(object, static_cast<std::uint8_t>(sub), DataType::unsigned32, 0);
    entry.name = "Mapped object ";
    entry.name += std::to_string(sub);
  }
  return object;
}

/// Sets the place of an object and its sub-objects. Objects that the file counts but does not
/// describe get the place of the count.
void place(Object& object, SourcePos pos) noexcept {
  object.pos = pos;
  for (auto& sub : object.subs) {
    sub.pos = sub.default_pos = pos;
    if (!sub.parameter_text.empty()) sub.parameter_pos = pos;
  }
}

/// Adds the records of one direction that the file leaves out.
void add_missing(const ObjectDictionary& dictionary, bool is_tpdo, std::uint16_t total,
                 std::vector<Object>& made) {
  const std::uint16_t first = is_tpdo ? 0x1800 : 0x1400;
  const auto& device = dictionary.device;
  const SourcePos pos = is_tpdo ? device.nr_tx_pdo_pos : device.nr_rx_pdo_pos;
  const auto described = static_cast<std::size_t>(
      std::ranges::count_if(dictionary.objects, [first](const Object& object) {
        return object.index >= first && object.index < first + 0x200;
      }));
  if (total > 512) total = 512;
  std::size_t missing = total > described ? total - described : 0;
  for (std::uint16_t number = 1; missing > 0 && number <= 512; ++number) {
    const auto index = static_cast<std::uint16_t>(first + number - 1);
    if (dictionary.find(index) != nullptr) continue;
    made.push_back(communication_record(number, is_tpdo, dictionary));
    place(made.back(), pos);
    if (dictionary.find(static_cast<std::uint16_t>(index + 0x200)) == nullptr) {
      made.push_back(mapping_record(number, is_tpdo));
      place(made.back(), pos);
    }
    --missing;
  }
}

}  // namespace

void expand_compact_pdos(ObjectDictionary& dictionary) {
  if (dictionary.device.compact_pdo == 0) return;
  std::vector<Object> made;
  add_missing(dictionary, false, dictionary.device.nr_rx_pdo, made);
  add_missing(dictionary, true, dictionary.device.nr_tx_pdo, made);
  merge_objects(dictionary.objects, std::move(made));
}

}  // namespace takt
