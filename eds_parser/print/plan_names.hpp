#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/run_options.hpp"

namespace takt {

/// `write if differs`.
std::string_view action_name(BootAction action) noexcept;
/// `start`, `reset communication`.
std::string_view command_name(NmtCommand command) noexcept;
/// The value of a step as a number (up to 8 bytes) or as hex pairs.
std::string value_text(const BootStep& step);
/// Microseconds without fraction: `2000 us`.
std::string us_text(Time time);
/// Milliseconds where that is exact, else microseconds.
std::string span_text(Time time);

/// A LCM channel of the daemon and the type that it carries.
struct LcmChannel {
  std::string name;
  std::string type;
  std::string content;
};
std::vector<LcmChannel> lcm_channels(const BusPlan& plan, const LcmOptions& options);

}  // namespace takt
