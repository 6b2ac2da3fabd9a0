#pragma once
#include <optional>
#include <string_view>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// Returns the access of a word of AccessType (`ro`, `rw` ...) in any case. CiA 306, 4.6.3.2.
std::optional<Access> access_of_word(std::string_view text) noexcept;

/// Returns the access of the letters `R` and `W` in any case, which some tools write for ro and wo.
std::optional<Access> access_of_letter(std::string_view text) noexcept;

/// Returns the number of a word of ObjectType or DataType. A comment after the word is ignored.
std::optional<std::uint32_t> code_of_word(Keyword keyword, std::string_view text) noexcept;

/// Reads ObjectType or DataType. Both are numbers, but some files contain the words instead:
/// `RECORD`, `UNSIGNED32`. Returns std::nullopt if the key is missing or its value is neither.
std::optional<std::uint32_t> read_type_code(const ObjectFields& fields, Keyword keyword,
                                            ValueReader& values, Report& report);
/// Returns true if ObjectType is DOMAIN. Reports no findings.
bool is_domain_object(const ObjectFields& fields) noexcept;

}  // namespace takt
