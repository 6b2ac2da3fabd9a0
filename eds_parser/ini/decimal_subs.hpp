#pragma once
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// Sub-indices in section names are hexadecimal (CiA 306, 4.6.3.2), but some files count in
/// decimal. A name that would exceed FF shows this: [2000sub128]. The function marks the sections
/// of such an object, and those of other objects of the file that go from sub9 to sub10 without a
/// letter. It reports one finding for each object.
void mark_decimal_subs(IniFile& file, Report& report);

}  // namespace takt
