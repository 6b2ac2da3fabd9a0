#include <cstdlib>
#include <fmt/format.h>
#include <utility>

#include "apps/takt/smooth/judge/judges.hpp"
#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {
namespace {

constexpr std::uint64_t fewest_zigzags = 8;

/// A count of values that are far from the value before but near the one before that.
struct Zigzag {
  std::uint64_t compared = 0;
  std::uint64_t count = 0;
  Time first{};
  std::int64_t apart = 0;  // increments between the two series
};

/// Counts the zigzags in the cycles in motion. The values of two senders alternate between two
/// series. The values of one sender do not, whatever its jitter is.
Zigzag count_zigzags(const AxisView& view) {
  Zigzag result;
  const auto& samples = view.axis.set_points;
  std::vector<std::int64_t> distances;
  std::size_t cycle = 0;
  const auto& cycles = view.cycles.cycles;
  for (std::size_t i = 2; i < samples.size(); ++i) {
    while (cycle < cycles.size() && cycles[cycle].end < samples[i].when) ++cycle;
    if (cycle == cycles.size()) break;
    if (!cycles[cycle].moving) continue;
    const std::int64_t first = difference(samples[i - 1].value, samples[i - 2].value);
    const std::int64_t second = difference(samples[i].value, samples[i - 1].value);
    if (first == 0 && second == 0) continue;
    ++result.compared;
    const bool returns = (first < 0) != (second < 0) && std::abs(first) > 8 && std::abs(second) > 8;
    if (!returns || std::abs(first + second) * 3 > std::abs(first)) continue;
    if (result.count++ == 0) result.first = samples[i].when;
    distances.push_back(std::abs(first));
  }
  result.apart = median(std::move(distances));
  return result;
}

}  // namespace

void judge_senders(const AxisView& view, Findings& findings) {
  const Zigzag zigzag = count_zigzags(view);
  if (zigzag.count < fewest_zigzags || zigzag.count * 3 < zigzag.compared) return;
  findings.push_back(
      {.cause = Cause::two_senders,
       .text = fmt::format("Two programs write RPDO {}: its set-points jump {} between two "
                           "series, {} increments apart, first at {:.3f} s.",
                           to_string(view.axis.set_point_id), times_text(zigzag.count),
                           zigzag.apart, seconds(zigzag.first)),
       .remedy = "Stop one of the senders: a second master, a test program, or an application "
                 "that was started twice.",
       .count = zigzag.count,
       .first = zigzag.first});
}

}  // namespace takt::smooth
