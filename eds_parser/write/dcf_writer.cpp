#include "eds_parser/write/dcf_writer.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/ini/decimal_subs.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/write/object_sections.hpp"
#include "eds_parser/write/section_index.hpp"
#include "eds_parser/write/text_edits.hpp"

namespace takt {
namespace {

constexpr std::uint32_t refuse_write = 1;  // ObjFlags, bit 0

std::string_view base_name(std::string_view path) noexcept {
  const auto slash = path.rfind('/');
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

/// Returns the values by object. If an object has two values, the later one counts.
std::map<ObjectKey, const DcfValue*> last_values(const DcfOptions& options) {
  std::map<ObjectKey, const DcfValue*> last;
  for (const auto& value : options.values) last[value.object] = &value;
  return last;
}

bool is_file(const DcfValue& value, const SubObject& sub) {
  return sub.type == DataType::domain && value.text.starts_with('@');
}

class DcfWriter {
 public:
  DcfWriter(const IniFile& file, std::string_view text, const ObjectDictionary& dictionary,
            const DcfOptions& options, Report& report)
      : sections_{file},
        edits_{text},
        dictionary_{dictionary},
        options_{options},
        report_{report},
        values_{report, options.node ? options.node : dictionary.node_id} {}

  std::string write() {
    for (const auto& [object, value] : last_values(options_)) write_value(*value);
    write_new_lists();
    write_implied_objects();
    write_file_info();
    write_commissioning();
    return std::move(edits_).apply();
  }

 private:
  void write_value(const DcfValue& value) {
    const auto* sub = dictionary_.find(value.object);
    if (sub == nullptr) {
      refuse({}, "unknown-object", value.object, " is not an object of ", dictionary_.file);
    } else if (!allowed(value, *sub)) {
      return;
    } else if (is_file(value, *sub)) {
      place(value.object, "DownloadFile", value.text.substr(1));
    } else if (good(value, *sub)) {
      place(value.object, "ParameterValue", value.text);
    }
  }

  bool allowed(const DcfValue& value, const SubObject& sub) {
    if (!sub.is_writable()) {
      return refuse(sub.pos, "read-only", value.object, ' ', sub.name,
                    " is read-only: the device would refuse the value");
    }
    if ((sub.flags & refuse_write) != 0) {
      return refuse(sub.pos, "refuses-write", value.object, ' ', sub.name,
                    " is not to be written by a configuration (ObjFlags bit 0)");
    }
    if (value.text.find_first_of("\r\n") != std::string::npos) {
      return refuse(sub.pos, "line-break", value.object, ' ', sub.name,
                    ": a value can't hold a line break");
    }
    return true;
  }

  /// Returns whether the device would accept the value. The value is read as it will be read from
  /// the written DCF.
  bool good(const DcfValue& value, const SubObject& sub) {
    if (trim(value.text).size() != value.text.size()) {
      return refuse(sub.pos, "outer-blanks", value.object,
                    ": blanks around a value are lost in a DCF");
    }
    const auto read =
        values_.read(value.text, sub.type, {value.object, "new value", sub.pos, Severity::error});
    if (!read) {
      const auto number = parse_number(value.text);
      const bool needs_node =
          number && number->relative() && !options_.node && !dictionary_.node_id;
      return refuse(sub.pos, "value-unreadable", value.object, ": ", Quoted{value.text},
                    " is not a value of ", sub.type, needs_node ? ": $NODEID needs --node" : "");
    }
    if (!outside_limits(*read, sub)) return true;
    const auto limit = [&](const std::optional<Value>& end) {
      return end ? eds_value_text(*end, sub.type) : std::string{"any"};
    };
    return refuse(sub.pos, "value-outside-limits", value.object, ": ", value.text, " lies outside ",
                  limit(sub.low_limit), "..", limit(sub.high_limit),
                  ": the device would refuse it");
  }

  /// Writes a value. Its place depends on how the file describes the object.
  void place(ObjectKey key, std::string_view keyword, std::string text) {
    const auto* own = sections_.sub_object(key);
    const auto* main = sections_.object(key.index);
    const auto* object = dictionary_.find(key.index);
    const bool single = object->type == ObjectType::var || object->type == ObjectType::domain;
    if (own == nullptr && single && key.sub == 0) own = main;
    const auto* list = sections_.value_list(key.index);
    const bool in_list = list != nullptr && sections_.list_entry(*list, key.sub);
    if (in_list && keyword == "ParameterValue") {
      place_in_list(key, std::move(text));  // the list has priority over a section
    } else if (own != nullptr) {
      set(*own, keyword, std::move(text));
    } else if (main != nullptr && sections_.entry(*main, "compactsubobj")) {
      place_in_list(key, std::move(text));
    } else {
      implied_[key.index][key.sub] = std::string{keyword} + '=' + text;
    }
  }

  /// Sets one key of a section. A comment behind the old value stays.
  void set(const IniSection& section, std::string_view key, std::string text) {
    std::string lower{key};
    std::ranges::transform(lower, lower.begin(), fold);
    const auto entry = sections_.entry(section, lower);
    if (!entry) {
      const auto beside = sections_.entry(section, "defaultvalue");
      const auto anchor = !beside                 ? sections_.last_line(section)
                          : beside->value.empty() ? beside->key
                                                  : beside->value;
      edits_.insert_line_after(anchor, std::string{key} + '=' + text);
      return;
    }
    const auto bare = without_comment(entry->value);
    const auto old = parse_number(bare) ? bare : entry->value;  // a text may hold a `;`
    if (old != text) edits_.replace(old, std::move(text));
  }

  void place_in_list(ObjectKey key, std::string text) {
    const auto* list = sections_.value_list(key.index);
    const auto entry = list == nullptr ? std::nullopt : sections_.list_entry(*list, key.sub);
    if (entry) {
      edits_.replace(entry->value, std::move(text));
    } else {
      list_entries_[key.index].push_back(std::to_string(key.sub) + '=' + text);
    }
  }

  void write_new_lists() {
    for (const auto& [index, lines] : list_entries_) {
      const auto* list = sections_.value_list(index);
      if (list == nullptr) {
        const auto anchor = sections_.last_line(*sections_.object(index));
        edits_.insert_line_after(anchor, "");
        edits_.insert_line_after(anchor, '[' + hex(index).substr(2) + "Value]");
        edits_.insert_line_after(anchor, "NrOfEntries=" + std::to_string(lines.size()));
        for (const auto& line : lines) edits_.insert_line_after(anchor, line);
        continue;
      }
      add_to_count(*list, "nrofentries", lines.size());
      for (const auto& line : lines) edits_.insert_line_after(sections_.last_line(*list), line);
    }
  }

  void add_to_count(const IniSection& section, std::string_view lower_key, std::size_t more) {
    const auto count = sections_.entry(section, lower_key);
    if (!count) return;
    const auto before = parse_number(count->value);
    edits_.replace(count->value, std::to_string((before ? before->magnitude : 0) + more));
  }

  void write_implied_objects() {
    if (!dictionary_.is_dcf) keep_pdos_on();
    add_pdo_partners();
    keep_parameter_values();
    for (const auto& [index, values] : implied_) {
      const auto& object = *dictionary_.find(index);
      const auto* main = sections_.object(index);
      if (main == nullptr) list_object(object);
      const std::size_t added = append_sections(object, values);
      if (main != nullptr) add_to_count(*main, "subnumber", added);
    }
  }

  /// Appends the missing sections of an object. Existing sections stay. Returns the number of new
  /// sub-objects.
  std::size_t append_sections(const Object& object,
                              const std::map<std::uint8_t, std::string>& values) {
    std::size_t added = 0;
    bool there = false;
    std::uint8_t sub = 0;
    for (const auto& line : object_sections(object)) {
      if (line.starts_with('[')) {
        const auto name = classify_section(std::string_view{line}.substr(1, line.size() - 2));
        const bool of_sub = name.kind == SectionKind::sub_object;
        sub = name.sub;
        there = (of_sub ? sections_.sub_object({object.index, sub})
                        : sections_.object(object.index)) != nullptr;
        if (!there) edits_.append_line("");
        added += of_sub && !there;
      }
      if (there || line.empty()) continue;
      edits_.append_line(line);
      if (!line.starts_with("DefaultValue=")) continue;
      const auto value = values.find(sub);
      if (value != values.end()) edits_.append_line(value->second);
    }
    return added;
  }

  /// Writes out valid PDOs that are only implied. In a DCF a PDO that is not listed is off, whereas
  /// in an EDS its default applies. CiA 306, 5.3.3.1.
  void keep_pdos_on() {
    for (const auto& pdo : describe_pdos(dictionary_)) {
      const auto index = pdo.communication_index();
      if (pdo.valid && sections_.object(index) == nullptr) implied_[index];
    }
  }

  void keep_parameter_values() {
    for (auto& [index, values] : implied_) {
      for (const auto& sub : dictionary_.find(index)->subs) {
        if (sub.parameter_text.empty()) continue;
        values.try_emplace(sub.sub, "ParameterValue=" + sub.parameter_text);
      }
    }
  }

  /// Adds the other record of a PDO that CompactPDO implies: communication and mapping are only
  /// valid together.
  void add_pdo_partners() {
    std::vector<std::uint16_t> partners;
    for (const auto& [index, values] : implied_) {
      if (!is_pdo_parameter(index)) continue;
      const auto partner = static_cast<std::uint16_t>(index ^ 0x200U);
      const bool implied = dictionary_.find(partner) != nullptr && !sections_.object(partner);
      if (implied) partners.push_back(partner);
    }
    for (const auto partner : partners) implied_[partner];
  }

  void list_object(const Object& object) {
    const bool manufacturer = object.index >= 0x2000 && object.index < 0x6000;
    const auto* list = sections_.other(manufacturer ? SectionKind::manufacturer_objects
                                                    : SectionKind::optional_objects);
    if (list == nullptr) return;
    auto& more = listed_[list];
    const auto count = sections_.entry(*list, "supportedobjects");
    const auto number = parse_number(count ? count->value : "0");
    const auto next = (number ? number->magnitude : 0) + ++more;
    edits_.insert_line_after(sections_.last_line(*list),
                             std::to_string(next) + '=' + hex(object.index));
  }

  void write_file_info() {
    for (const auto& [list, more] : listed_) add_to_count(*list, "supportedobjects", more);
    const auto* info = sections_.other(SectionKind::file_info);
    if (info == nullptr) return;
    if (!options_.out_name.empty())
      set(*info, "FileName", std::string{base_name(options_.out_name)});
    if (!dictionary_.is_dcf) set(*info, "LastEDS", std::string{base_name(dictionary_.file)});
  }

  void write_commissioning() {
    const auto* section = sections_.other(SectionKind::commissioning);
    bool begun = false;
    const auto write = [&](std::string_view key, std::string text) {
      if (section != nullptr) return set(*section, key, std::move(text));
      if (!std::exchange(begun, true)) {
        edits_.append_line("");
        edits_.append_line("[DeviceComissioning]");
      }
      edits_.append_line(concat(key, '=', text));
    };
    if (options_.node) write("NodeID", std::to_string(options_.node->value()));
    if (!options_.node_name.empty()) write("NodeName", options_.node_name);
    if (options_.baudrate_kbit) write("Baudrate", std::to_string(*options_.baudrate_kbit));
  }

  template <class... Parts>
  bool refuse(SourcePos pos, std::string_view rule, const Parts&... message) {
    report_.error(pos, rule, message...);
    return false;
  }

  SectionIndex sections_;
  TextEdits edits_;
  const ObjectDictionary& dictionary_;
  const DcfOptions& options_;
  Report& report_;
  ValueReader values_;
  std::map<std::uint16_t, std::vector<std::string>> list_entries_;  ///< [xxxxValue], by index
  std::map<std::uint16_t, std::map<std::uint8_t, std::string>> implied_;
  std::map<const IniSection*, std::size_t> listed_;  ///< objects added to each list
};

bool holds(const ObjectDictionary& dictionary, const DcfValue& value) {
  const auto* sub = dictionary.find(value.object);
  if (sub == nullptr) return false;
  if (is_file(value, *sub)) {
    return std::ranges::any_of(dictionary.domain_files, [&](const DomainFiles& files) {
      return files.key == value.object && files.download == value.text.substr(1);
    });
  }
  Report ignored{dictionary.file};
  const ValuePlace place{.key = value.object, .what = "new value", .pos = {}};
  const auto wanted = ValueReader{ignored, dictionary.node_id}.read(value.text, sub->type, place);
  return wanted && sub->parameter_value &&
         to_bytes(*wanted, sub->type) == to_bytes(*sub->parameter_value, sub->type);
}

/// Reads the written text to confirm the values, because a file may hold a value in several places.
void confirm(const std::string& text, const ObjectDictionary& before, const DcfOptions& options,
             Report& report) {
  if (options.values.empty()) return;
  const auto node = options.node ? options.node : before.node_id;
  const auto written = read_eds(text, before.file, node).dictionary;
  for (const auto& [object, value] : last_values(options)) {
    if (holds(written, *value)) continue;
    report.error(before.find(object)->pos, "value-not-set", object,
                 ": the file gives the value on another line than the one that takt would "
                 "change; correct that line by hand");
  }
}

}  // namespace

DcfText write_dcf(std::string_view source, const std::string& source_name,
                  const DcfOptions& options) {
  const auto eds = read_eds(source, source_name, options.node);
  if (!eds.readable) return {{}, eds.findings};
  Report ignored{source_name};
  auto file = read_ini(source, ignored);
  mark_decimal_subs(file, ignored);
  Report report{source_name};
  const std::string_view text = file.recoded ? std::string_view{*file.recoded} : source;
  DcfText result;
  result.text = DcfWriter{file, text, eds.dictionary, options, report}.write();
  result.findings = report.take();
  if (!has_error(result.findings)) {
    confirm(result.text, eds.dictionary, options, report);
    std::ranges::move(report.take(), std::back_inserter(result.findings));
  }
  if (has_error(result.findings)) result.text.clear();
  return result;
}

}  // namespace takt
