#include "apps/logic/rules.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <utility>

#include "apps/command_line/duration.hpp"
#include "eds_parser/network_file/yaml/yaml_tree.hpp"
#include "eds_parser/report/report.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

/// A key of a rule, and the kinds of rules that may have it.
struct Key {
  std::string_view name;
  bool of_set;
  bool of_latch;
  bool of_count;
};
constexpr std::array<Key, 11> keys{{{"set", true, false, false},
                                    {"latch", false, true, false},
                                    {"count", false, false, true},
                                    {"when", true, false, true},
                                    {"on", false, true, false},
                                    {"off", false, true, false},
                                    {"reset", false, false, true},
                                    {"on_delay", true, false, false},
                                    {"off_delay", true, false, false},
                                    {"value", true, true, false},
                                    {"else", true, true, false}}};

bool fits(const Key& key, RuleKind kind) {
  if (kind == RuleKind::set) return key.of_set;
  return kind == RuleKind::latch ? key.of_latch : key.of_count;
}

class Reader {
 public:
  Reader(const std::string& file, Findings& findings) : report_{file}, findings_{findings} {}
  ~Reader() {
    for (Finding& finding : report_.take()) findings_.push_back(std::move(finding));
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  std::vector<Rule> read(const YamlNode& root) {
    const YamlNode* list = root.find("rules");
    if (list == nullptr || list->kind != YamlNode::Kind::sequence || root.pairs.size() != 1) {
      report_.error(root.pos, "logic-file", "a file of takt-logic is a list under `rules:`");
      return {};
    }
    if (list->items.size() > most_rules) {
      report_.error(list->pos, "logic-file", "there are more than 1000 rules");
      return {};
    }
    if (list->items.empty()) report_.error(list->pos, "logic-file", "there is no rule");
    for (const YamlNode* item : list->items) read_rule(*item);
    return std::move(rules_);
  }

 private:
  void read_rule(const YamlNode& node) {
    if (node.kind != YamlNode::Kind::map) {
      report_.error(node.pos, "rule", "a rule is a map such as `{set: io.lamp, when: io.button}`");
      return;
    }
    Rule rule;
    const YamlNode* target = nullptr;
    for (const auto& [name, kind] :
         {std::pair{"set", RuleKind::set}, std::pair{"latch", RuleKind::latch},
          std::pair{"count", RuleKind::count}}) {
      const YamlNode* found = node.find(name);
      if (found == nullptr) continue;
      if (target != nullptr) {
        report_.error(found->pos, "rule", "a rule has one of `set`, `latch` and `count`");
        return;
      }
      target = found;
      rule.kind = kind;
    }
    if (target == nullptr) {
      report_.error(node.pos, "rule", "one of `set`, `latch` and `count` is missing");
      return;
    }
    check_keys(node, rule.kind);
    read_target(rule, *target);
    read_first(rule, node, rule.kind == RuleKind::latch ? "on" : "when");
    read_second(rule, node, rule.kind == RuleKind::count ? "reset" : "off");
    read_delay(node, "on_delay", rule.on_delay);
    read_delay(node, "off_delay", rule.off_delay);
    read_value(node, "value", rule.on_value);
    read_value(node, "else", rule.off_value);
    rules_.push_back(std::move(rule));
  }

  void check_keys(const YamlNode& node, RuleKind kind) {
    std::vector<std::string_view> names;
    for (const Key& key : keys) {
      if (fits(key, kind)) names.push_back(key.name);
    }
    for (const YamlPair& pair : node.pairs) {
      if (std::ranges::find(names, pair.key) != names.end()) continue;
      report_.error(pair.key_pos, "unknown-key", "a rule of this kind has no `", pair.key, "`",
                    did_you_mean(pair.key, names));
    }
  }

  void read_target(Rule& rule, const YamlNode& node) {
    rule.target = node.text;
    rule.pos = node.pos;
    if (node.kind != YamlNode::Kind::scalar || !is_name(node.text)) {
      report_.error(node.pos, "target",
                    "the target is an output such as `io.write_output.3`, or a marker such as "
                    "`armed`");
      return;
    }
    if (rule.kind == RuleKind::count && rule.target.contains('.')) {
      report_.error(node.pos, "target", "`count` needs a marker: a name without a point");
    }
    const auto [before, is_new] = targets_.emplace(rule.target, node.pos.line);
    if (is_new) return;
    report_.error(node.pos, "target", "line ", std::to_string(before->second), " sets `",
                  rule.target, "` already: each target has one rule");
  }

  void read_first(Rule& rule, const YamlNode& node, const char* key) {
    const YamlNode* found = node.find(key);
    if (found == nullptr) {
      report_.error(node.pos, "rule", "`", std::string_view{key}, "` is missing");
      return;
    }
    rule.first = read_expression(*found);
  }

  void read_second(Rule& rule, const YamlNode& node, const char* key) {
    if (rule.kind == RuleKind::set) return;
    const YamlNode* found = node.find(key);
    if (found != nullptr) {
      rule.second = read_expression(*found);
    } else if (rule.kind == RuleKind::latch) {
      report_.error(node.pos, "rule",
                    "`off` is missing: a latch needs an expression that resets it");
    }
  }

  WrittenExpression read_expression(const YamlNode& node) {
    WrittenExpression written{.text = node.text, .pos = node.pos, .expression = {}};
    if (node.kind != YamlNode::Kind::scalar) {
      report_.error(node.pos, "expression", "an expression is a text such as `io.a and not io.b`");
      return written;
    }
    auto parsed = parse_expression(node.text);
    if (const auto* fault = std::get_if<ExpressionFault>(&parsed)) {
      const auto column = static_cast<std::uint32_t>(fault->column + (node.quoted ? 1 : 0));
      report_.error({node.pos.line, node.pos.column + column}, "expression", fault->text);
      return written;
    }
    if (node.quoted) ++written.pos.column;
    written.expression = std::get<Expression>(std::move(parsed));
    return written;
  }

  void read_delay(const YamlNode& node, const char* key, Time& delay) {
    const YamlNode* found = node.find(key);
    if (found == nullptr) return;
    const auto time = parse_duration(found->text);
    if (found->kind == YamlNode::Kind::scalar && time && *time >= Time{0}) {
      delay = *time;
    } else {
      report_.error(found->pos, "delay", "a delay is a time such as 200ms or 1.5s");
    }
  }

  void read_value(const YamlNode& node, const char* key, double& value) {
    const YamlNode* found = node.find(key);
    if (found == nullptr) return;
    const char* end = found->text.data() + found->text.size();
    const auto read = std::from_chars(found->text.data(), end, value);
    if (read.ec == std::errc{} && read.ptr == end && std::isfinite(value)) return;
    report_.error(found->pos, "value", "`", std::string_view{key}, "` is a number");
  }

  Report report_;
  Findings& findings_;
  std::map<std::string, std::uint32_t, std::less<>> targets_;
  std::vector<Rule> rules_;
};

}  // namespace

SourcePos WrittenExpression::pos_of(const NameUse& use) const {
  return {pos.line, pos.column + static_cast<std::uint32_t>(use.column)};
}

std::vector<Rule> read_rules(std::string_view text, const std::string& file, Findings& findings) {
  const YamlTree tree = YamlTree::parse(text, file, findings);
  if (has_error(findings) || tree.root() == nullptr) return {};
  return Reader{file, findings}.read(*tree.root());
}

std::string rule_text(const Rule& rule) {
  if (rule.kind == RuleKind::count) {
    return fmt::format("count {} when {}{}", rule.target, rule.first.text,
                       rule.second ? ", reset " + rule.second->text : "");
  }
  std::string text =
      rule.kind == RuleKind::set
          ? fmt::format("set {} when {}", rule.target, rule.first.text)
          : fmt::format("latch {} on {}, off {}", rule.target, rule.first.text, rule.second->text);
  const auto add_delay = [&](const char* what, Time delay) {
    if (delay == Time{0}) return;
    text += fmt::format(", {} {:g} s", what, std::chrono::duration<double>(delay).count());
  };
  add_delay("on after", rule.on_delay);
  add_delay("off after", rule.off_delay);
  if (rule.on_value != 1.0 || rule.off_value != 0.0) {
    text += fmt::format(", value {:g}, else {:g}", rule.on_value, rule.off_value);
  }
  return text;
}

}  // namespace takt
