#pragma once
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "eds_parser/report/text.hpp"
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// A part of a message: a text in quotes, see quoted().
struct Quoted {
  std::string_view text;
};

/// A part of a message: a text of the file, see to_utf8().
struct Utf8 {
  std::string_view text;
};

/// A part of a message: a number as `0x6041`, see hex().
struct Hex {
  constexpr explicit Hex(std::uint32_t number, int least_digits = 4) noexcept
      : value{number}, digits{least_digits} {}
  std::uint32_t value;
  int digits;
};

inline void append_part(std::string& out, std::string_view text) { out += text; }
inline void append_part(std::string& out, char c) { out += c; }
inline void append_part(std::string& out, double number) { out += real_text(number); }
inline void append_part(std::string& out, Quoted part) { out += quoted(part.text); }
inline void append_part(std::string& out, Utf8 part) { out += to_utf8(part.text); }
inline void append_part(std::string& out, Hex part) { out += hex(part.value, part.digits); }
inline void append_part(std::string& out, DataType type) { out += name(type); }
template <std::integral T>
void append_part(std::string& out, T number) {
  out += std::to_string(number);
}
template <class T>
  requires requires(const T& value) { to_string(value); }
void append_part(std::string& out, const T& value) {
  out += to_string(value);
}

/// Appends the parts of a message: texts, numbers, and values with an append_part() or a
/// to_string().
template <class... Parts>
void append(std::string& out, const Parts&... parts) {
  (append_part(out, parts), ...);
}

/// Appends an item to a list whose items are separated by commas. The item is given in parts.
template <class... Parts>
void append_item(std::string& list, const Parts&... parts) {
  append(list, list.empty() ? "" : ", ", parts...);
}

/// Returns the parts of a message, one after the other, as one text; see append().
template <class... Parts>
std::string concat(const Parts&... parts) {
  std::string message;
  append(message, parts...);
  return message;
}

/// Returns a time in microseconds as text: "50 ms", "100 us".
inline std::string microseconds_text(std::uint64_t us) {
  return us % 1000 == 0 ? concat(us / 1000, " ms") : concat(us, " us");
}

}  // namespace takt
