#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// One line of the comparison of two texts.
struct DiffLine {
  enum class Kind : std::uint8_t { same, removed, added };
  Kind kind = Kind::same;
  std::string_view text{};
};

/// Returns the lines of a text without their ends. LF, CR LF and CR end a line.
std::vector<std::string_view> lines_of(std::string_view text);

/// Returns the steps from `before` to `after`. The texts are aligned at the lines that occur
/// exactly once in each of them. The work is bounded: if many lines differ and none of them occurs
/// exactly once in each text, all of them count as changed.
std::vector<DiffLine> diff_lines(std::span<const std::string_view> before,
                                 std::span<const std::string_view> after);

/// Returns the hunks as `diff -u` prints them, with `context` lines around each change. The result
/// is empty if nothing differs. `heading` selects the lines that are repeated after `@@` of the
/// following hunks.
std::string unified_hunks(std::span<const DiffLine> lines, bool (*heading)(std::string_view),
                          std::size_t context = 3);

/// Returns the complete output of `diff -u`, for use with `patch --binary`: each line keeps its
/// end. The result is empty if nothing differs. If a text ends its lines with CR alone, it would be
/// one line for `patch`; the output is then only for reading.
std::string unified_diff(std::string_view before, std::string_view after,
                         const std::string& before_name, const std::string& after_name,
                         bool (*heading)(std::string_view));

}  // namespace takt
