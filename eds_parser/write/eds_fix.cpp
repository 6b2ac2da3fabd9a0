#include "eds_parser/write/eds_fix.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "eds_parser/ini/decimal_subs.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/report/suggest.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/write/changed_objects.hpp"
#include "eds_parser/write/entry_counts.hpp"
#include "eds_parser/write/list_fix.hpp"
#include "eds_parser/write/value_fix.hpp"

namespace takt {
namespace {

constexpr int most_passes = 40;  // in one pass each rule reports a thousand findings at most

constexpr int most_tries = 8;  // in one pass; each try leaves more objects unchanged

constexpr std::uint32_t most_keys = 256;  // largest section in which a missing key is searched

constexpr std::array<std::string_view, 11> object_keys{
    "ParameterName", "DataType",   "ObjectType",    "AccessType",   "SubNumber",     "LowLimit",
    "HighLimit",     "PDOMapping", "CompactSubObj", "DefaultValue", "ParameterValue"};

/// Misspellings of these keys are mended. With the other keys, values that had no effect before
/// would take effect.
constexpr auto corrected_keys = std::span{object_keys}.first<2>();

/// The errors of an object that stay in the file, because a correction would change the meaning of
/// the file.
enum class Left : std::uint8_t { slips, all };

using LeftObjects = std::map<std::uint16_t, Left>;

/// One reading of the file and the edits that follow from its findings.
class FixPass {
 public:
  FixPass(std::string_view text, const IniFile& file, const EdsFile& eds, const LeftObjects& left)
      : text_{text},
        file_{file},
        eds_{eds},
        left_{left},
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

  /// Returns the mended text, or an empty text if there is nothing left to mend.
  std::string run(Findings& fixed) {
    std::vector<const Finding*> rest;
    for (const Finding& finding : eds_.findings) {
      rules_at_[finding.pos.line].insert(finding.rule);
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
    if (section != section_at_.end()) {
      return !is_left(*section->second, rule) && section_finding(finding, *section->second);
    }
    const auto at = entry_at_.find(finding.pos.line);
    if (at == entry_at_.end() || is_left(*at->second.section, rule)) return false;
    if (touched_.contains(finding.pos.line)) {
      return done_.contains(finding.pos.line) && is_value_rule(rule);
    }
    return entry_finding(rule, at->second);
  }

  /// Returns whether a finding is left as it is. This is the case for most findings on modules: the
  /// objects of a module that is not connected are not in the dictionary, so nothing shows whether
  /// an edit would change them.
  bool is_left(const IniSection& section, std::string_view rule) const {
    const SectionName name = classify_section(section);
    if (name.kind == SectionKind::module) {
      return rule != "entry-count-wrong" && rule != "section-not-closed";
    }
    if (name.index == 0) return false;
    const auto left = left_.find(name.index);
    return left != left_.end() && left->second == Left::all;
  }

  bool replace(std::string_view part, std::string with) {
    edits_.replace(part, std::move(with));
    return true;
  }

  /// Mends a `#` comment. Only the number of its line is known.
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
      return touch(section.pos.line) && replace(section.name, "DeviceComissioning");
    }
    if (rule == "section-not-closed") {
      return touch(section.pos.line) && replace(section.name, concat(section.name, ']'));
    }
    if (rule == "decimal-sub-index") return hexadecimal_subs();
    if (rule == "sub-number-missing") return sub_number(section, nullptr);
    if (rule != "section-name-form") return false;
    const std::uint32_t line = section.pos.line;
    if (!touch(line)) return done_.contains(line);  // one edit mends both findings
    done_.insert(line);
    std::string name{section.name};
    if (is_prefixed_hex(name)) name.erase(0, 2);
    const std::size_t sub = name.find_first_of("sS");
    const std::size_t digits = sub == std::string::npos ? sub : sub + 3;
    while (digits < name.size() - 1 && name[digits] == '0') name.erase(digits, 1);
    return replace(section.name, name);
  }

  /// Mends either all decimal sub-indices of the file or none, because remaining ones would no
  /// longer be read as decimal.
  bool hexadecimal_subs() {
    if (subs_mended_) return *subs_mended_;
    const auto is_free = [this](const IniSection& section) {
      return !section.has_decimal_sub ||
             (!touched_.contains(section.pos.line) && !is_left(section, "decimal-sub-index"));
    };
    subs_mended_ = std::ranges::all_of(file_.sections, is_free);
    for (const IniSection& section : file_.sections) {
      if (!*subs_mended_ || !section.has_decimal_sub) continue;
      const std::string_view start = section.name.substr(0, std::string_view{"2000sub"}.size());
      touch(section.pos.line);
      replace(section.name, concat(start, hex(classify_section(section).sub, 1).substr(2)));
    }
    return *subs_mended_;
  }

  bool entry_finding(std::string_view rule, const Place& at) {
    if (rule == "blank-in-key") return touch(at) && replace(at.entry.key, "SupportedObjects");
    if (rule == "sub-number-wrong" || rule == "sub-number-missing")
      return touch(at) && sub_number(*at.section, &at.entry);
    if (rule == "compact-and-sub-number") return compact(at);
    if (rule == "baudrate-unit") return baudrate(at);
    if (rule == "entry-count-wrong" || rule == "module-count") return entry_count(at);
    if (rule == "unknown-key") return slip(at);
    return is_value_rule(rule) && value(at);
  }

  /// Marks a line as edited. Returns false if it already has an edit.
  bool touch(std::uint32_t line) { return touched_.insert(line).second; }
  bool touch(const Place& at) { return touch(at.entry.line); }

  /// Returns the number of sub-object sections, as the reader counts them.
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

  bool entry_count(const Place& at) {
    const auto number = counted_entries(file_, *at.section);
    if (!number || !touch(at)) return false;
    return replace(without_comment(at.entry.value), std::to_string(*number));
  }

  bool baudrate(const Place& at) {
    const std::string_view bare = without_comment(at.entry.value);
    const auto rate = parse_number(bare);
    if (!rate || rate->magnitude % 1000 != 0 || !touch(at)) return false;
    return replace(bare, std::to_string(rate->magnitude / 1000));
  }

  /// Mends a misspelling of a key that the section does not have, such as `AcessType`.
  bool slip(const Place& at) {
    const SectionName name = classify_section(*at.section);
    if (name.kind != SectionKind::object && name.kind != SectionKind::sub_object) return false;
    if (left_.contains(name.index) || at.section->count > most_keys) return false;
    if (at.entry.key.find_first_of("0123456789") != std::string_view::npos) return false;
    const std::string_view meant = nearest(at.entry.key, object_keys);
    if (std::ranges::find(corrected_keys, meant) == corrected_keys.end()) return false;
    for (const IniEntry& entry : file_.entries(*at.section)) {
      if (classify_key(entry.key) == classify_key(meant)) return false;
    }
    return touch(at) && replace(at.entry.key, std::string{meant});
  }

  bool value(const Place& at) {
    const std::string_view bare = without_comment(at.entry.value);
    const auto& rules = rules_at_[at.entry.line];
    const auto plain = plain_value(eds_.dictionary, *at.section, at.entry, rules);
    if (!plain || bare.empty()) return false;
    touch(at);
    done_.insert(at.entry.line);
    replace(at.entry.value, *plain);
    const std::string_view comment = trim(at.entry.value.substr(bare.size()));
    if (!comment.empty()) {
      edits_.insert_line_after(at.entry.value, "; " + std::string{trim(comment.substr(1))});
    }
    return true;
  }

  std::string_view text_;
  const IniFile& file_;
  const EdsFile& eds_;
  const LeftObjects& left_;
  SectionIndex sections_;
  TextEdits edits_;
  std::set<std::uint32_t> touched_;  ///< lines that already have an edit
  std::set<std::uint32_t> done_;     ///< objects whose edit mends all their findings
  ListFix lists_;
  std::map<std::uint32_t, const IniSection*> section_at_;
  std::map<std::uint32_t, Place> entry_at_;
  std::map<std::uint32_t, std::set<std::string_view>> rules_at_;
  std::vector<std::size_t> line_starts_;
  std::map<std::uint16_t, std::set<std::uint8_t>> subs_;
  std::optional<bool> subs_mended_;  ///< decimal sub-indices were mended; empty = not tried yet
};

/// Adds objects to those that are left unchanged. Returns false if all of them were left already.
bool leave(const std::set<std::uint16_t>& objects, LeftObjects& left) {
  bool more = false;
  for (const std::uint16_t index : objects) {
    const auto [at, is_new] = left.try_emplace(index, Left::slips);
    more = more || is_new || at->second != Left::all;
    if (!is_new) at->second = Left::all;
  }
  return more;
}

struct Pass {
  std::string text;
  Findings fixed;
  EdsFile eds;
};

/// Runs one pass. Returns std::nullopt if nothing is left to mend, or if mending would change the
/// meaning of the file.
std::optional<Pass> one_pass(const std::string& text, const std::string& source_name,
                             const EdsFile& eds, LeftObjects& left) {
  Report ignored{source_name};
  IniFile file = read_ini(text, ignored);
  mark_decimal_subs(file, ignored);
  const std::string& source = file.recoded ? *file.recoded : text;
  for (int tries = 0; tries < most_tries; ++tries) {
    Pass pass;
    pass.text = FixPass{source, file, eds, left}.run(pass.fixed);
    if (pass.text.empty() && file.recoded) pass.text = source;
    if (pass.text.empty() || pass.text == text) return std::nullopt;
    pass.eds = read_eds(pass.text, source_name);
    if (!pass.eds.readable) return std::nullopt;
    const auto changed = changed_objects(eds.dictionary, pass.eds.dictionary);
    if (changed.empty()) return pass;
    if (!leave(changed, left)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

FixedEds fix_eds(std::string_view source, const std::string& source_name) {
  FixedEds out{.text = std::string{source}, .fixed = {}, .left = {}};
  EdsFile eds = read_eds(source, source_name);
  out.readable = eds.readable;
  LeftObjects left;
  for (int passes = 0; passes < most_passes && eds.readable; ++passes) {
    auto pass = one_pass(out.text, source_name, eds, left);
    if (!pass) break;
    out.text = std::move(pass->text);
    std::ranges::move(pass->fixed, std::back_inserter(out.fixed));
    eds = std::move(pass->eds);
  }
  out.left = std::move(eds.findings);
  return out;
}

}  // namespace takt
