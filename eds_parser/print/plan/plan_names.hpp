#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/run_options.hpp"

namespace takt {

/// Returns the action in words, for example `write if differs`.
std::string_view action_name(BootAction action) noexcept;
/// Returns the command in words, for example `start` or `reset communication`.
std::string_view command_name(NmtCommand command) noexcept;
/// Formats the value of a step as a number (up to 8 bytes) or as hex pairs.
std::string value_text(const BootStep& step);
/// Formats a value of the network file with at most six digits.
std::string number_text(double value);
/// Formats a time in microseconds without fraction, for example `2000 us`.
std::string us_text(Time time);
/// Formats a time in milliseconds; below 10 ms in microseconds if it has a fraction.
std::string span_text(Time time);

/// An LCM channel of the daemon and the type that it carries.
struct LcmChannel {
  std::string name;
  std::string type;
  std::string content;
};
std::vector<LcmChannel> lcm_channels(const BusPlan& plan, const LcmOptions& options);

}  // namespace takt
