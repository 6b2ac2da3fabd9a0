#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "eds_parser/network_file/load_steps.hpp"

namespace takt {
namespace {

constexpr std::size_t most_named = 8;  // greatest number of nodes named in one message

/// A message from which the name and the number of its node have been removed.
struct Outline {
  std::string text;
  std::string node;  ///< the first node that the message names
};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Returns the length of the node name in backticks with which `text` begins, or 0 if it begins
/// with anything else.
std::size_t quoted_node(std::string_view text, const std::set<std::string_view>& names) {
  if (!text.starts_with('`')) return 0;
  const std::size_t end = text.find('`', 1);
  if (end == text.npos || !names.contains(text.substr(1, end - 1))) return 0;
  return end - 1;
}

Outline outline(std::string_view message, const std::set<std::string_view>& names) {
  Outline out;
  while (!message.empty()) {
    const std::size_t length = quoted_node(message, names);
    if (length != 0) {
      if (out.node.empty()) out.node = message.substr(1, length);
      out.text += "``";
      message.remove_prefix(length + 2);
      continue;
    }
    out.text += message.front();
    message.remove_prefix(1);
    if (!out.text.ends_with("node ")) continue;
    while (!message.empty() && is_digit(message.front())) message.remove_prefix(1);
  }
  return out;
}

struct Shared {
  std::size_t first = 0;  ///< index of the finding that is kept
  std::vector<std::string> others;
};

std::string others_text(const std::vector<std::string>& others) {
  std::string text = "; the same applies to ";
  for (std::size_t i = 0; i < std::min(others.size(), most_named); ++i) {
    text += (i == 0 ? "`" : ", `") + others[i] + "`";
  }
  if (others.size() > most_named) {
    text += " and " + std::to_string(others.size() - most_named) + " more nodes";
  }
  return text + (others.size() == 1 ? ", which shares this line" : ", which share this line");
}

}  // namespace

void join_shared_lines(Findings& findings, std::string_view file,
                       std::span<const std::string> nodes) {
  const std::set<std::string_view> names{nodes.begin(), nodes.end()};
  using Key = std::tuple<SourcePos, Severity, std::string_view, std::string, std::size_t>;
  std::map<Key, Shared> all;
  // One node may have several findings with the same outline. The nth such finding of a node is
  // then joined with the nth such findings of the other nodes.
  std::map<std::tuple<SourcePos, std::string, std::string>, std::size_t> count;
  std::vector<bool> joined(findings.size());
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const Finding& finding = findings[i];
    if (finding.file != file || finding.pos.line == 0) continue;
    Outline plain = outline(finding.message, names);
    if (plain.node.empty()) continue;
    const std::size_t nth = count[{finding.pos, plain.text, plain.node}]++;
    const auto [known, is_new] = all.try_emplace(
        Key{finding.pos, finding.severity, finding.rule, std::move(plain.text), nth},
        Shared{i, {}});
    if (is_new) continue;
    joined[i] = true;
    known->second.others.push_back(std::move(plain.node));
  }
  for (const auto& [key, shared] : all) {
    if (!shared.others.empty()) findings[shared.first].message += others_text(shared.others);
  }
  std::size_t index = 0;
  std::erase_if(findings, [&](const Finding&) { return joined[index++]; });
}

}  // namespace takt
