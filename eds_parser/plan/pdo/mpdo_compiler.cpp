#include <algorithm>
#include <optional>
#include <string>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/object_names.hpp"
#include "eds_parser/plan/pdo/mapping_compiler.hpp"

namespace takt {
namespace {

constexpr unsigned data_bits = 32;  ///< bytes 4..7
constexpr std::uint32_t destination_flag = 0x80;

std::optional<EffectiveEntry> compile_entry(const NodeSource& node, const EffectivePdo& pdo,
                                            const MappingSpec& wanted, NetworkReport& report) {
  const bool of_master = pdo.is_tpdo && pdo.mpdo == Mpdo::dam;
  const SubObject* sub = node.dictionary->find(wanted.object);
  const std::string what = pdo.label(*node.spec) + ": object " + to_string(wanted.object);
  if (sub == nullptr && !of_master) {
    report.error(wanted.pos, "no-such-object", what, " is not in ", node.dictionary->file);
    return {};
  }
  const DataType type = of_master ? DataType::unsigned32 : sub->type;
  const unsigned bits = wanted.bits ? *wanted.bits : bit_width(type);
  if (bits == 0 || bits > data_bits) {
    report.error(wanted.pos, "wrong-width", what,
                 " does not fit: a multiplexed PDO carries up to 32 bits");
    return {};
  }
  return EffectiveEntry{.object = wanted.object,
                        .bits = static_cast<std::uint8_t>(bits),
                        .bit_offset = data_bits,
                        .type = type,
                        .name = of_master ? "object " + to_string(wanted.object)
                                          : object_name(*node.dictionary, wanted.object),
                        .pos = wanted.pos};
}

/// The object dispatching list (0x1FD0..0x1FFF) of a device, according to its file and the `sdo`
/// writes of its node. It states which objects of which nodes the device receives by source
/// address. CiA 301, 7.5.2.
class DispatchingList {
 public:
  explicit DispatchingList(const NodeSource& node) : node_{node} {
    for (const Object& list : node.dictionary->objects) {
      if (list.index < first_dispatcher || list.index > last_dispatcher) continue;
      for (const SubObject& sub : list.subs) {
        if (sub.sub != 0) add({list.index, sub.sub}, sub);
      }
    }
  }

  bool exists() const noexcept { return !entries_.empty() || !free_.empty(); }

  /// Returns the object of `sender` that the device copies into its own `object`.
  std::optional<ObjectKey> sent_as(ObjectKey object, NodeId sender) const noexcept {
    for (const Entry& entry : entries_) {
      const unsigned offset = unsigned{object.sub} - entry.local.sub;
      if (entry.node != sender.value() || entry.local.index != object.index) continue;
      if (offset >= entry.block) continue;
      return ObjectKey{entry.sender.index, static_cast<std::uint8_t>(entry.sender.sub + offset)};
    }
    return {};
  }

  /// Returns the text of an `sdo:` entry with which `sender` sends the object under its own index.
  /// Uses up a free place of the list.
  std::string proposal(ObjectKey object, NodeId sender) {
    if (free_.empty()) return "the list has no free entry either";
    const std::uint32_t low =
        std::uint32_t{object.index} << 16 | std::uint32_t{object.sub} << 8 | sender.value();
    const std::uint32_t high = 1U << 24 | std::uint32_t{object.index} << 8 | object.sub;
    const ObjectKey place = free_.front();
    free_.erase(free_.begin());
    return concat("write one under `sdo:`, `{index: ", hex(place.index), ", sub_index: ", place.sub,
                  ", value: ", hex(high, 8), hex(low, 8).substr(2), "}`");
  }

 private:
  static constexpr std::uint16_t first_dispatcher = 0x1FD0;
  static constexpr std::uint16_t last_dispatcher = 0x1FFF;

  struct Entry {
    ObjectKey local;
    ObjectKey sender;
    std::uint8_t node = 0;
    unsigned block = 1;  ///< number of consecutive sub-indices
  };

  /// Returns the value of a list entry. The last write counts.
  std::uint64_t value_of(ObjectKey place, const SubObject& sub) const {
    std::int64_t value = integer_of(sub.value()).value_or(0);
    for (const SdoSpec& written : node_.spec->sdo) {
      if (written.object == place && written.integer() != nullptr) value = *written.integer();
    }
    return static_cast<std::uint64_t>(value);
  }

  void add(ObjectKey place, const SubObject& sub) {
    const std::uint64_t value = value_of(place, sub);
    if (value == 0) {
      if (sub.is_writable()) free_.push_back(place);
      return;
    }
    const auto block = static_cast<unsigned>(value >> 56);
    entries_.push_back(
        {.local = {static_cast<std::uint16_t>(value >> 40), static_cast<std::uint8_t>(value >> 32)},
         .sender = {static_cast<std::uint16_t>(value >> 16), static_cast<std::uint8_t>(value >> 8)},
         .node = static_cast<std::uint8_t>(value),
         .block = block == 0 ? 1 : block});
  }

  const NodeSource& node_;
  std::vector<Entry> entries_;
  std::vector<ObjectKey> free_;  ///< empty places that can be written
};

}  // namespace

std::vector<EffectiveEntry> compile_mpdo(const NodeSource& node, const EffectivePdo& pdo,
                                         const Sourced<std::vector<MappingSpec>>& wanted,
                                         NetworkReport& report) {
  std::vector<EffectiveEntry> entries;
  for (const MappingSpec& spec : *wanted) {
    auto entry = compile_entry(node, pdo, spec, report);
    if (!entry) continue;
    if (std::ranges::find(entries, entry->object, &EffectiveEntry::object) != entries.end()) {
      report.error(spec.pos, "mapped-twice", pdo.label(*node.spec), " lists ", spec.object,
                   " twice");
      continue;
    }
    entries.push_back(std::move(*entry));
  }
  return entries;
}

std::uint32_t mpdo_header(const NodeSource& node, const EffectivePdo& pdo,
                          const EffectiveEntry& entry, NodeId master) {
  std::uint32_t address = pdo.is_tpdo ? node.id.value() : master.value();
  ObjectKey object = entry.object;
  if (pdo.mpdo == Mpdo::dam) {
    address = destination_flag | (pdo.is_tpdo ? master.value() : node.id.value());
  } else if (!pdo.is_tpdo) {
    object = DispatchingList{node}.sent_as(object, master).value_or(object);
  }
  return address | std::uint32_t{object.index} << 8 | std::uint32_t{object.sub} << 24;
}

void check_dispatching(const NodeSource& node, const EffectivePdo& pdo, NodeId master,
                       NetworkReport& report) {
  if (pdo.is_tpdo || pdo.mpdo != Mpdo::sam) return;
  const auto error = [&](SourcePos pos, const auto&... parts) {
    report.error(pos, "dispatching-list", pdo.label(*node.spec), " (SAM): ", parts...);
  };
  DispatchingList list{node};
  if (!list.exists()) {
    return error(pdo.pos, node.dictionary->file,
                 " has no object dispatching list (0x1FD0..0x1FFF), so the device accepts no MPDO "
                 "by source address; write its objects with `mpdo: dam`");
  }
  std::vector<ObjectKey> senders;
  for (const EffectiveEntry& entry : pdo.mapping) {
    const auto sender = list.sent_as(entry.object, master);
    if (!sender) {
      error(entry.pos, "no entry of its object dispatching list (0x1FD0..0x1FFF) takes ",
            entry.object, " from the master, node ", master.value(), ": ",
            list.proposal(entry.object, master));
    } else if (std::ranges::find(senders, *sender) != senders.end()) {
      error(entry.pos, entry.object, " is dispatched from ", *sender,
            " of the master, like another object of this PDO: both would overwrite each other; "
            "list only one of them");
    } else {
      senders.push_back(*sender);
    }
  }
}

}  // namespace takt
