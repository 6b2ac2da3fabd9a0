#pragma once
#include <optional>
#include <string_view>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// Returns the access type that a word of AccessType (`ro`, `rw` ...) means. The case of the
/// letters does not matter. CiA 306, 4.6.3.2.
std::optional<Access> access_of_word(std::string_view text) noexcept;

/// Returns the access type that a letter `R` or `W` means. Some tools write these letters for ro
/// and wo; their case does not matter.
std::optional<Access> access_of_letter(std::string_view text) noexcept;

/// Returns the code that a word of ObjectType or DataType means. A comment after the word is
/// ignored.
std::optional<std::uint32_t> code_of_word(Keyword keyword, std::string_view text) noexcept;

/// Reads ObjectType or DataType. Both are numbers, but some files contain the words instead:
/// `RECORD`, `UNSIGNED32`. Returns std::nullopt if the key is missing or its value is neither.
std::optional<std::uint32_t> read_type_code(const ObjectFields& fields, Keyword keyword,
                                            ValueReader& values, Report& report);
/// Returns true if ObjectType is DOMAIN. Reports no findings.
bool is_domain_object(const ObjectFields& fields) noexcept;

}  // namespace takt
