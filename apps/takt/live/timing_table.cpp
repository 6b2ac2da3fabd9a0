#include "apps/takt/live/timing_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

namespace takt {
namespace {

/// A range of octaves of times. Octave i covers [2^i, 2^(i+1)) / 8 us.
struct Octaves {
  std::size_t first = 0;
  std::size_t end = 0;
};

Octaves filled(const timing_t& timing) {
  Octaves range{.first = SIZE_MAX};
  for (const histogram_t& times : timing.histograms) {
    for (std::size_t i = 0; i < times.bins.size(); ++i) {
      if (times.bins[i] == 0) continue;
      range.first = std::min(range.first, i);
      range.end = std::max(range.end, i + 1);
    }
  }
  return range.end == 0 ? Octaves{} : range;
}

/// Returns the distribution as a row of bars. Every octave that is not empty has at least the
/// lowest bar, so that rare times stay visible.
std::string picture(const histogram_t& times, Octaves range) {
  static constexpr std::array bars{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const std::int64_t most = times.bins.empty() ? 0 : *std::ranges::max_element(times.bins);
  std::string text;
  for (std::size_t i = range.first; i < range.end; ++i) {
    const std::int64_t count = i < times.bins.size() ? std::max<std::int64_t>(times.bins[i], 0) : 0;
    const double share = most <= 0 ? 0 : static_cast<double>(count) / static_cast<double>(most);
    text += count == 0 ? " " : bars[static_cast<std::size_t>(std::lround(share * 7))];
  }
  return text;
}

std::string edge(std::size_t octave) {
  const double microseconds = std::ldexp(0.125, static_cast<int>(octave));
  return microseconds < 1000 ? fmt::format("{:.3g} us", microseconds)
                             : fmt::format("{:.3g} ms", microseconds / 1000);
}

}  // namespace

std::string_view timing_label(std::string_view histogram) {
  if (histogram == "sync_lateness") return "SYNC late by";
  if (histogram == "sync_on_wire") return "SYNC on wire by";
  if (histogram == "sync_to_last_pdo") return "last PDO after";
  if (histogram == "sync_to_publish") return "image after";
  if (histogram == "sync_to_lcm") return "on LCM after";
  if (histogram == "sync_to_callback") return "received after";
  if (histogram == "command_age") return "command age";
  return histogram;
}

std::vector<std::string> timing_lines(const timing_t& timing) {
  const Octaves range = filled(timing);
  if (range.end == 0) return {"no times were measured in the last second"};
  std::vector<std::string> lines{fmt::format("{:16} {:>7} {:>9} {:>9} {:>9} {:>9}   {} .. {}", "us",
                                             "times", "least", "median", "p99", "longest",
                                             edge(range.first), edge(range.end))};
  for (const histogram_t& times : timing.histograms) {
    if (times.count == 0) continue;
    lines.push_back(fmt::format("{:16} {:>7} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f}   {}",
                                timing_label(times.name), times.count, times.minimum, times.median,
                                times.p99, times.maximum, picture(times, range)));
  }
  return lines;
}

nlohmann::json timing_json(const timing_t& timing) {
  nlohmann::json histograms = nlohmann::json::object();
  for (const histogram_t& times : timing.histograms) {
    histograms[times.name] = {{"count", times.count},        {"minimum_us", times.minimum},
                              {"median_us", times.median},   {"p99_us", times.p99},
                              {"maximum_us", times.maximum}, {"octaves", times.bins}};
  }
  return {{"utime", timing.utime},
          {"session", timing.session},
          {"cycle", timing.cycle},
          {"histograms", std::move(histograms)}};
}

}  // namespace takt
