#include "eds_parser/write/configured_values.hpp"

#include <algorithm>

#include "eds_parser/integer_of.hpp"

namespace takt {
namespace {

constexpr std::uint32_t refuse_write = 1;  // ObjFlags, bit 0
constexpr std::uint64_t invalid_pdo = 0x8000'0000;

bool is_configured(const SubObject& sub) noexcept {
  return sub.parameter_value && sub.access != Access::ro && sub.access != Access::constant &&
         (sub.flags & refuse_write) == 0;
}

bool any_configured(const Object* object) noexcept {
  return object != nullptr && std::ranges::any_of(object->subs, is_configured);
}

/// Index of the communication record whose PDO an object belongs to; 0: none.
std::uint16_t pdo_of(std::uint16_t index) noexcept {
  if (index < 0x1400 || index > 0x1BFF) return 0;
  return static_cast<std::uint16_t>(index & ~0x0200U);
}

class Collector {
 public:
  Collector(const ObjectDictionary& dictionary, Report& report) noexcept
      : dictionary_{dictionary}, report_{report} {}

  std::vector<ConciseEntry> collect() {
    std::uint16_t last_pdo = 0;
    for (const auto& object : dictionary_.objects) {
      const auto pdo = pdo_of(object.index);
      if (pdo == 0) {
        add_all(object);
      } else if (object.index == pdo) {
        add_pdo(pdo);
        last_pdo = pdo;
      } else if (pdo != last_pdo && dictionary_.find(pdo) == nullptr) {
        add_all(object);  // a mapping without its communication record
      }
    }
    return std::move(entries_);
  }

 private:
  void add_all(const Object& object) {
    for (const auto& sub : object.subs) {
      if (!is_configured(sub)) continue;
      if (object.index == 0x1010 || object.index == 0x1011) {
        report_.note(sub.parameter_pos, "command-left-out",
                     to_string(ObjectKey{object.index, sub.sub}) +
                         " stores or restores parameters; a configuration does not hold it");
        continue;
      }
      add({object.index, sub.sub}, sub, *sub.parameter_value);
    }
  }

  void add_pdo(std::uint16_t index) {
    const auto mapping_index = static_cast<std::uint16_t>(index + 0x200);
    const auto* communication = dictionary_.find(index);
    const auto* mapping = dictionary_.find(mapping_index);
    if (!any_configured(communication) && !any_configured(mapping)) return;
    const ObjectKey cob_id{index, 1};
    const auto* id = dictionary_.find(cob_id);
    const auto raw = integer_of(dictionary_, cob_id);
    const bool switchable = raw && id->access != Access::ro && id->access != Access::constant;
    if (!switchable) {
      report_.warning(communication->pos, "pdo-not-switchable",
                      to_string(cob_id) +
                          " has no known value that can be written; the PDO stays valid while "
                          "its parameters change (is --node missing?)");
    }
    const auto value = static_cast<std::uint64_t>(raw.value_or(0));
    if (switchable) add(cob_id, *id, Value{value | invalid_pdo});
    if (any_configured(mapping)) add_mapping(*mapping);
    for (const auto& sub : communication->subs) {
      if (sub.sub != 1 && is_configured(sub)) add({index, sub.sub}, sub, *sub.parameter_value);
    }
    if (switchable) add(cob_id, *id, Value{value});
  }

  void add_mapping(const Object& mapping) {
    const ObjectKey entries{mapping.index, 0};
    const auto* count = dictionary_.find(entries);
    const auto number = integer_of(dictionary_, entries);
    const bool writable =
        count != nullptr && count->access != Access::ro && count->access != Access::constant;
    if (writable) add({mapping.index, 0}, *count, Value{std::uint64_t{0}});
    for (const auto& sub : mapping.subs) {
      if (sub.sub == 0 || sub.sub > number.value_or(0) || !sub.value()) continue;
      add({mapping.index, sub.sub}, sub, *sub.value());
    }
    if (writable) {
      add({mapping.index, 0}, *count, Value{static_cast<std::uint64_t>(number.value_or(0))});
    }
  }

  void add(ObjectKey key, const SubObject& sub, const Value& value) {
    auto bytes = to_bytes(value, sub.type);
    if (sub.type == DataType::unknown) {
      return report_.warning(sub.parameter_pos, "data-type-unknown",
                             to_string(key) + " is left out: its data type is not known");
    }
    entries_.push_back({key, std::move(bytes)});
  }

  const ObjectDictionary& dictionary_;
  Report& report_;
  std::vector<ConciseEntry> entries_;
};

}  // namespace

std::vector<ConciseEntry> configured_values(const ObjectDictionary& dictionary, Report& report) {
  return Collector{dictionary, report}.collect();
}

}  // namespace takt
