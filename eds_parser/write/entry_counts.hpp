#pragma once
#include <cstddef>
#include <optional>

#include "eds_parser/ini/ini.hpp"

namespace takt {

/// Returns the correct count for a section (`NrOfEntries`, `Lines`, `Items`, `ObjectLinks`), or
/// std::nullopt if the section has no such count.
std::optional<std::size_t> counted_entries(const IniFile& file, const IniSection& section);

}  // namespace takt
