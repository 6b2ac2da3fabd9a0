#pragma once
#include <array>
#include <string>
#include <string_view>

#include "eds_parser/report/source.hpp"

namespace takt {

/// Rules of `takt eds check` whose findings have only one sensible reading, so that fix_eds() can
/// mend them. fix_eds() also mends unknown keys that are misspellings of certain known keys. It
/// does not mend every case of the rules on section names.
inline constexpr std::array<std::string_view, 33> fixable_rules{
    "access-type-letter", "baudrate-unit",      "blank-in-key",
    "boolean-word",       "byte-order-mark",    "compact-and-sub-number",
    "decimal-sub-index",  "entry-count-wrong",  "hash-comment",
    "hex-without-prefix", "inline-comment",     "integer-with-fraction",
    "leading-zero",       "list-count-missing", "list-count-wrong",
    "list-numbers-gap",   "listed-twice",       "module-count",
    "negative-unsigned",  "nodeid-not-first",   "nodeid-without-dollar",
    "number-suffix",      "object-not-listed",  "octal-number",
    "octet-string-form",  "real-bit-pattern",   "section-name-form",
    "section-not-closed", "section-spelling",   "sub-number-missing",
    "sub-number-wrong",   "type-word",          "wrong-list"};

struct FixedEds {
  std::string text;       ///< the whole file; parts that are not mended stay byte for byte
  Findings fixed;         ///< findings that were mended, as they were found
  Findings left;          ///< findings that the mended text still has
  bool readable = false;  ///< false: not an EDS or DCF; `left` gives the reason
};

/// Mends errors that can be read in only one way. Objects, sub-objects and values do not change. A
/// UTF-16 file becomes UTF-8.
FixedEds fix_eds(std::string_view source, const std::string& source_name);

}  // namespace takt
