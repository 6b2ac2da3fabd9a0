#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <string_view>

#include "eds_parser/table/output_limits.hpp"
#include "eds_parser/values/raw_number.hpp"
#include "master/explain/event_text.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

std::string number(double value, const std::string& unit) {
  return fmt::format("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

/// Returns the unit of the line of the plan that has a limit of this kind for the signal.
std::string unit_of(const BusPlan& plan, SignalIndex signal, LimitKind kind) {
  for (const LimitLine& line : plan.limits.lines) {
    if (line.kind == kind && std::ranges::find(line.signals, signal) != line.signals.end()) {
      return line.unit;
    }
  }
  return {};
}

/// Returns a limit as text: `-1.5 .. 1.5 rad`, `from 0 rad`, `2 rad/s`.
std::string read_value(const LimitLine& line, std::int64_t value) {
  const auto in_unit = [&](double raw) { return raw * line.scale + line.offset; };
  if (line.kind != LimitKind::position) {
    return number(in_unit(static_cast<double>(value)), line.unit);
  }
  const std::int64_t low = value >> 32;
  const auto high = std::int64_t{static_cast<std::int32_t>(value)};
  const double low_end = in_unit(static_cast<double>(low));
  const double high_end = in_unit(static_cast<double>(high));
  const bool turned = line.scale < 0;
  if (plausible_range(low, high) && open_end(low)) {
    return (turned ? "from " : "up to ") + number(high_end, line.unit);
  }
  if (plausible_range(low, high) && open_end(high)) {
    return (turned ? "up to " : "from ") + number(low_end, line.unit);
  }
  const auto [first, last] = std::minmax(low_end, high_end);
  return number(first, "") + " .. " + number(last, line.unit);
}

}  // namespace

std::string limit_text(const BusPlan& plan, const Event& event) {
  const std::uint32_t index = event.detail >> 8U;
  const auto kind = static_cast<LimitKind>(event.detail & 0xFFU & ~held_set_point);
  if (index >= plan.layout.signals.size()) return "a command outside its limits";
  const Signal& signal = plan.layout.signals[index];
  const std::span bytes{event.bytes};
  const auto measured = std::bit_cast<float>(load_le<std::uint32_t>(bytes));
  const auto limit = std::bit_cast<float>(load_le<std::uint32_t>(bytes.subspan(4)));
  const std::string unit = unit_of(plan, static_cast<SignalIndex>(index), kind);
  const double commanded = number_of(signal.type, event.value) * signal.scale + signal.offset;
  const std::string output = fmt::format("{} ({})", signal.name, to_string(signal.object));
  const std::string limits =
      fmt::format("is outside its limits: {} {}, limit {}; takt does not send", name(kind),
                  number(double{measured}, unit), number(double{limit}, unit));
  if ((event.detail & held_set_point) != 0) {
    return fmt::format(
        "{} still has the set-point {}, which {} the command that would make the axis follow this "
        "set-point, and the outputs of the node take their fallback until a set-point is within "
        "the limits again",
        output, number(commanded, signal.unit), limits);
  }
  return fmt::format(
      "command {} to {} {} it, and the outputs of the node take their fallback until a command is "
      "within the limits again",
      number(commanded, signal.unit), output, limits);
}

std::string read_limit_text(const BusPlan& plan, const Event& event) {
  const std::size_t place = event.detail >> 8U;
  if (place >= plan.limits.lines.size()) return "a limit of the drive";
  const LimitLine& line = plan.limits.lines[place];
  const std::string_view key = name(line.kind);
  const std::string what = fmt::format("{}{} {}, read from the device ({})", key,
                                       line.axis > 1 ? fmt::format(" of axis {}", line.axis) : "",
                                       read_value(line, event.value), to_string(line.object));
  if (static_cast<LimitVerdict>(event.detail & 0xFFU) == LimitVerdict::good) {
    return "limit: " + what;
  }
  return fmt::format(
      "the limit {}, is implausible and is ignored; write `limits: {{{}: ...}}` in the network "
      "file",
      what, key);
}

}  // namespace takt
