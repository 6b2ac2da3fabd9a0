#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/read/compact.hpp"

namespace takt {

/// One section that belongs to an object: the index of the object, the role of the section, and its
/// place in the file.
struct ObjectSection {
  static constexpr std::uint32_t main_role = 0;
  static constexpr std::uint32_t first_sub_role = 1;  ///< the sub-index is added
  static constexpr std::uint32_t first_list_role = 0x101;

  static ObjectSection of(const SectionName& name, std::uint32_t section) noexcept;

  std::uint32_t order = 0;  ///< index x 512 + role; sorts the sections of a file by object
  std::uint32_t section = 0;

  std::uint16_t index() const noexcept { return static_cast<std::uint16_t>(order >> 9); }
  std::uint32_t role() const noexcept { return order & 0x1FF; }
  bool is_sub() const noexcept { return role() >= first_sub_role && role() < first_list_role; }
  bool is_list() const noexcept { return role() >= first_list_role; }
  std::uint8_t sub() const noexcept { return static_cast<std::uint8_t>(role() - first_sub_role); }
};

/// The content of [MxSubExtxxxx]. CiA 306, 6.
struct SubExtension {
  SubObject pattern;
  std::string_view count;  ///< text of Count
  SourcePos count_pos;     ///< place of Count, or of the section if there is no Count
  /// ObjExtend: last sub-index before the extension continues in the next object; 0 means never.
  unsigned last_sub = 0;
};

/// What the reader does with a CompactSubObj when its ExpansionBudget is used up.
enum class BeyondBudget : std::uint8_t {
  error,  ///< Reports that sub-objects are left out.
  shape,  ///< Reads the section only for its findings and makes no sub-objects.
};

/// Builds objects from their sections.
class ObjectReader {
 public:
  ObjectReader(const IniFile& file, ValueReader& values, Report& report,
               BeyondBudget beyond = BeyondBudget::error) noexcept
      : file_{file}, values_{values}, report_{report}, beyond_{beyond} {}

  /// Reads one object. `group` holds all sections of one index in ascending order. The object may
  /// have no sub-objects: a record without them stays in the dictionary.
  Object read(std::span<const ObjectSection> group);
  /// Returns the domain files of the objects read so far.
  std::vector<DomainFiles> take_domain_files() noexcept { return std::move(domain_files_); }
  /// Returns the ParamRefd entries of the objects read so far.
  std::vector<ParameterReference> take_references() noexcept { return std::move(references_); }
  SubExtension read_extension(const IniSection& section, std::uint16_t index);

 private:
  struct Parts;

  Parts split(std::span<const ObjectSection> group);
  /// Returns false if sub-objects were left out, so that lists of sub-objects cannot be checked.
  bool read_main(Object& object, const Parts& parts);
  void read_single(Object& object, const ObjectFields& fields);
  void read_subs(Object& object, const Parts& parts);
  bool expand(Object& object, const ObjectFields& fields, const Parts& parts, std::uint32_t count);
  void check_sub_number(const Object& object, const ObjectFields& fields);
  ObjectType read_object_type(const ObjectFields& fields, std::uint16_t index, bool has_subs);
  void read_sub(SubObject& sub, const ObjectFields& fields, ObjectKey key);
  void read_type(SubObject& sub, const ObjectFields& fields, ObjectKey key);
  Access read_access(const ObjectFields& fields, ObjectKey key, bool is_domain);
  void read_values(SubObject& sub, const ObjectFields& fields, ObjectKey key);
  void judge_limits(SubObject& sub, const ObjectFields& fields, ObjectKey key);
  std::uint32_t read_count(const ObjectFields& fields, Keyword keyword,
                           std::uint32_t highest = 0xFF);
  void apply_lists(Object& object, const Parts& parts);
  void keep_reference(const ObjectFields& fields, std::uint16_t index,
                      std::optional<std::uint8_t> sub);

  const IniFile& file_;
  ValueReader& values_;
  Report& report_;
  BeyondBudget beyond_;
  ExpansionBudget budget_;
  std::vector<DomainFiles> domain_files_;
  std::vector<ParameterReference> references_;
};

}  // namespace takt
