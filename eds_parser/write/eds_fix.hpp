#pragma once
#include <array>
#include <string>
#include <string_view>

#include "eds_parser/source.hpp"

namespace takt {

/// Rules of `takt eds check` whose findings have only one sensible reading, so that fix_eds() can
/// mend them. Of unknown keys only slips of some known ones; of those in brackets not every case.
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
  std::string text;       ///< the whole file; what is not mended stays byte for byte
  Findings fixed;         ///< what was mended, as it was found
  Findings left;          ///< what the mended text still has
  bool readable = false;  ///< false: no EDS or DCF; `left` says why
};

/// Mends what can be read in only one way. Objects, sub-objects and values stay what they were;
/// a UTF-16 file becomes UTF-8.
FixedEds fix_eds(std::string_view source, const std::string& source_name);

}  // namespace takt
