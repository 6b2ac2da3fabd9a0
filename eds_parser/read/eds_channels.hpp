#pragma once
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/ini/value_reader.hpp"

namespace takt {

/// Reads [DynamicChannels] of a programmable device. A segment that can't be read completely is
/// left out. CiA 302-4, CiA 306, 4.6.3.4.3.
std::vector<DynamicChannel> read_dynamic_channels(const IniEntries& entries, SourcePos pos,
                                                  ValueReader& values, Report& report);

}  // namespace takt
