#pragma once
#include <cstddef>
#include <cstdint>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// The number of sub-objects that short notations may add to one file. The limit bounds the memory
/// that a file full of CompactSubObj=255 can demand (about 100 MB). The largest real files need
/// some thousands.
class ExpansionBudget {
 public:
  static constexpr std::size_t most = 262'144;

  /// Returns false and takes nothing if the remaining budget is too small.
  bool take(std::size_t count) noexcept {
    if (count > most - used_) return false;
    used_ += count;
    return true;
  }

 private:
  std::size_t used_ = 0;
};

/// Returns the sub 0 that a short notation with `count` sub-objects implies.
SubObject count_sub(const Object& object, std::uint8_t count);

/// Adds sub 0 and `count` copies of `pattern` to an object. Sub-objects that the object already has
/// are kept. CiA 306, 4.6.3.4.2.
void expand_compact_subs(Object& object, const SubObject& pattern, std::uint8_t count);

/// Merges new objects into a list in ascending order; no index may occur in both. Each object moves
/// at most once, and the objects before the first new one do not move at all.
void merge_objects(std::vector<Object>& objects, std::vector<Object> made);

enum class CompactList : std::uint8_t { names, values, denotations };

/// Applies [xxxxName], [xxxxValue] or [xxxxDenotation]. The keys are sub-indices in decimal.
void apply_compact_list(Object& object, CompactList list, const IniEntries& entries,
                        ValueReader& values, Report& report);

}  // namespace takt
