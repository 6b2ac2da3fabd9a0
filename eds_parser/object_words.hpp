#pragma once
#include <optional>
#include <string_view>

#include "eds_parser/eds_section.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/report.hpp"
#include "eds_parser/value_reader.hpp"

namespace takt {

/// `ro`, `rw` ... of AccessType, in any case. CiA 306, 4.6.3.2.
std::optional<Access> access_of_word(std::string_view text) noexcept;

/// `R` and `W`, in any case, which some tools write for ro and wo.
std::optional<Access> access_of_letter(std::string_view text) noexcept;

/// Number of a word of ObjectType or DataType, whatever comment is behind it.
std::optional<std::uint32_t> code_of_word(Keyword keyword, std::string_view text) noexcept;

/// ObjectType and DataType are numbers; some files have the words instead: `RECORD`, `UNSIGNED32`.
/// None where the key is missing or neither.
std::optional<std::uint32_t> read_object_type_code(const ObjectFields& fields, SourcePos pos,
                                                   ValueReader& values, Report& report);
std::optional<std::uint32_t> read_data_type_code(const ObjectFields& fields, SourcePos pos,
                                                 ValueReader& values, Report& report);
/// ObjectType is DOMAIN; tells nothing of how it is written.
bool is_domain_object(const ObjectFields& fields) noexcept;

}  // namespace takt
