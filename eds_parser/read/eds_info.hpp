#pragma once
#include <functional>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// Reads [FileInfo]. CiA 306, 4.4.
void read_file_info(FileInfo& info, const IniEntries& entries, Report& report);
/// Reads Line1, Line2 ... of [Comments], in the order of the file. CiA 306, 4.6.5.
std::vector<std::string> read_comments(const IniEntries& entries, Report& report);
/// Reads one section [ToolN].
VendorTool read_tool(const IniSection& section, const IniEntries& entries, Report& report);
/// Compares [Tools] with `found`, the number of sections [ToolN].
void check_tools(const IniEntries& entries, std::size_t found, Report& report);
/// Reads [xxxxObjectLinks]. `is_described` returns whether the file describes the object of an
/// index. CiA 306, 4.6.4.
ObjectLinks read_links(const IniSection& section, const IniEntries& entries,
                       const std::function<bool(std::uint16_t)>& is_described, Report& report);

/// Reads [DeviceInfo]. CiA 306, 4.5.
void read_device_info(DeviceInfo& device, const IniSection& section, const IniEntries& entries,
                      ValueReader& values, Report& report);
/// Reads [DeviceComissioning]. CiA 306, 5.3.
void read_commissioning(Commissioning& commissioning, const IniEntries& entries,
                        ValueReader& values, Report& report);
/// Reads [MxModuleInfo]. CiA 306, 6.
ModuleInfo read_module_info(std::uint16_t number, const IniSection& section,
                            const IniEntries& entries, Report& report);
/// Reads [DummyUsage]. CiA 306, 4.6.2.
void read_dummy_usage(std::array<bool, 8>& usage, const IniEntries& entries, ValueReader& values,
                      Report& report);

}  // namespace takt
