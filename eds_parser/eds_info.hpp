#pragma once
#include <span>

#include "eds_parser/ini.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/report.hpp"
#include "eds_parser/value_reader.hpp"

namespace takt {

/// [DeviceInfo]. CiA 306, 4.5.
void read_device_info(DeviceInfo& device, const IniSection& section,
                      std::span<const IniEntry> entries, ValueReader& values, Report& report);
/// [DeviceComissioning]. CiA 306, 5.3.
void read_commissioning(Commissioning& commissioning, std::span<const IniEntry> entries,
                        ValueReader& values, Report& report);
/// [DummyUsage]. CiA 306, 4.6.2.
void read_dummy_usage(std::array<bool, 8>& usage, std::span<const IniEntry> entries,
                      ValueReader& values);

}  // namespace takt
