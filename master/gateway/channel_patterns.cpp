#include "master/gateway/channel_patterns.hpp"

#include <algorithm>

namespace takt {
namespace {

constexpr std::size_t most_known = 1024;

}  // namespace

bool ChannelPatterns::add(std::string_view pattern) {
  // Counted repetition multiplies the size of the automaton, lookahead its time.
  const bool costly = pattern.find('{') != pattern.npos || pattern.find("(?") != pattern.npos;
  if (costly || pattern.size() > longest_pattern || patterns_.size() == most_patterns) return false;
  try {
    std::string text{pattern};
    // The breadth-first matcher: time bounded by pattern x channel; it refuses back references.
    std::regex expression{text, std::regex::ECMAScript | std::regex_constants::__polynomial};
    patterns_.push_back({std::move(text), std::move(expression)});
  } catch (const std::regex_error&) {
    return false;
  }
  known_.clear();
  return true;
}

void ChannelPatterns::remove(std::string_view pattern) {
  const auto found = std::ranges::find(patterns_, pattern, &Pattern::text);
  if (found == patterns_.end()) return;
  patterns_.erase(found);
  known_.clear();
}

bool ChannelPatterns::match(std::string_view channel) const {
  if (const auto known = known_.find(channel); known != known_.end()) return known->second;
  std::string key{channel};
  const bool matches = std::ranges::any_of(
      patterns_, [&](const Pattern& pattern) { return std::regex_match(key, pattern.expression); });
  if (known_.size() >= most_known) known_.clear();
  known_.emplace(std::move(key), matches);
  return matches;
}

}  // namespace takt
