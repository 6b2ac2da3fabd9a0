#include "apps/takt/live/view/timing_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/takt/live/text/table.hpp"

namespace takt {
namespace {

/// A range of octaves of a histogram of times. Octave i covers [2^i, 2^(i+1)) / 8 us.
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

/// Returns the distribution as a row of bars, each over `step` octaves. Every bar of octaves that
/// are not empty has at least the lowest height, so that rare times stay visible.
std::string picture(const histogram_t& times, Octaves range, std::size_t step) {
  static constexpr std::array bars{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  std::vector<std::int64_t> counts;
  for (std::size_t i = range.first; i < range.end; ++i) {
    if ((i - range.first) % step == 0) counts.push_back(0);
    if (i < times.bins.size()) counts.back() += std::max<std::int64_t>(times.bins[i], 0);
  }
  const std::int64_t most = counts.empty() ? 0 : *std::ranges::max_element(counts);
  std::string text;
  for (const std::int64_t count : counts) {
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

std::vector<Line> timing_lines(const timing_t& timing, std::size_t width) {
  const Octaves range = filled(timing);
  if (range.end == 0) return {Line{}.add("no times were measured in the last second")};
  constexpr std::size_t most_bars = 18;
  const std::size_t room = std::min(most_bars, std::max<std::size_t>(width, 3) - 2);
  const std::size_t step = (range.end - range.first + room - 1) / room;
  const std::string from = edge(range.first);
  const std::string to = edge(range.end);
  Table table{{{.title = "us"},
               {.title = "times", .kind = Cell::number},
               {.title = "least", .kind = Cell::number, .usual = 7},
               {.title = "median", .kind = Cell::number, .usual = 7},
               {.title = "p99", .kind = Cell::number, .usual = 7},
               {.title = "longest", .kind = Cell::number, .usual = 7},
               {.title = from + " .. " + to}}};
  for (const histogram_t& times : timing.histograms) {
    if (times.count == 0) continue;
    const auto number = [](float microseconds) {
      return PaintedText{fmt::format("{:.1f}", microseconds)};
    };
    table.add({{std::string{timing_label(times.name)}},
               {std::to_string(times.count)},
               number(times.minimum),
               number(times.median),
               number(times.p99),
               number(times.maximum),
               {picture(times, range, step)}});
  }
  return table.text(width).all();
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
