#include "apps/takt/log/logged_signal.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fnmatch.h>
#include <iterator>
#include <set>
#include <string_view>

#include "eds_parser/report/suggest.hpp"
#include "eds_parser/values/raw_number.hpp"

namespace takt::logging {
namespace {

LoggedSignal logged(const signal_t& signal, std::size_t position) {
  return {
      .node = signal.node,
      .name = signal.name,
      .object = {static_cast<std::uint16_t>(signal.index), static_cast<std::uint8_t>(signal.sub)},
      .unit = signal.unit,
      .format = {.type = static_cast<DataType>(signal.data_type),
                 .bits = static_cast<std::uint8_t>(std::clamp<int>(signal.bits, 0, 64)),
                 .scale = signal.scale,
                 .offset = signal.offset},
      .position = position};
}

/// Returns the error that no signal matches a pattern, with the most similar name.
std::string no_match(const std::vector<signal_t>& layout, const std::string& pattern) {
  std::set<std::string> nodes;
  std::set<std::string> names;
  for (const signal_t& signal : layout) {
    nodes.insert(signal.node);
    names.insert(signal.node + '.' + signal.name);
  }
  const std::string text = "no signal matches '" + pattern + "'";
  if (nodes.contains(pattern)) {
    return text + ", did you mean `" + pattern + ".*` (all signals of this node)?";
  }
  const std::size_t dot = pattern.find('.');
  const std::string node = pattern.substr(0, dot);
  if (dot != pattern.npos && !nodes.contains(node)) {
    const std::vector<std::string_view> all{nodes.begin(), nodes.end()};
    const std::string_view meant = nearest(node, all);
    if (!meant.empty()) {
      return text + ", did you mean `" + std::string{meant} + pattern.substr(dot) + "`?";
    }
  }
  const std::vector<std::string_view> all{names.begin(), names.end()};
  const std::string guess = did_you_mean(pattern, all);
  return guess.empty() ? text + "; `takt top` shows the names of all signals" : text + guess;
}

}  // namespace

std::expected<std::vector<LoggedSignal>, std::string> choose_signals(
    const std::vector<signal_t>& layout, const std::vector<std::string>& patterns) {
  std::vector<LoggedSignal> chosen;
  std::vector<bool> taken(layout.size());
  const auto take = [&](const std::string& pattern) {
    bool some = false;
    for (std::size_t i = 0; i < layout.size(); ++i) {
      const std::string name = layout[i].node + '.' + layout[i].name;
      if (::fnmatch(pattern.c_str(), name.c_str(), 0) != 0) continue;
      some = true;
      if (!taken[i]) chosen.push_back(logged(layout[i], i));
      taken[i] = true;
    }
    return some;
  };
  if (patterns.empty()) take("*");
  for (const std::string& pattern : patterns) {
    if (!take(pattern)) return std::unexpected{no_match(layout, pattern)};
  }
  return chosen;
}

bool append_value(std::string& out, const ValueFormat& format, std::int64_t raw) {
  const auto end = std::back_inserter(out);
  const bool is_integer = !is_real(format.type) && format.scale == 1.0 && format.offset == 0.0;
  if (is_integer && format.type == DataType::unsigned64) {
    fmt::format_to(end, "{}", static_cast<std::uint64_t>(raw));
    return true;
  }
  if (is_integer) {
    fmt::format_to(end, "{}", raw);
    return true;
  }
  const double value = number_of(format.type, raw) * format.scale + format.offset;
  if (!std::isfinite(value)) return false;
  // 12 digits hold each raw value of 32 bits, and hide the rounding of the scale.
  if (format.bits <= 32 && format.type != DataType::real32) {
    fmt::format_to(end, "{:.12g}", value);
  } else if (format.type == DataType::real32 && format.scale == 1.0 && format.offset == 0.0) {
    fmt::format_to(end, "{}", static_cast<float>(value));
  } else {
    fmt::format_to(end, "{}", value);
  }
  return true;
}

}  // namespace takt::logging
