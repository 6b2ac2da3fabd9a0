#pragma once
#include <cstddef>
#include <optional>

#include "eds_parser/ini.hpp"

namespace takt {

/// What the count in a section (`NrOfEntries`, `Lines`, `Items`, `ObjectLinks`) should be; none:
/// the section has no such count.
std::optional<std::size_t> counted_entries(const IniFile& file, const IniSection& section);

}  // namespace takt
