#pragma once
#include "eds_parser/ini.hpp"
#include "eds_parser/report.hpp"

namespace takt {

/// Sub-indices are hexadecimal in the names of sections (CiA 306, 4.6.3.2); some files count in
/// decimal. That shows where a name goes beyond FF: [2000sub128]. Marks the sections of such an
/// object, and of others of the file that go from sub9 to sub10 without a letter; one finding an
/// object.
void mark_decimal_subs(IniFile& file, Report& report);

}  // namespace takt
