#pragma once
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "master/lcm/channel_pattern.hpp"

namespace takt {

/// The subscriptions of one program: patterns over whole channel names, as in LCM. They come from
/// outside, so their number, their size and the cost of each match are bounded.
class ChannelPatterns {
 public:
  static constexpr std::size_t most_patterns = 256;
  static constexpr std::size_t most_characters = 8192;  ///< total of all patterns

  /// Adds a pattern. The error says why the pattern is refused.
  std::expected<void, std::string> add(std::string_view pattern);
  void remove(std::string_view pattern);
  /// Returns true if a pattern matches. The result is cached per channel.
  bool match(std::string_view channel) const;
  /// Returns the total length of all patterns.
  std::size_t characters() const noexcept { return characters_; }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const noexcept {
      return std::hash<std::string_view>{}(text);
    }
  };
  std::vector<ChannelPattern> patterns_;
  std::size_t characters_ = 0;
  mutable std::unordered_map<std::string, bool, Hash, std::equal_to<>> known_;
};

}  // namespace takt
