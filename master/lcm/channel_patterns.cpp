#include "master/lcm/channel_patterns.hpp"

#include <algorithm>
#include <utility>

namespace takt {
namespace {

constexpr std::size_t most_known_channels = 1024;

}  // namespace

std::expected<void, std::string> ChannelPatterns::add(std::string_view pattern) {
  if (patterns_.size() == most_patterns) {
    return std::unexpected{"there are " + std::to_string(most_patterns) + " patterns already"};
  }
  if (characters_ + pattern.size() > most_characters) {
    return std::unexpected{"the patterns together have more than " +
                           std::to_string(most_characters) + " characters"};
  }
  auto parsed = ChannelPattern::parse(pattern);
  if (!parsed) return std::unexpected{parsed.error()};
  patterns_.push_back(std::move(*parsed));
  characters_ += pattern.size();
  known_.clear();
  return {};
}

void ChannelPatterns::remove(std::string_view pattern) {
  const auto found = std::ranges::find(patterns_, pattern, &ChannelPattern::text);
  if (found == patterns_.end()) return;
  characters_ -= pattern.size();
  patterns_.erase(found);
  known_.clear();
}

bool ChannelPatterns::match(std::string_view channel) const {
  if (const auto known = known_.find(channel); known != known_.end()) return known->second;
  std::string key{channel};
  const bool matches = std::ranges::any_of(
      patterns_, [&](const ChannelPattern& pattern) { return pattern.match(key); });
  if (known_.size() >= most_known_channels) known_.clear();
  known_.emplace(std::move(key), matches);
  return matches;
}

}  // namespace takt
