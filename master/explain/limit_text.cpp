#include "master/explain/limit_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <string_view>

#include "eds_parser/table/limit_names.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

std::string number(double value, const std::string& unit) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data() + (unit.empty() ? std::string{} : " " + unit);
}

/// The unit of the line that limits this signal in this way.
std::string unit_of(const BusPlan& plan, SignalIndex signal, LimitKind kind) {
  for (const LimitLine& line : plan.limits.lines) {
    if (line.kind == kind && std::ranges::find(line.signals, signal) != line.signals.end()) {
      return line.unit;
    }
  }
  return {};
}

double raw_number(const Signal& signal, std::int64_t raw) {
  if (signal.type == DataType::real32) {
    return double{std::bit_cast<float>(static_cast<std::uint32_t>(raw))};
  }
  return signal.type == DataType::real64 ? std::bit_cast<double>(raw) : static_cast<double>(raw);
}

/// A limit as text: `-1.5 .. 1.5 rad`, `from 0 rad`, `2 rad/s`.
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
  const double commanded = raw_number(signal, event.value) * signal.scale + signal.offset;
  const std::string output = signal.name + " (" + to_string(signal.object) + ")";
  const std::string limits = " is outside its limits: " + std::string{name(kind)} + " " +
                             number(double{measured}, unit) + ", limit " +
                             number(double{limit}, unit);
  if ((event.detail & held_set_point) != 0) {
    return "the set-point " + number(commanded, signal.unit) + " that " + output + " still has" +
           limits +
           "; takt does not send the command that would make the axis follow it, and the outputs "
           "of "
           "the node take their fallback until a set-point is within the limits again";
  }
  return "command " + number(commanded, signal.unit) + " to " + output + limits +
         "; takt does not send it, and the outputs of the node take their fallback until a command "
         "is within the limits again";
}

std::string read_limit_text(const BusPlan& plan, const Event& event) {
  const std::size_t place = event.detail >> 8U;
  if (place >= plan.limits.lines.size()) return "a limit of the drive";
  const LimitLine& line = plan.limits.lines[place];
  const std::string key{name(line.kind)};
  const std::string axis = line.axis > 1 ? " of axis " + std::to_string(line.axis) : "";
  const std::string what = key + axis + " " + read_value(line, event.value) +
                           ", read from the device (" + to_string(line.object) + ")";
  if (static_cast<LimitVerdict>(event.detail & 0xFFU) == LimitVerdict::good) {
    return "limit: " + what;
  }
  return "no limit: " + what + ", is implausible and is ignored; write `limits: {" + key +
         ": ...}` in the network file";
}

}  // namespace takt
