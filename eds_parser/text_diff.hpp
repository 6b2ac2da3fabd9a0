#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// One line of two texts beside each other.
struct DiffLine {
  enum class Kind : std::uint8_t { same, removed, added };
  Kind kind = Kind::same;
  std::string_view text{};
};

/// The lines of a text without their ends; LF, CRLF and CR end lines.
std::vector<std::string_view> lines_of(std::string_view text);

/// How `before` becomes `after`. Lines that occur once in both hold the two together; work is
/// bounded: where many lines differ without such, all of them count as changed.
std::vector<DiffLine> diff_lines(std::span<const std::string_view> before,
                                 std::span<const std::string_view> after);

/// Hunks as `diff -u` prints them, with `context` lines around; empty where nothing differs.
/// `heading`: which lines are named behind `@@` of the hunks that follow.
std::string unified_hunks(std::span<const DiffLine> lines, bool (*heading)(std::string_view),
                          std::size_t context = 3);

/// The whole of `diff -u`, for `patch --binary`: each line with the end it has; empty where nothing
/// differs. Texts whose lines end with CR alone would be one line: theirs is only to be read.
std::string unified_diff(std::string_view before, std::string_view after,
                         const std::string& before_name, const std::string& after_name,
                         bool (*heading)(std::string_view));

}  // namespace takt
