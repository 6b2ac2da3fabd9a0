#pragma once
#include <cstddef>
#include <cstdint>

#include "eds_parser/ini.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/report.hpp"
#include "eds_parser/value_reader.hpp"

namespace takt {

/// Sub-objects that short notations may add to one file. It bounds what a file of CompactSubObj=255
/// can ask for (about 100 MB); the largest real files need some thousands.
class ExpansionBudget {
 public:
  static constexpr std::size_t most = 262'144;

  /// False: the budget is used up; nothing is taken.
  bool take(std::size_t count) noexcept {
    if (count > most - used_) return false;
    used_ += count;
    return true;
  }

 private:
  std::size_t used_ = 0;
};

/// The sub 0 that such notations imply.
SubObject count_sub(const Object& object, std::uint8_t count);

/// Adds sub 0 and `count` copies of `pattern` to an object; subs that are already there stay.
/// CiA 306, 4.6.3.4.2.
void expand_compact_subs(Object& object, const SubObject& pattern, std::uint8_t count);

/// Adds objects that are not among them yet to ascending ones: each moves once at most, those
/// before the first made one not at all.
void merge_objects(std::vector<Object>& objects, std::vector<Object> made);

enum class CompactList : std::uint8_t { names, values, denotations };

/// Applies [xxxxName], [xxxxValue] or [xxxxDenotation]: keys are sub-indices in decimal.
void apply_compact_list(Object& object, CompactList list, const IniEntries& entries,
                        ValueReader& values, Report& report);

}  // namespace takt
