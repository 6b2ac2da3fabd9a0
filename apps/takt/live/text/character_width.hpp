#pragma once
#include <cstddef>
#include <string_view>

namespace takt {

/// The first character of a text in UTF-8.
struct FirstCharacter {
  std::size_t bytes = 0;  ///< length in bytes: at least 1 unless the text is empty
  /// Columns in a terminal: 0 for marks on the character before, 2 for wide characters.
  std::size_t columns = 0;
};

FirstCharacter first_character(std::string_view text) noexcept;

/// Returns the columns that a text in UTF-8 takes in a terminal.
std::size_t columns_of(std::string_view text) noexcept;

/// Returns the longest beginning of `text` that takes at most `columns` columns.
std::string_view first_columns(std::string_view text, std::size_t columns) noexcept;

/// Returns the longest end of `text` that takes at most `columns` columns.
std::string_view last_columns(std::string_view text, std::size_t columns) noexcept;

}  // namespace takt
