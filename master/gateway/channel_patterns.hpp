#pragma once
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "master/gateway/channel_pattern.hpp"

namespace takt {

/// The subscriptions of one program: patterns over whole channel names, as LCM's. They come from
/// outside, so their number and their size are bounded, and so is the cost of each match.
class ChannelPatterns {
 public:
  static constexpr std::size_t most_patterns = 256;
  static constexpr std::size_t most_characters = 8192;  ///< of all patterns together

  /// An error says why this pattern is not served.
  std::expected<void, std::string> add(std::string_view pattern);
  void remove(std::string_view pattern);
  /// Answers are remembered per channel.
  bool match(std::string_view channel) const;
  /// Of all patterns.
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
