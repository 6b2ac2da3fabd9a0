#include "master/lcm/channel_pattern.hpp"

#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <utility>

namespace takt {
namespace {

template <class Set>
void unite(Set& all, const Set& more) noexcept {
  for (std::size_t i = 0; i < all.size(); ++i) all[i] |= more[i];
}

template <class Set, class F>
void for_each(const Set& set, F visit) {
  for (std::size_t word = 0; word < set.size(); ++word) {
    for (std::uint64_t rest = set[word]; rest != 0; rest &= rest - 1) {
      visit(word * 64 + static_cast<std::size_t>(std::countr_zero(rest)));
    }
  }
}

}  // namespace

/// Builds a Glushkov automaton while it reads the pattern. Each character of the pattern that
/// matches a character of the name becomes one position.
class PatternParser {
 public:
  explicit PatternParser(ChannelPattern& out) : out_{out}, left_{out.text_} {}

  std::expected<void, std::string> parse() {
    if (left_.starts_with('^')) left_.remove_prefix(1);
    if (left_.ends_with('$') && !left_.ends_with("\\$")) left_.remove_suffix(1);
    const Part whole = alternatives(0);
    if (why_.empty() && !left_.empty()) refuse("a ')' has no opening '('");
    if (!why_.empty()) return std::unexpected{why_};
    out_.first_ = whole.first;
    out_.last_ = whole.last;
    out_.takes_nothing_ = whole.takes_nothing;
    return {};
  }

 private:
  using Set = ChannelPattern::Set;
  struct Part {
    Set first{};
    Set last{};
    bool takes_nothing = true;
  };

  bool at_end() const noexcept { return left_.empty() || !why_.empty(); }
  char take() noexcept {
    const char c = left_.front();
    left_.remove_prefix(1);
    return c;
  }
  Part refuse(std::string why) {
    if (why_.empty()) why_ = std::move(why);
    return {};
  }

  Part alternatives(std::size_t depth) {
    Part all = sequence(depth);
    while (!at_end() && left_.front() == '|') {
      take();
      const Part other = sequence(depth);
      unite(all.first, other.first);
      unite(all.last, other.last);
      all.takes_nothing = all.takes_nothing || other.takes_nothing;
    }
    return all;
  }

  Part sequence(std::size_t depth) {
    Part all;
    while (!at_end() && left_.front() != '|' && left_.front() != ')') {
      const Part next = repeated(depth);
      link(all.last, next.first);
      if (all.takes_nothing) unite(all.first, next.first);
      if (!next.takes_nothing) all.last = {};
      unite(all.last, next.last);
      all.takes_nothing = all.takes_nothing && next.takes_nothing;
    }
    return all;
  }

  void link(const Set& from, const Set& to) {
    for_each(from, [&](std::size_t at) { unite(out_.positions_[at].next, to); });
  }

  Part repeated(std::size_t depth) {
    Part part = one(depth);
    while (!at_end() && (left_.front() == '*' || left_.front() == '+' || left_.front() == '?')) {
      const char sign = take();
      if (sign != '?') link(part.last, part.first);
      if (sign != '+') part.takes_nothing = true;
    }
    return part;
  }

  Part one(std::size_t depth) {
    const char c = take();
    switch (c) {
      case '(':
        return group(depth);
      case '.':
        return position(std::bitset<256>{}.set());
      case '[':
        return character_class();
      case '\\':
        return escaped();
      case '*':
      case '+':
      case '?':
        return refuse(fmt::format("'{}' has nothing to repeat", c));
      case '{':
      case '}':
        return refuse("repetition by '{}' is not supported");
      case '^':
      case '$':
        return refuse(fmt::format("'{}' is possible only at the start or the end of a pattern", c));
      default:
        return literal(c);
    }
  }

  Part group(std::size_t depth) {
    if (depth == ChannelPattern::deepest) return refuse("too many nested groups");
    if (left_.starts_with("?:")) left_.remove_prefix(2);
    if (left_.starts_with('?')) return refuse("look-ahead and other '(?' are not supported");
    const Part inner = alternatives(depth + 1);
    if (at_end() || take() != ')') return refuse("a '(' is not closed");
    return inner;
  }

  Part literal(char c) {
    std::bitset<256> takes;
    takes.set(static_cast<unsigned char>(c));
    return position(takes);
  }

  Part escaped() {
    if (left_.empty()) return refuse("the pattern ends with a backslash");
    const char c = take();
    const bool word = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    if (word) return refuse(fmt::format("'\\{}' is not supported", c));
    return literal(c);
  }

  Part character_class() {
    std::bitset<256> takes;
    const bool inverted = left_.starts_with('^');
    if (inverted) left_.remove_prefix(1);
    for (bool any = false; !left_.empty() && (left_.front() != ']' || !any); any = true) {
      if (left_.starts_with("[:") || left_.front() == '\\') {
        return refuse("named classes and backslashes in '[]' are not supported");
      }
      const auto from = static_cast<unsigned char>(take());
      auto to = from;
      if (left_.size() > 1 && left_[0] == '-' && left_[1] != ']') {
        take();
        to = static_cast<unsigned char>(take());
      }
      for (unsigned c = from; c <= to; ++c) takes.set(c);
    }
    if (left_.empty()) return refuse("a '[' is not closed");
    take();
    return position(inverted ? ~takes : takes);
  }

  /// Adds a position. There are at most as many positions as characters in the pattern.
  Part position(const std::bitset<256>& takes) {
    Part part{.first = {}, .last = {}, .takes_nothing = false};
    const std::size_t at = out_.positions_.size();
    part.first[at / 64] = part.last[at / 64] = std::uint64_t{1} << (at % 64);
    out_.positions_.push_back({.takes = takes, .next = {}});
    return part;
  }

  ChannelPattern& out_;
  std::string_view left_;
  std::string why_;
};

std::expected<ChannelPattern, std::string> ChannelPattern::parse(std::string_view text) {
  if (text.size() > longest) {
    return std::unexpected{"the pattern is longer than " + std::to_string(longest) + " characters"};
  }
  ChannelPattern pattern;
  pattern.text_ = text;
  if (auto good = PatternParser{pattern}.parse(); !good) return std::unexpected{good.error()};
  return pattern;
}

bool ChannelPattern::match(std::string_view channel) const noexcept {
  if (channel.empty()) return takes_nothing_;
  Set now{};
  for_each(first_, [&](std::size_t at) {
    if (positions_[at].takes[static_cast<unsigned char>(channel.front())]) {
      now[at / 64] |= std::uint64_t{1} << (at % 64);
    }
  });
  for (const char c : channel.substr(1)) {
    Set reached{};
    for_each(now, [&](std::size_t at) { unite(reached, positions_[at].next); });
    now = {};
    for_each(reached, [&](std::size_t at) {
      if (positions_[at].takes[static_cast<unsigned char>(c)]) {
        now[at / 64] |= std::uint64_t{1} << (at % 64);
      }
    });
    if (now == Set{}) return false;
  }
  for (std::size_t i = 0; i < now.size(); ++i) {
    if ((now[i] & last_[i]) != 0) return true;
  }
  return false;
}

}  // namespace takt
