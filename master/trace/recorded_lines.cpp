#include "master/trace/recorded_lines.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string>

#include "eds_parser/values/number_in.hpp"
#include "master/trace/trace_line.hpp"
#include "master/trace/words.hpp"

namespace takt {
namespace {

constexpr std::uint64_t longest_pause_s = 1'000'000'000;

/// Converts seconds like `12.5` to microseconds. Returns 0 if the text is no time.
std::uint64_t microseconds(std::string_view seconds) {
  const std::size_t dot = std::min(seconds.find('.'), seconds.size());
  const auto whole = number_in<std::uint64_t>(seconds.substr(0, dot), 10);
  std::string digits{seconds.substr(std::min(dot + 1, seconds.size()))};
  digits.resize(6, '0');
  const auto micros = number_in<std::uint64_t>(digits, 10);
  if (!whole || !micros || *whole > longest_pause_s) return 0;
  return *whole * 1'000'000 + *micros;
}

}  // namespace

/// Adds the time of a line. The time of each line counts from the line before, even if that line
/// holds no frame.
void RecordedLines::advance(std::string_view text) {
  const auto words = words_of(text);
  if (!words.empty()) us_ += microseconds(words[0]);
}

std::optional<CandumpLine> RecordedLines::parse(std::string_view text) {
  if (const auto head = vector_head(text)) {
    base_ = head->base;
    relative_ = head->relative;
    us_ = 0;
    return {};
  }
  auto line = parse_recorded(text, base_);
  if (!relative_) return line;
  advance(text);
  if (line) line->stamp = fmt::format("{}.{:06}", us_ / 1'000'000, us_ % 1'000'000);
  return line;
}

}  // namespace takt
