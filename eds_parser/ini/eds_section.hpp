#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "eds_parser/ini/ini.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// The subject of a section of an EDS or DCF. CiA 306, 4.4 to 6.
enum class SectionKind : std::uint8_t {
  object,
  sub_object,
  name_list,        ///< [xxxxName]
  value_list,       ///< [xxxxValue]
  denotation_list,  ///< [xxxxDenotation]
  object_links,     ///< [xxxxObjectLinks]
  short_object,     ///< [A0]: a data type of CANFestival, which takt does not use
  file_info,
  device_info,
  dummy_usage,
  comments,
  tools,
  mandatory_objects,
  optional_objects,
  manufacturer_objects,
  commissioning,
  commissioning_two_m,  ///< [DeviceCommissioning]; the standard spells it with one m
  dynamic_channels,
  supported_modules,
  connected_modules,
  module,  ///< [M1ModuleInfo], [M1Fixed6000] ...
  unknown,
};

/// Returns true if the section belongs to an object: [2000], [2000sub1], [2000Value] ...
constexpr bool is_of_object(SectionKind kind) noexcept {
  return kind <= SectionKind::denotation_list;
}

/// The parts of a section name.
struct SectionName {
  SectionKind kind = SectionKind::unknown;
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::uint16_t module = 0;        ///< x of [Mx...]
  std::string_view module_part{};  ///< "Fixed6000sub1" of [M1Fixed6000sub1]
  bool prefixed = false;           ///< [0x2000]
  bool leading_zero = false;       ///< [2000sub01]
  bool blank = false;              ///< [2000 sub1]
};

SectionName classify_section(std::string_view name) noexcept;
/// Classifies the name of a section of a file, in which the sub-index may be decimal.
SectionName classify_section(const IniSection& section) noexcept;

/// Reports that a name has a blank in it or around it.
void report_blank_in_name(const IniSection& section, Report& report);
/// Reports that [xxxxName], [xxxxValue] or [xxxxDenotation] has no object to belong to.
void report_list_without_object(const IniSection& list, Report& report);
/// Reports that CiA 306 does not have such a key in `section`.
void report_unknown_key(const IniEntry& entry, std::string_view section, Report& report);
/// Reports that an entry that counts others (`NrOfEntries`, `Lines` ...) differs from the number
/// `found`.
void check_entry_count(const IniEntry& count, std::size_t found, std::string_view section,
                       Report& report);

/// Keys of the section of an object. CiA 306, 4.6.3.2 and 5.3.3.
enum class Keyword : std::uint8_t {
  parameter_name,
  object_type,
  data_type,
  low_limit,
  high_limit,
  access_type,
  default_value,
  pdo_mapping,
  sub_number,
  obj_flags,
  compact_sub_obj,
  parameter_value,
  denotation,
  upload_file,
  download_file,
  param_refd,
  module_count,   ///< Count of [MxSubExtxxxx]
  module_extend,  ///< ObjExtend of [MxSubExtxxxx]
  other_known,    ///< SRDOMapping, Unit ...: allowed, but not used by takt
  unknown,
};

Keyword classify_key(std::string_view key) noexcept;

/// The entries of one object's section by keyword. If a key is repeated, the first entry counts.
class ObjectFields {
 public:
  ObjectFields(const IniFile& file, const IniSection& section, Report& report);

  const IniSection& section() const noexcept { return section_; }

  bool has(Keyword keyword) const noexcept { return slot(keyword) != nullptr; }
  std::optional<IniEntry> get(Keyword keyword) const noexcept {
    const auto* spot = slot(keyword);
    if (spot == nullptr) return std::nullopt;
    return spot->entry_in(text_);
  }
  /// Returns the value as written. The result is empty if the key is missing.
  std::string_view text(Keyword keyword) const noexcept {
    const auto* spot = slot(keyword);
    return spot == nullptr ? std::string_view{} : spot->value_in(text_);
  }
  /// Returns the place of a value, or that of the section if the key is missing.
  SourcePos pos(Keyword keyword) const noexcept {
    const auto* spot = slot(keyword);
    return spot == nullptr ? section_.pos : spot->pos_in(text_);
  }

 private:
  const IniSpot* slot(Keyword keyword) const noexcept {
    return slots_[static_cast<std::size_t>(keyword)];
  }

  const IniSection& section_;
  const char* text_;
  std::array<const IniSpot*, static_cast<std::size_t>(Keyword::other_known)> slots_{};
};

}  // namespace takt
