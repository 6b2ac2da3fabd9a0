#pragma once
#include <array>
#include <bitset>
#include <cstddef>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// One regular expression over whole channel names, as LCM programs subscribe: literals, `.`,
/// classes such as `[A-C]`, `*`, `+`, `?`, alternatives in groups, and `^` and `$` at the ends. It
/// is matched without backtracking: the cost is at most the length of the pattern times that of the
/// name. Everything else of regular expressions is refused.
class ChannelPattern {
 public:
  static constexpr std::size_t longest = 128;  ///< characters
  static constexpr std::size_t deepest = 16;   ///< groups inside each other

  /// An error says what can't be matched.
  static std::expected<ChannelPattern, std::string> parse(std::string_view text);

  bool match(std::string_view channel) const noexcept;
  const std::string& text() const noexcept { return text_; }

 private:
  friend class PatternParser;
  using Set = std::array<std::uint64_t, longest / 64>;  // positions of the pattern
  /// A place in the pattern that takes one character, and the places that may take the next one.
  struct Position {
    std::bitset<256> takes;
    Set next{};
  };

  std::string text_;
  std::vector<Position> positions_;
  Set first_{};
  Set last_{};
  bool takes_nothing_ = false;  // the empty name matches
};

}  // namespace takt
