#pragma once
#include <cstddef>
#include <cstdint>
#include <expected>
#include <string>
#include <takt/signal_t.hpp>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "master/units/units.hpp"

namespace takt::logging {

/// A signal that is recorded.
struct LoggedSignal {
  std::string node;
  std::string name;
  ObjectKey object{};
  std::string unit{};  ///< unit, for example "rad"; empty: counts
  ValueFormat format{};
  std::size_t position = 0;  ///< position in the layout

  std::string full_name() const { return node + '.' + name; }
};

/// Returns the signals of the layout that the patterns match, in the order of the patterns, and
/// each signal once. A pattern is `node.name` and may contain `*`, `?` and `[...]`. No pattern
/// means all signals. The error is a sentence that names a pattern that matches no signal.
std::expected<std::vector<LoggedSignal>, std::string> choose_signals(
    const std::vector<signal_t>& layout, const std::vector<std::string>& patterns);

/// Appends the value in the unit of the signal: an integer if the signal has no scale, otherwise
/// the digits that its raw value has. Appends nothing and returns false if the value is not a
/// finite number.
bool append_value(std::string& out, const ValueFormat& format, std::int64_t raw);

}  // namespace takt::logging
