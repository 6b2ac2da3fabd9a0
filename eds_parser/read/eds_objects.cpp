#include "eds_parser/read/eds_objects.hpp"

#include <algorithm>

#include "eds_parser/dictionary/standard_types.hpp"
#include "eds_parser/read/object_words.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/table/access_name.hpp"

namespace takt {
namespace {

bool is_structured(ObjectType type) noexcept {
  return type == ObjectType::array || type == ObjectType::record || type == ObjectType::defstruct;
}

std::string section_text(const IniSection& section) { return '[' + to_utf8(section.name) + ']'; }

std::uint32_t role_of(const SectionName& name) noexcept {
  switch (name.kind) {
    case SectionKind::sub_object:
      return ObjectSection::first_sub_role + name.sub;
    case SectionKind::name_list:
      return ObjectSection::first_list_role;
    case SectionKind::value_list:
      return ObjectSection::first_list_role + 1;
    case SectionKind::denotation_list:
      return ObjectSection::first_list_role + 2;
    default:
      return ObjectSection::main_role;
  }
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
    report_.warning(
        object.pos, "object-section-missing",
        "object " + hex(object.index) + " has sub-objects but no main section; read as a RECORD");
    read_subs(object, parts);
  } else {
    if (!read_main(object, parts)) return object;
  }
  apply_lists(object, parts);
  return object;
}

SubExtension ObjectReader::read_extension(const IniSection& section, std::uint16_t index) {
  const ObjectFields fields{file_.entries(section), section.name, report_};
  SubExtension extension;
  extension.count = fields.text(Keyword::module_count);
  extension.count_pos = fields.pos(Keyword::module_count, section.pos);
  read_sub(extension.pattern, fields, {index, 1}, section);
  const auto extend = values_.read_count(fields.text(Keyword::module_extend), 254, "ObjExtend",
                                         fields.pos(Keyword::module_extend, section.pos));
  extension.last_sub = extend.value_or(0);
  return extension;
}

bool ObjectReader::read_main(Object& object, const Parts& parts) {
  const auto& section = *parts.main;
  const ObjectFields fields{file_.entries(section), section.name, report_};
  object.name = to_utf8(fields.text(Keyword::parameter_name));
  if (object.name.empty()) {
    report_.warning(section.pos, "parameter-name-missing",
                    section_text(section) + " has no ParameterName");
  }
  object.type = read_object_type(fields, section, object.index, !parts.subs.empty());
  const auto compact =
      values_.read_count(fields.text(Keyword::compact_sub_obj), 0xFF, "CompactSubObj",
                         fields.pos(Keyword::compact_sub_obj, section.pos));
  if (compact.value_or(0) != 0 && !is_structured(object.type)) {
    report_.warning(fields.pos(Keyword::object_type, section.pos), "sub-objects-of-var",
                    "object " + hex(object.index) +
                        " is not an ARRAY or RECORD but has CompactSubObj; read as an ARRAY");
    object.type = ObjectType::array;
  }
  if (!is_structured(object.type)) {
    keep_reference(fields, object.index, 0);
    read_single(object, fields, section);
    return true;
  }
  keep_reference(fields, object.index, {});
  object.denotation = to_utf8(fields.text(Keyword::denotation));
  read_subs(object, parts);
  if (compact.value_or(0) != 0) return expand(object, fields, section, parts, *compact);
  check_sub_number(object, fields, section);
  return true;
}

void ObjectReader::read_single(Object& object, const ObjectFields& fields,
                               const IniSection& section) {
  read_sub(object.subs.emplace_back(), fields, {object.index, 0}, section);
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
    const ObjectFields fields{file_.entries(section), section.name, report_};
    if (!fields.has(Keyword::parameter_name)) {
      report_.warning(section.pos, "parameter-name-missing",
                      section_text(section) + " has no ParameterName");
    }
    const auto type_pos = fields.pos(Keyword::object_type, section.pos);
    // The result is not used; the call only reports how the key is written.
    read_object_type_code(fields, type_pos, values_, report_);
    keep_reference(fields, part.index(), part.sub());
    read_sub(object.subs.emplace_back(), fields, {part.index(), part.sub()}, section);
  }
}

bool ObjectReader::expand(Object& object, const ObjectFields& fields, const IniSection& section,
                          const Parts& parts, std::uint32_t count) {
  const auto pos = fields.pos(Keyword::compact_sub_obj, section.pos);
  if (!fields.has(Keyword::data_type) && standard_type({object.index, 1}) == DataType::unknown) {
    report_.error(pos, "compact-without-type",
                  section_text(section) +
                      " has CompactSubObj but no DataType; its sub-objects were left out");
    return true;
  }
  if (count > 0xFE) {
    report_.warning(pos, "compact-too-many", "CompactSubObj is at most 254; read as 254");
    count = 0xFE;
  }
  const bool fits = budget_.take(count + 1U);
  if (!fits && beyond_ == BeyondBudget::error) {
    report_.error(pos, "too-many-sub-objects",
                  "more than " + std::to_string(ExpansionBudget::most) +
                      " sub-objects by CompactSubObj; those of " + section_text(section) +
                      " were left out");
    return false;
  }
  if (!parts.subs.empty()) {
    report_.warning(pos, "compact-and-sections",
                    section_text(section) +
                        " has CompactSubObj and sections of sub-objects; the sections apply");
  } else if (const auto at = fields.pos(Keyword::sub_number, section.pos);
             values_.read_count(fields.text(Keyword::sub_number), 0xFF, "SubNumber", at)
                 .value_or(0) != 0) {
    report_.warning(at, "compact-and-sub-number",
                    "SubNumber is 0 or missing beside CompactSubObj; it was left out");
  }
  SubObject pattern;
  read_sub(pattern, fields, {object.index, 1}, section);
  if (fits) expand_compact_subs(object, pattern, static_cast<std::uint8_t>(count));
  return fits;
}

void ObjectReader::check_sub_number(const Object& object, const ObjectFields& fields,
                                    const IniSection& section) {
  const auto found = static_cast<std::size_t>(
      std::ranges::count_if(object.subs, [](const SubObject& sub) { return sub.sub != 0xFF; }));
  const auto pos = fields.pos(Keyword::sub_number, section.pos);
  if (object.subs.empty()) {
    report_.warning(section.pos, "no-sub-objects",
                    section_text(section) + " is an ARRAY or RECORD without sub-objects");
    return;
  }
  const auto declared =
      values_.read_count(fields.text(Keyword::sub_number), 0xFF, "SubNumber", pos);
  if (!declared) {
    report_.warning(pos, "sub-number-missing",
                    section_text(section) + " has no SubNumber; " + std::to_string(found) +
                        " sub-objects were found");
  } else if (*declared != found) {
    report_.warning(pos, "sub-number-wrong",
                    "SubNumber of " + section_text(section) + " is " + std::to_string(*declared) +
                        ", but there are sections of " + std::to_string(found) +
                        " sub-objects (sub FF not counted); all were read");
  }
}

ObjectType ObjectReader::read_object_type(const ObjectFields& fields, const IniSection& section,
                                          std::uint16_t index, bool has_subs) {
  const auto pos = fields.pos(Keyword::object_type, section.pos);
  const auto code = read_object_type_code(fields, pos, values_, report_);
  const bool known = code && (*code == 0 || *code == 2 || (*code >= 5 && *code <= 9));
  if (code && !known) {
    report_.warning(pos, "object-type-unknown",
                    "ObjectType " + hex(*code, 2) + " of " + section_text(section) +
                        " does not exist; read as a " + (has_subs ? "RECORD" : "VAR"));
  }
  const auto type = known ? static_cast<ObjectType>(*code) : ObjectType::var;
  if (!has_subs || is_structured(type)) return type;
  report_.warning(pos, "sub-objects-of-var",
                  "object " + hex(index) +
                      (known ? " is not an ARRAY or RECORD" : " has no ObjectType") +
                      " but has sub-objects; read as a RECORD");
  return ObjectType::record;
}

void ObjectReader::read_sub(SubObject& sub, const ObjectFields& fields, ObjectKey key,
                            const IniSection& section) {
  sub.sub = key.sub;
  sub.name = to_utf8(fields.text(Keyword::parameter_name));
  sub.pos = section.pos;
  sub.default_pos = fields.pos(Keyword::default_value, section.pos);
  read_type(sub, fields, key, section);
  sub.access = read_access(fields, key, section, sub.type == DataType::domain);
  if (const auto mapping = fields.get(Keyword::pdo_mapping)) {
    sub.pdo_mappable = values_.read_flag(mapping->value, "PDOMapping", mapping->pos());
    if (sub.pdo_mappable && is_bytes(sub.type) && sub.type != DataType::unknown) {
      report_.warning(mapping->pos(), "mappable-without-size",
                      to_string(key) + ": the size of " + std::string{name(sub.type)} +
                          " is not fixed, so PDOMapping should be 0");
    }
  }
  if (const auto flags = fields.get(Keyword::obj_flags)) {
    sub.flags = values_.read_count(flags->value, 0xFFFF'FFFF, "ObjFlags", flags->pos()).value_or(0);
  }
  read_values(sub, fields, key, section);
  if (fields.has(Keyword::upload_file) || fields.has(Keyword::download_file)) {
    domain_files_.push_back(
        {key, to_utf8(fields.text(Keyword::upload_file)),
         to_utf8(fields.text(Keyword::download_file)),
         fields.pos(Keyword::download_file, fields.pos(Keyword::upload_file, section.pos))});
  }
}

void ObjectReader::read_type(SubObject& sub, const ObjectFields& fields, ObjectKey key,
                             const IniSection& section) {
  const auto pos = fields.pos(Keyword::data_type, section.pos);
  const auto code = read_data_type_code(fields, pos, values_, report_);
  if (code) {
    sub.type_code = static_cast<std::uint16_t>(*code);
    sub.type = data_type_of(*code);
    if (sub.type == DataType::unknown && report_.wants("data-type-unknown")) {
      report_.warning(pos, "data-type-unknown",
                      to_string(key) + ": DataType " + hex(*code) +
                          " is not one of CiA 301; values are kept as text");
    }
    const auto wanted = standard_type(key);
    if (wanted != DataType::unknown && wanted != sub.type && sub.type != DataType::unknown) {
      report_.warning(pos, "standard-type",
                      to_string(key) + ": DataType is " + std::string{name(sub.type)} +
                          ", but CiA 301 requires " + std::string{name(wanted)});
    }
    return;
  }
  const bool is_domain = is_domain_object(fields);
  sub.type = is_domain ? DataType::domain : standard_type(key);
  sub.type_code = static_cast<std::uint16_t>(sub.type);
  if (is_domain) return;
  report_.warning(section.pos, "data-type-missing",
                  section_text(section) + " has no DataType; " +
                      (sub.type == DataType::unknown
                           ? "the object is kept without a type"
                           : "read as " + std::string{name(sub.type)} + ", as in CiA 301"));
}

Access ObjectReader::read_access(const ObjectFields& fields, ObjectKey key,
                                 const IniSection& section, bool is_domain) {
  const auto text = fields.text(Keyword::access_type);
  if (const auto access = access_of_word(text)) return *access;
  const auto pos = fields.pos(Keyword::access_type, section.pos);
  const auto bare = without_comment(text);
  if (const auto access = access_of_word(bare)) {
    report_.warning(pos, "inline-comment",
                    to_string(key) + " AccessType: text behind ';' or '#' was read as a comment");
    return *access;
  }
  const auto announce = [&](std::string_view rule, const std::string& what) {
    report_.warning(pos, rule, to_string(key) + ": AccessType " + what);
  };
  if (const auto access = access_of_letter(bare)) {
    announce("access-type-letter",
             quoted(bare) + " was read as " + std::string{access_name(*access)});
    return *access;
  }
  if (!bare.empty()) announce("access-type-unknown", quoted(bare) + " is unknown; read as rw");
  if (bare.empty() && !is_domain) announce("access-type-missing", "is missing; read as rw");
  return Access::rw;
}

void ObjectReader::read_values(SubObject& sub, const ObjectFields& fields, ObjectKey key,
                               const IniSection& section) {
  const auto read = [&](Keyword keyword, std::string_view what, Severity misfit,
                        Severity unreadable = Severity::warning) {
    const auto text = fields.text(keyword);
    if (text.empty()) return std::optional<Value>{};
    return values_.read(text, sub.type, {key, what, fields.pos(keyword, {}), misfit, unreadable});
  };
  sub.default_value = read(Keyword::default_value, "DefaultValue", Severity::error);
  sub.default_text = to_utf8(fields.text(Keyword::default_value));
  if (fields.has(Keyword::parameter_value)) {
    sub.parameter_value =
        read(Keyword::parameter_value, "ParameterValue", Severity::error, Severity::error);
    sub.parameter_text = to_utf8(fields.text(Keyword::parameter_value));
    sub.parameter_pos = fields.pos(Keyword::parameter_value, section.pos);
  }
  if (fields.has(Keyword::denotation)) sub.denotation = to_utf8(fields.text(Keyword::denotation));
  sub.low_limit = read(Keyword::low_limit, "LowLimit", Severity::warning);
  sub.high_limit = read(Keyword::high_limit, "HighLimit", Severity::warning);
  judge_limits(sub, fields, key, section);
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
