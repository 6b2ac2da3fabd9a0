#pragma once
#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// A regular expression over whole channel names, as LCM programs use it in subscriptions:
/// literals, `.`, classes such as `[A-C]`, `*`, `+`, `?`, alternatives in groups, and `^` and `$`
/// at the ends. Matching uses no backtracking: its cost is at most the length of the pattern times
/// the length of the name. All other constructs of regular expressions are refused.
class ChannelPattern {
 public:
  static constexpr std::size_t longest = 128;  ///< characters
  static constexpr std::size_t deepest = 16;   ///< levels of nested groups

  /// The error says which construct is not supported.
  static std::expected<ChannelPattern, std::string> parse(std::string_view text);

  bool match(std::string_view channel) const noexcept;
  const std::string& text() const noexcept { return text_; }

 private:
  friend class PatternParser;
  using Set = std::array<std::uint64_t, longest / 64>;  // positions of the pattern
  /// A position in the pattern that matches one character, with the positions that may match the
  /// next character.
  struct Position {
    std::bitset<256> takes;
    Set next{};
  };

  std::string text_;
  std::vector<Position> positions_;
  Set first_{};
  Set last_{};
  bool takes_nothing_ = false;  // the pattern matches the empty name
};

}  // namespace takt
