#pragma once
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/ini/ini.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// The entries of a section by key. If a key is repeated, the first entry counts. Keys must be
/// passed in lower case.
class SectionKeys {
 public:
  SectionKeys(const IniEntries& entries, Report& report);

  const IniEntry* get(std::string_view key) const;
  /// Returns the value as UTF-8. The result is empty if the key is missing.
  std::string text(std::string_view key) const;
  void flag(bool& out, std::string_view key, ValueReader& values) const;
  /// Reports the keys that no call has requested, except for the `reserved` ones.
  void report_unknown(std::string_view section, bool (*reserved)(std::string_view)) const;

  /// Returns the entry, or nullptr if the key is missing.
  template <class T>
  const IniEntry* number(T& out, std::string_view key, ValueReader& values) const {
    const auto* entry = get(key);
    const auto value =
        entry == nullptr ? std::nullopt : values.read_count(*entry, std::numeric_limits<T>::max());
    if (value) out = static_cast<T>(*value);
    return entry;
  }

 private:
  struct Slot {
    IniEntry entry;
    mutable bool asked = false;
  };

  std::vector<Slot> slots_;
  Report& report_;
};

}  // namespace takt
