#pragma once
#include <functional>
#include <regex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace takt {

/// The subscriptions of one program: regular expressions over whole channel names, as LCM's.
/// Patterns come from outside; they are bounded in number, size and cost.
class ChannelPatterns {
 public:
  static constexpr std::size_t most_patterns = 256;
  static constexpr std::size_t longest_pattern = 128;

  /// False: not a pattern that can be served.
  bool add(std::string_view pattern);
  void remove(std::string_view pattern);
  /// Answers are remembered per channel.
  bool match(std::string_view channel) const;

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const noexcept {
      return std::hash<std::string_view>{}(text);
    }
  };
  struct Pattern {
    std::string text;
    std::regex expression;
  };
  std::vector<Pattern> patterns_;
  mutable std::unordered_map<std::string, bool, Hash, std::equal_to<>> known_;
};

}  // namespace takt
