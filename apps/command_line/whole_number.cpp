#include "apps/command_line/whole_number.hpp"

#include <cctype>
#include <charconv>
#include <fmt/format.h>

namespace takt {

std::string octal_error(const std::string& text) {
  const std::size_t begin = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const auto digit_at = [&](std::size_t at) {
    return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
  };
  if (!digit_at(begin + 1) || text[begin] != '0') return {};
  const std::string sign = text.substr(0, begin);
  std::size_t first = begin;
  while (text[first] == '0' && digit_at(first + 1)) ++first;
  unsigned octal = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + begin, end, octal, 8);
  const bool ambiguous = error == std::errc{} && rest == end && octal >= 8;
  return fmt::format("'{}' begins with a zero: write {}{}", text, sign + text.substr(first),
                     ambiguous ? fmt::format(" or {}{:#x}", sign, octal) : "");
}

}  // namespace takt
