#include "eds_parser/write/configured_values.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/ini/number.hpp"

namespace takt {
namespace {

constexpr std::uint64_t invalid_pdo = 0x8000'0000;

bool is_configured(const SubObject& sub) noexcept {
  return sub.parameter_value && sub.is_configurable();
}

/// Returns whether an entry of a mapping is configured with an object.
bool maps_something(const SubObject& sub) noexcept {
  return is_configured(sub) && integer_of(sub.parameter_value).value_or(0) != 0;
}

bool any_configured(const Object* object) noexcept {
  return object != nullptr && std::ranges::any_of(object->subs, is_configured);
}

/// Returns the index of the communication record of the PDO to which an object belongs, or 0 if it
/// does not belong to a PDO.
std::uint16_t pdo_of(std::uint16_t index) noexcept {
  return is_pdo_parameter(index) ? static_cast<std::uint16_t>(index & ~0x0200U) : 0;
}

class Collector {
 public:
  Collector(const ObjectDictionary& dictionary, Report& report) noexcept
      : dictionary_{dictionary}, report_{report} {}

  std::vector<ConciseEntry> collect() {
    report_left_out();
    std::uint16_t last_pdo = 0;
    for (const auto& object : dictionary_.objects) {
      const auto pdo = pdo_of(object.index);
      if (pdo == 0) {
        add_all(object);
      } else if (object.index == pdo) {
        add_pdo(pdo);
        last_pdo = pdo;
      } else if (pdo != last_pdo && dictionary_.find(pdo) == nullptr) {
        add_all(object);  // a mapping without a communication record
      }
    }
    return std::move(entries_);
  }

 private:
  void report_left_out() {
    for (const auto& files : dictionary_.domain_files) {
      if (files.download.empty()) continue;
      report_.warning(files.pos, "download-left-out", files.key, ": the content of DownloadFile ",
                      Quoted{files.download}, " is left out of a concise DCF");
    }
    if (dictionary_.node_id) return;
    for (const auto& object : dictionary_.objects) {
      for (const auto& sub : object.subs) {
        const auto number = parse_number(sub.parameter_text);
        if (!number || !number->relative() || !sub.is_configurable()) continue;
        report_.warning(sub.parameter_pos, "value-left-out", ObjectKey{object.index, sub.sub},
                        ": ParameterValue ", Quoted{sub.parameter_text},
                        " has no value without a node id; it is left out");
      }
    }
  }

  void add_all(const Object& object) {
    for (const auto& sub : object.subs) {
      if (!is_configured(sub)) continue;
      if (object.index == 0x1010 || object.index == 0x1011) {
        report_.note(sub.parameter_pos, "command-left-out", ObjectKey{object.index, sub.sub},
                     " stores or restores parameters; takt leaves it out of the configuration");
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
    const bool switchable = raw && id->is_writable();
    if (!switchable) {
      report_.warning(communication->pos, "pdo-not-switchable", cob_id,
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
    const auto declared = integer_of(dictionary_, entries);
    const auto number = declared ? *declared : entries_of(mapping);
    const bool writable = count != nullptr && count->is_writable();
    if (writable) add({mapping.index, 0}, *count, Value{std::uint64_t{0}});
    for (const auto& sub : mapping.subs) {
      if (sub.sub == 0 || !sub.value()) continue;
      if (sub.sub <= number) {
        add({mapping.index, sub.sub}, sub, *sub.value());
      } else if (maps_something(sub)) {
        report_.warning(sub.parameter_pos, "mapping-entry-left-out",
                        ObjectKey{mapping.index, sub.sub}, " is left out: ", entries, " counts ",
                        number);
      }
    }
    if (writable) add({mapping.index, 0}, *count, Value{static_cast<std::uint64_t>(number)});
  }

  /// Returns the number of entries of a mapping whose sub 0 has no value, up to the last configured
  /// entry. Reports an error if an entry before it has no value, because the device would keep its
  /// old entry there.
  std::int64_t entries_of(const Object& mapping) {
    std::int64_t number = 0;
    for (const auto& sub : mapping.subs) {
      if (sub.sub != 0 && maps_something(sub)) number = sub.sub;
    }
    for (std::int64_t entry = 1; entry <= number; ++entry) {
      const ObjectKey key{mapping.index, static_cast<std::uint8_t>(entry)};
      if (integer_of(dictionary_, key).value_or(0) != 0) continue;
      report_.error(mapping.pos, "mapping-count-unknown", ObjectKey{mapping.index, 0},
                    " has no value, and ", key,
                    " before the last configured entry has no value either");
      break;
    }
    return number;
  }

  void add(ObjectKey key, const SubObject& sub, const Value& value) {
    if (sub.type == DataType::unknown) {
      return report_.warning(sub.parameter_pos, "data-type-unknown", key,
                             " is left out: its data type is not known");
    }
    entries_.push_back({key, to_bytes(value, sub.type)});
  }

  const ObjectDictionary& dictionary_;
  Report& report_;
  std::vector<ConciseEntry> entries_;
};

}  // namespace

std::vector<ConciseEntry> configured_values(const ObjectDictionary& dictionary, Report& report) {
  return Collector{dictionary, report}.collect();
}

ConfiguredValues configured_values(const EdsFile& file) {
  ConfiguredValues result;
  Report report{file.dictionary.file};
  if (file.readable) result.entries = configured_values(file.dictionary, report);
  result.findings = file.findings;
  std::ranges::move(report.take(), std::back_inserter(result.findings));
  if (has_error(result.findings)) result.entries.clear();
  return result;
}

}  // namespace takt
