#include "eds_parser/read/eds_objects.hpp"

#include <algorithm>

#include "eds_parser/dictionary/standard_types.hpp"
#include "eds_parser/read/object_words.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {
namespace {

bool is_structured(ObjectType type) noexcept {
  return type == ObjectType::array || type == ObjectType::record || type == ObjectType::defstruct;
}

std::uint32_t role_of(const SectionName& name) noexcept {
  using enum SectionKind;
  if (name.kind == sub_object) return ObjectSection::first_sub_role + name.sub;
  const bool is_list = name.kind >= name_list && name.kind <= denotation_list;
  if (!is_list) return ObjectSection::main_role;
  return ObjectSection::first_list_role + static_cast<std::uint32_t>(name.kind) -
         static_cast<std::uint32_t>(name_list);
}

}  // namespace

ObjectSection ObjectSection::of(const SectionName& name, std::uint32_t section) noexcept {
  return {.order = static_cast<std::uint32_t>(name.index) << 9 | role_of(name), .section = section};
}

/// The sections of one object, sorted by role.
struct ObjectReader::Parts {
  std::uint16_t index = 0;
  const IniSection* main = nullptr;
  std::span<const ObjectSection> subs;
  std::array<const IniSection*, 3> lists{};  ///< indexed by CompactList
};

ObjectReader::Parts ObjectReader::split(std::span<const ObjectSection> group) {
  Parts parts;
  parts.index = group.front().index();
  std::size_t at = 0;
  if (group[0].role() == ObjectSection::main_role)
    parts.main = &file_.sections[group[at++].section];
  const auto first_sub = at;
  while (at < group.size() && group[at].is_sub()) ++at;
  parts.subs = group.subspan(first_sub, at - first_sub);
  for (; at < group.size(); ++at) {
    parts.lists[group[at].role() - ObjectSection::first_list_role] =
        &file_.sections[group[at].section];
  }
  return parts;
}

Object ObjectReader::read(std::span<const ObjectSection> group) {
  const auto parts = split(group);
  Object object;
  object.index = parts.index;
  object.type = ObjectType::record;
  object.pos = file_.sections[group.front().section].pos;
  if (parts.main == nullptr) {
    report_.warning(object.pos, "object-section-missing", "object ", Hex{object.index},
                    " has sub-objects but no main section; read as a RECORD");
    read_subs(object, parts);
  } else if (!read_main(object, parts)) {
    return object;
  }
  apply_lists(object, parts);
  return object;
}

SubExtension ObjectReader::read_extension(const IniSection& section, std::uint16_t index) {
  const ObjectFields fields{file_, section, report_};
  SubExtension extension;
  extension.count = fields.text(Keyword::module_count);
  extension.count_pos = fields.pos(Keyword::module_count);
  read_sub(extension.pattern, fields, {index, 1});
  extension.last_sub = read_count(fields, Keyword::module_extend, 254);
  return extension;
}

bool ObjectReader::read_main(Object& object, const Parts& parts) {
  const auto& section = *parts.main;
  const ObjectFields fields{file_, section, report_};
  object.name = to_utf8(fields.text(Keyword::parameter_name));
  if (object.name.empty()) {
    report_.warning(section.pos, "parameter-name-missing", section, " has no ParameterName");
  }
  object.type = read_object_type(fields, object.index, !parts.subs.empty());
  const auto compact = read_count(fields, Keyword::compact_sub_obj);
  if (compact != 0 && !is_structured(object.type)) {
    report_.warning(fields.pos(Keyword::object_type), "sub-objects-of-var", "object ",
                    Hex{object.index},
                    " is not an ARRAY or RECORD but has CompactSubObj; read as an ARRAY");
    object.type = ObjectType::array;
  }
  if (!is_structured(object.type)) {
    keep_reference(fields, object.index, 0);
    read_single(object, fields);
    return true;
  }
  keep_reference(fields, object.index, {});
  object.denotation = to_utf8(fields.text(Keyword::denotation));
  read_subs(object, parts);
  if (compact != 0) return expand(object, fields, parts, compact);
  check_sub_number(object, fields);
  return true;
}

void ObjectReader::read_single(Object& object, const ObjectFields& fields) {
  read_sub(object.subs.emplace_back(), fields, {object.index, 0});
  auto& sub = object.subs.back();
  if (object.type == ObjectType::domain && !fields.has(Keyword::data_type)) {
    sub.type = DataType::domain;
    sub.type_code = 0x000F;
  }
}

void ObjectReader::read_subs(Object& object, const Parts& parts) {
  object.subs.reserve(parts.subs.size());
  for (const auto& part : parts.subs) {
    const auto& section = file_.sections[part.section];
    const ObjectFields fields{file_, section, report_};
    if (!fields.has(Keyword::parameter_name)) {
      report_.warning(section.pos, "parameter-name-missing", section, " has no ParameterName");
    }
    // The result is not used; the call only reports how the key is written.
    read_type_code(fields, Keyword::object_type, values_, report_);
    keep_reference(fields, part.index(), part.sub());
    read_sub(object.subs.emplace_back(), fields, {part.index(), part.sub()});
  }
}

bool ObjectReader::expand(Object& object, const ObjectFields& fields, const Parts& parts,
                          std::uint32_t count) {
  const auto& section = fields.section();
  const auto pos = fields.pos(Keyword::compact_sub_obj);
  if (!fields.has(Keyword::data_type) && standard_type({object.index, 1}) == DataType::unknown) {
    report_.error(pos, "compact-without-type", section,
                  " has CompactSubObj but no DataType; its sub-objects were left out");
    return true;
  }
  if (count > 0xFE) {
    report_.warning(pos, "compact-too-many", "CompactSubObj is at most 254; read as 254");
    count = 0xFE;
  }
  const bool fits = budget_.take(count + 1U);
  if (!fits && beyond_ == BeyondBudget::error) {
    report_.error(pos, "too-many-sub-objects", "more than ", ExpansionBudget::most,
                  " sub-objects by CompactSubObj; those of ", section, " were left out");
    return false;
  }
  if (!parts.subs.empty()) {
    report_.warning(pos, "compact-and-sections", section,
                    " has CompactSubObj and sections of sub-objects; the sections apply");
  } else if (read_count(fields, Keyword::sub_number) != 0) {
    report_.warning(fields.pos(Keyword::sub_number), "compact-and-sub-number",
                    "SubNumber is 0 or missing beside CompactSubObj; it was left out");
  }
  SubObject pattern;
  read_sub(pattern, fields, {object.index, 1});
  if (fits) expand_compact_subs(object, pattern, static_cast<std::uint8_t>(count));
  return fits;
}

void ObjectReader::check_sub_number(const Object& object, const ObjectFields& fields) {
  const auto& section = fields.section();
  const auto found = static_cast<std::size_t>(
      std::ranges::count_if(object.subs, [](const SubObject& sub) { return sub.sub != 0xFF; }));
  const auto pos = fields.pos(Keyword::sub_number);
  if (object.subs.empty()) {
    report_.warning(section.pos, "no-sub-objects", section,
                    " is an ARRAY or RECORD without sub-objects");
    return;
  }
  const auto entry = fields.get(Keyword::sub_number);
  const auto declared = entry ? values_.read_count(*entry, 0xFF) : std::nullopt;
  if (!declared) {
    report_.warning(pos, "sub-number-missing", section, " has no SubNumber; ", found,
                    " sub-objects were found");
  } else if (*declared != found) {
    report_.warning(pos, "sub-number-wrong", "SubNumber of ", section, " is ", *declared,
                    ", but there are sections of ", found,
                    " sub-objects (sub FF not counted); all were read");
  }
}

ObjectType ObjectReader::read_object_type(const ObjectFields& fields, std::uint16_t index,
                                          bool has_subs) {
  const auto pos = fields.pos(Keyword::object_type);
  const auto code = read_type_code(fields, Keyword::object_type, values_, report_);
  const bool known = code && (*code == 0 || *code == 2 || (*code >= 5 && *code <= 9));
  if (code && !known) {
    report_.warning(pos, "object-type-unknown", "ObjectType ", Hex{*code, 2}, " of ",
                    fields.section(), " does not exist; read as a ", has_subs ? "RECORD" : "VAR");
  }
  const auto type = known ? static_cast<ObjectType>(*code) : ObjectType::var;
  if (!has_subs || is_structured(type)) return type;
  report_.warning(pos, "sub-objects-of-var", "object ", Hex{index},
                  known ? " is not an ARRAY or RECORD" : " has no ObjectType",
                  " but has sub-objects; read as a RECORD");
  return ObjectType::record;
}

void ObjectReader::read_sub(SubObject& sub, const ObjectFields& fields, ObjectKey key) {
  sub.sub = key.sub;
  sub.name = to_utf8(fields.text(Keyword::parameter_name));
  sub.pos = fields.section().pos;
  sub.default_pos = fields.pos(Keyword::default_value);
  read_type(sub, fields, key);
  sub.access = read_access(fields, key, sub.type == DataType::domain);
  if (const auto mapping = fields.get(Keyword::pdo_mapping)) {
    sub.pdo_mappable = values_.read_flag(*mapping);
    if (sub.pdo_mappable && is_bytes(sub.type) && sub.type != DataType::unknown) {
      report_.warning(mapping->pos(), "mappable-without-size", key, ": the size of ", sub.type,
                      " is not fixed, so PDOMapping should be 0");
    }
  }
  sub.flags = read_count(fields, Keyword::obj_flags, 0xFFFF'FFFF);
  read_values(sub, fields, key);
  if (fields.has(Keyword::upload_file) || fields.has(Keyword::download_file)) {
    domain_files_.push_back(
        {key, to_utf8(fields.text(Keyword::upload_file)),
         to_utf8(fields.text(Keyword::download_file)),
         fields.pos(fields.has(Keyword::download_file) ? Keyword::download_file
                                                       : Keyword::upload_file)});
  }
}

void ObjectReader::read_type(SubObject& sub, const ObjectFields& fields, ObjectKey key) {
  const auto pos = fields.pos(Keyword::data_type);
  if (const auto code = read_type_code(fields, Keyword::data_type, values_, report_)) {
    sub.type_code = static_cast<std::uint16_t>(*code);
    sub.type = data_type_of(*code);
    if (sub.type == DataType::unknown) {
      report_.warning(pos, "data-type-unknown", key, ": DataType ", Hex{*code},
                      " is not one of CiA 301; values are kept as text");
    }
    const auto wanted = standard_type(key);
    if (wanted != DataType::unknown && wanted != sub.type && sub.type != DataType::unknown) {
      report_.warning(pos, "standard-type", key, ": DataType is ", sub.type,
                      ", but CiA 301 requires ", wanted);
    }
    return;
  }
  const bool is_domain = is_domain_object(fields);
  sub.type = is_domain ? DataType::domain : standard_type(key);
  sub.type_code = static_cast<std::uint16_t>(sub.type);
  if (is_domain) return;
  report_.warning(fields.section().pos, "data-type-missing", fields.section(), " has no DataType; ",
                  sub.type == DataType::unknown
                      ? "the object is kept without a type"
                      : "read as " + std::string{name(sub.type)} + ", as in CiA 301");
}

Access ObjectReader::read_access(const ObjectFields& fields, ObjectKey key, bool is_domain) {
  const auto text = fields.text(Keyword::access_type);
  if (const auto access = access_of_word(text)) return *access;
  const auto pos = fields.pos(Keyword::access_type);
  const auto bare = without_comment(text);
  if (const auto access = access_of_word(bare)) {
    report_.warning(pos, "inline-comment", key,
                    " AccessType: text behind ';' or '#' was read as a comment");
    return *access;
  }
  if (const auto access = access_of_letter(bare)) {
    report_.warning(pos, "access-type-letter", key, ": AccessType ", Quoted{bare}, " was read as ",
                    access_name(*access));
    return *access;
  }
  if (!bare.empty()) {
    report_.warning(pos, "access-type-unknown", key, ": AccessType ", Quoted{bare},
                    " is unknown; read as rw");
  } else if (!is_domain) {
    report_.warning(pos, "access-type-missing", key, ": AccessType is missing; read as rw");
  }
  return Access::rw;
}

void ObjectReader::read_values(SubObject& sub, const ObjectFields& fields, ObjectKey key) {
  const auto read = [&](Keyword keyword, std::string_view what, Severity misfit,
                        Severity unreadable = Severity::warning) {
    const auto text = fields.text(keyword);
    if (text.empty()) return std::optional<Value>{};
    return values_.read(text, sub.type, {key, what, fields.pos(keyword), misfit, unreadable});
  };
  sub.default_value = read(Keyword::default_value, "DefaultValue", Severity::error);
  sub.default_text = to_utf8(fields.text(Keyword::default_value));
  if (fields.has(Keyword::parameter_value)) {
    sub.parameter_value =
        read(Keyword::parameter_value, "ParameterValue", Severity::error, Severity::error);
    sub.parameter_text = to_utf8(fields.text(Keyword::parameter_value));
    sub.parameter_pos = fields.pos(Keyword::parameter_value);
  }
  if (fields.has(Keyword::denotation)) sub.denotation = to_utf8(fields.text(Keyword::denotation));
  sub.low_limit = read(Keyword::low_limit, "LowLimit", Severity::warning);
  sub.high_limit = read(Keyword::high_limit, "HighLimit", Severity::warning);
  judge_limits(sub, fields, key);
}

/// Returns the number of an entry, or 0 if it is missing or unreadable.
std::uint32_t ObjectReader::read_count(const ObjectFields& fields, Keyword keyword,
                                       std::uint32_t highest) {
  const auto entry = fields.get(keyword);
  return entry ? values_.read_count(*entry, highest).value_or(0) : 0;
}

void ObjectReader::keep_reference(const ObjectFields& fields, std::uint16_t index,
                                  std::optional<std::uint8_t> sub) {
  const auto text = fields.text(Keyword::param_refd);
  if (!text.empty()) references_.push_back({index, sub, to_utf8(text)});
}

void ObjectReader::apply_lists(Object& object, const Parts& parts) {
  for (const auto list : {CompactList::names, CompactList::values, CompactList::denotations}) {
    const auto* section = parts.lists[static_cast<std::size_t>(list)];
    if (section == nullptr) continue;
    apply_compact_list(object, list, file_.entries(*section), values_, report_);
  }
}

}  // namespace takt
