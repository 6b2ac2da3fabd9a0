#pragma once
#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "master/gateway/ascii/ascii_command.hpp"

// Splits a line into words and reads them.

namespace takt::ascii {

struct Word {
  std::string text;
  bool quoted = false;
};
using Words = std::span<const Word>;

/// The reason why a line is not understood.
struct Wrong {
  AsciiError error = AsciiError::syntax;
  std::string why;
};
template <class T>
using Read = std::expected<T, Wrong>;

std::unexpected<Wrong> wrong(std::string why);
std::unexpected<Wrong> unsupported(std::string why);

bool blank(char c) noexcept;
/// Splits a line into words; `#` begins a comment.
Read<std::vector<Word>> split(std::string_view line);
Read<std::uint32_t> number(Words words, std::size_t at, std::uint32_t most, const char* what);
/// Reads a number into `out`.
template <class T>
Read<void> number(Words words, std::size_t at, std::uint32_t most, const char* what, T& out) {
  const auto value = number(words, at, most, what);
  if (!value) return std::unexpected{value.error()};
  out = static_cast<T>(*value);
  return {};
}
/// Returns true if the word is `full` or its short form.
bool is(const Word& word, std::string_view short_form, std::string_view full);
inline bool is(const Word& word, std::string_view full) { return is(word, full, full); }
/// Returns true if the second word is `full` or its short form.
inline bool is_second(Words words, std::string_view short_form, std::string_view full) {
  return words.size() > 1 && is(words[1], short_form, full);
}
/// Checks that the line has no further words.
Read<void> end_at(Words words, std::size_t count);
/// Reads the words behind the name of a command, which is words[0].
using Reader = Read<void> (*)(Words words, AsciiCommand& out);
/// Reads a command that has no words behind its name.
inline Read<void> read_nothing(Words words, AsciiCommand&) { return end_at(words, 1); }

/// Reads a command that begins with `lss_` or `_lss_`.
Read<void> read_lss(Words words, AsciiCommand& out);

}  // namespace takt::ascii
