#include "eds_parser/write/eds_fix.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "eds_parser/decimal_subs.hpp"
#include "eds_parser/eds.hpp"
#include "eds_parser/number.hpp"
#include "eds_parser/object_words.hpp"
#include "eds_parser/suggest.hpp"
#include "eds_parser/text.hpp"
#include "eds_parser/write/list_fix.hpp"
#include "eds_parser/write/value_fix.hpp"

namespace takt {
namespace {

constexpr int most_passes = 40;  // each rule speaks a thousand times at most in one

constexpr std::uint32_t most_keys = 256;  // of a section in which a key is looked for

constexpr std::array<std::string_view, 11> object_keys{
    "ParameterName", "DataType",   "ObjectType",    "AccessType",   "SubNumber",     "LowLimit",
    "HighLimit",     "PDOMapping", "CompactSubObj", "DefaultValue", "ParameterValue"};

/// Of these, slips are mended; what stands behind the others would begin to count then.
constexpr auto mended_keys = std::span{object_keys}.first<2>();

enum class Slips : std::uint8_t { mended, left };

/// One reading of the file and the edits that follow from its findings.
class FixPass {
 public:
  FixPass(std::string_view text, const IniFile& file, const EdsFile& eds, Slips slips)
      : text_{text},
        file_{file},
        eds_{eds},
        slips_{slips},
        sections_{file},
        edits_{text},
        lists_{text, file, sections_, edits_, touched_} {
    for (const IniSection& section : file.sections) {
      section_at_[section.pos.line] = &section;
      for (const IniEntry& entry : file.entries(section)) {
        entry_at_[entry.line] = {entry, &section};
      }
    }
  }

  /// Empty: nothing is left to mend.
  std::string run(Findings& fixed) {
    std::vector<const Finding*> rest;
    for (const Finding& finding : eds_.findings) {
      if (list_finding(finding)) {
        fixed.push_back(finding);
      } else {
        rest.push_back(&finding);
      }
    }
    lists_.run();
    for (const Finding* finding : rest) {
      if (mend(*finding)) fixed.push_back(*finding);
    }
    return edits_.any() ? std::move(edits_).apply() : std::string{};
  }

 private:
  struct Place {
    IniEntry entry;
    const IniSection* section = nullptr;
  };

  bool list_finding(const Finding& finding) {
    const std::uint32_t line = finding.pos.line;
    if (finding.rule == "listed-twice") {
      lists_.drop(line);
    } else if (finding.rule == "list-count-wrong" || finding.rule == "list-count-missing") {
      lists_.count(line);
    } else if (finding.rule == "list-numbers-gap") {
      lists_.renumber(line);
    } else if (finding.rule == "wrong-list" && entry_at_.contains(line)) {
      return lists_.move(entry_at_[line].entry);
    } else if (finding.rule == "object-not-listed" && section_at_.contains(line)) {
      lists_.add(classify_section(*section_at_[line]).index);
    } else {
      return false;
    }
    return true;
  }

  bool mend(const Finding& finding) {
    const std::string_view rule = finding.rule;
    if (rule == "byte-order-mark") return replace(text_.substr(0, 3), "");
    if (rule == "hash-comment") return hash_comment(finding.pos.line);
    const auto section = section_at_.find(finding.pos.line);
    if (section != section_at_.end()) return section_finding(finding, *section->second);
    const auto at = entry_at_.find(finding.pos.line);
    if (at == entry_at_.end() || touched_.contains(finding.pos.line)) return false;
    return entry_finding(rule, at->second);
  }

  bool replace(std::string_view part, std::string with) {
    edits_.replace(part, std::move(with));
    return true;
  }

  /// The line is known by its number alone.
  bool hash_comment(std::uint32_t line) {
    if (line_starts_.empty()) {
      line_starts_.push_back(0);
      for (std::size_t i = 0; i < text_.size(); ++i) {
        const bool pair = text_[i] == '\r' && text_.substr(i + 1).starts_with('\n');
        if (pair) ++i;
        if (pair || text_[i] == '\r' || text_[i] == '\n') line_starts_.push_back(i + 1);
      }
    }
    if (line == 0 || line > line_starts_.size()) return false;
    const std::size_t hash = text_.find('#', line_starts_[line - 1]);
    return hash != std::string_view::npos && replace(text_.substr(hash, 1), ";");
  }

  bool section_finding(const Finding& finding, const IniSection& section) {
    const std::string_view rule = finding.rule;
    if (rule == "section-spelling") {
      return touched_.insert(section.pos.line).second &&
             replace(section.name, "DeviceComissioning");
    }
    if (rule == "section-not-closed") {
      return touched_.insert(section.pos.line).second &&
             replace(section.name, std::string{section.name} + ']');
    }
    if (rule == "decimal-sub-index") return hexadecimal_subs();
    if (rule == "sub-number-missing") return sub_number(section, nullptr);
    if (rule == "inline-comment" || rule == "octal-number") return named_entry(finding, section);
    if (rule != "section-name-form") return false;
    const std::uint32_t line = section.pos.line;
    if (!touched_.insert(line).second) return done_.contains(line);  // both forms at once
    done_.insert(line);
    std::string name{section.name};
    if (name.starts_with("0x") || name.starts_with("0X")) name.erase(0, 2);
    const std::size_t sub = name.find_first_of("sS");
    const std::size_t digits = sub == std::string::npos ? sub : sub + 3;
    while (digits < name.size() - 1 && name[digits] == '0') name.erase(digits, 1);
    return replace(section.name, name);
  }

  /// All of the file or none: those that are left would no longer be taken for decimal.
  bool hexadecimal_subs() {
    if (subs_mended_) return *subs_mended_;
    const auto is_free = [this](const IniSection& section) {
      return !section.has_decimal_sub || !touched_.contains(section.pos.line);
    };
    subs_mended_ = std::ranges::all_of(file_.sections, is_free);
    for (const IniSection& section : file_.sections) {
      if (!*subs_mended_ || !section.has_decimal_sub) continue;
      const std::string_view start = section.name.substr(0, std::string_view{"2000sub"}.size());
      touched_.insert(section.pos.line);
      replace(section.name, std::string{start} + hex(classify_section(section).sub, 1).substr(2));
    }
    return *subs_mended_;
  }

  /// A finding at the section whose message begins with the key: `ObjectType: ...`.
  bool named_entry(const Finding& finding, const IniSection& section) {
    const std::string_view key = std::string_view{finding.message}.substr(
        0, std::min(finding.message.find(':'), finding.message.size()));
    if (section.count > most_keys) return false;
    for (const IniEntry& entry : file_.entries(section)) {
      if (classify_key(entry.key) == Keyword::unknown) continue;
      if (classify_key(entry.key) == classify_key(key)) {
        return value(finding.rule, {entry, &section});
      }
    }
    return false;
  }

  bool entry_finding(std::string_view rule, const Place& at) {
    if (rule == "blank-in-key") return touch(at) && replace(at.entry.key, "SupportedObjects");
    if (rule == "sub-number-wrong") return touch(at) && sub_number(*at.section, &at.entry);
    if (rule == "sub-number-missing") return touch(at) && sub_number(*at.section, &at.entry);
    if (rule == "compact-and-sub-number") return compact(at);
    if (rule == "baudrate-unit") return baudrate(at);
    if (rule == "unknown-key") return slip(at);
    if (rule == "wrong-list") return false;  // its object is not clear yet
    if (std::ranges::find(fixable_rules, rule) == fixable_rules.end()) return false;
    return value(rule, at);
  }

  bool touch(const Place& at) { return touched_.insert(at.entry.line).second; }

  /// Number of sections of sub-objects, as the reader counts them.
  std::size_t subs_of(std::uint16_t index) {
    if (subs_.empty()) {
      for (const IniSection& each : file_.sections) {
        const SectionName name = classify_section(each);
        const bool counts = name.kind == SectionKind::sub_object && name.sub != 0xFF;
        if (counts) subs_[name.index].insert(name.sub);
      }
    }
    const auto found = subs_.find(index);
    return found == subs_.end() ? 0 : found->second.size();
  }

  bool sub_number(const IniSection& section, const IniEntry* entry) {
    const std::string count = std::to_string(subs_of(classify_section(section).index));
    const std::string_view bare =
        entry == nullptr ? std::string_view{} : without_comment(entry->value);
    if (!bare.empty()) return replace(bare, count);
    if (entry != nullptr && same_word(entry->key, "subnumber")) return false;
    edits_.insert_line_after(sections_.last_line(section), "SubNumber=" + count);
    return true;
  }

  bool compact(const Place& at) {
    if (!same_word(at.entry.key, "subnumber") || !touch(at)) return false;
    return replace(without_comment(at.entry.value), "0");
  }

  bool baudrate(const Place& at) {
    const std::string_view bare = without_comment(at.entry.value);
    const auto rate = parse_number(bare);
    if (!rate || rate->magnitude % 1000 != 0 || !touch(at)) return false;
    return replace(bare, std::to_string(rate->magnitude / 1000));
  }

  /// A slip of a key that the section does not have: `AcessType`.
  bool slip(const Place& at) {
    const SectionName name = classify_section(*at.section);
    if (name.kind != SectionKind::object && name.kind != SectionKind::sub_object) return false;
    if (slips_ == Slips::left || at.section->count > most_keys) return false;
    if (at.entry.key.find_first_of("0123456789") != std::string_view::npos) return false;
    const std::string_view meant = nearest(at.entry.key, object_keys);
    if (std::ranges::find(mended_keys, meant) == mended_keys.end()) return false;
    for (const IniEntry& entry : file_.entries(*at.section)) {
      if (classify_key(entry.key) == classify_key(meant)) return false;
    }
    return touch(at) && replace(at.entry.key, std::string{meant});
  }

  bool value(std::string_view rule, const Place& at) {
    if (touched_.contains(at.entry.line)) return done_.contains(at.entry.line);
    const std::string_view bare = without_comment(at.entry.value);
    std::optional<std::string> plain;
    if (rule == "real-bit-pattern" || rule == "octet-string-form" || rule == "negative-unsigned") {
      plain = value_as_read(eds_.dictionary, *at.section, at.entry.key);
      if (rule == "octet-string-form") return plain && touch(at) && replace(at.entry.value, *plain);
    } else if (rule == "boolean-word") {
      plain = plain_flag(bare);
    } else if (rule == "hex-without-prefix" && in_list(*at.section)) {
      plain = "0x" + std::string{bare};
    } else if (const auto code = code_of_word(classify_key(at.entry.key), bare)) {
      plain = hex(*code, classify_key(at.entry.key) == Keyword::object_type ? 1 : 4);
    } else if (same_word(at.entry.key, "accesstype")) {
      plain = std::string{bare};
    } else {
      plain = plain_number(bare);
    }
    if (!plain || bare.empty()) return false;
    touch(at);
    done_.insert(at.entry.line);
    if (rule_keeps(rule, bare)) plain = std::string{bare};
    replace(at.entry.value, *plain);
    const std::string_view comment = trim(at.entry.value.substr(bare.size()));
    if (!comment.empty()) {
      edits_.insert_line_after(at.entry.value, "; " + std::string{trim(comment.substr(1))});
    }
    return true;
  }

  /// A comment goes, what stands before it stays as it is where it is sound.
  static bool rule_keeps(std::string_view rule, std::string_view bare) {
    if (rule != "inline-comment") return false;
    const auto number = parse_number(bare);
    return number && number->quirks == 0;
  }

  static bool in_list(const IniSection& section) {
    const SectionKind kind = classify_section(section).kind;
    return kind == SectionKind::mandatory_objects || kind == SectionKind::optional_objects ||
           kind == SectionKind::manufacturer_objects;
  }

  std::string_view text_;
  const IniFile& file_;
  const EdsFile& eds_;
  Slips slips_;
  SectionIndex sections_;
  TextEdits edits_;
  std::set<std::uint32_t> touched_;  ///< lines that have their edit
  std::set<std::uint32_t> done_;     ///< of these, values and names made plain for all findings
  ListFix lists_;
  std::map<std::uint32_t, const IniSection*> section_at_;
  std::map<std::uint32_t, Place> entry_at_;
  std::vector<std::size_t> line_starts_;
  std::map<std::uint16_t, std::set<std::uint8_t>> subs_;
  std::optional<bool> subs_mended_;  ///< sub-indices in decimal; none: not tried yet
};

bool same(const std::optional<Value>& old, const std::optional<Value>& now) {
  return old == now ||
         (old && now && std::holds_alternative<double>(*old));  // a NaN equals nothing
}

bool same(const SubObject& old, const SubObject& now) {
  if (old.access != now.access || old.pdo_mappable != now.pdo_mappable) return false;
  if (old.type == DataType::unknown && now.type != DataType::unknown) {
    return old.default_text == now.default_text && old.parameter_text == now.parameter_text;
  }
  return old.type == now.type && same(old.default_value, now.default_value) &&
         same(old.parameter_value, now.parameter_value) && same(old.low_limit, now.low_limit) &&
         same(old.high_limit, now.high_limit);
}

/// Nothing that was there is gone or another one. A type may appear where there was none.
bool keeps(const ObjectDictionary& before, const ObjectDictionary& after) {
  for (const Object& object : before.objects) {
    const Object* other = after.find(object.index);
    if (other == nullptr || other->type != object.type) return false;
    for (const SubObject& sub : object.subs) {
      const SubObject* now = after.find(ObjectKey{object.index, sub.sub});
      if (now == nullptr || !same(sub, *now)) return false;
    }
  }
  return true;
}

struct Pass {
  std::string text;
  Findings fixed;
  EdsFile eds;
};

/// One pass; none where nothing is left to mend, or the file would say something else.
std::optional<Pass> one_pass(const std::string& text, const std::string& source_name,
                             const EdsFile& eds, Slips slips) {
  Report ignored{source_name};
  IniFile file = read_ini(text, ignored);
  mark_decimal_subs(file, ignored);
  const std::string& source = file.recoded ? *file.recoded : text;
  Pass pass;
  pass.text = FixPass{source, file, eds, slips}.run(pass.fixed);
  if (pass.text.empty() && file.recoded) pass.text = source;
  if (pass.text.empty() || pass.text == text) return std::nullopt;
  pass.eds = read_eds(pass.text, source_name);
  if (!pass.eds.readable || !keeps(eds.dictionary, pass.eds.dictionary)) return std::nullopt;
  return pass;
}

}  // namespace

FixedEds fix_eds(std::string_view source, const std::string& source_name) {
  FixedEds out{.text = std::string{source}, .fixed = {}, .left = {}};
  EdsFile eds = read_eds(source, source_name);
  out.readable = eds.readable;
  for (int passes = 0; passes < most_passes && eds.readable; ++passes) {
    auto pass = one_pass(out.text, source_name, eds, Slips::mended);
    if (!pass) pass = one_pass(out.text, source_name, eds, Slips::left);
    if (!pass) break;
    out.text = std::move(pass->text);
    std::ranges::move(pass->fixed, std::back_inserter(out.fixed));
    eds = std::move(pass->eds);
  }
  out.left = std::move(eds.findings);
  return out;
}

}  // namespace takt
