#pragma once
#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/run_options.hpp"

namespace takt {

/// Writes the plan's text line by line, without blanks at the ends of lines.
class PlanLines {
 public:
  explicit PlanLines(std::ostream& out) : out_{out} {}

  template <class... T>
  void line(fmt::format_string<T...> format, T&&... values) {
    std::string text = fmt::format(format, std::forward<T>(values)...);
    while (!text.empty() && text.back() == ' ') text.pop_back();
    out_ << text << '\n';
  }

 private:
  std::ostream& out_;
};

// These functions write the sections in their order. All but the first begin with an empty line.
void add_bus(PlanLines& lines, const BusPlan& plan, const RealtimeOptions& realtime);
void add_cycle(PlanLines& lines, const BusPlan& plan);
void add_waits(PlanLines& lines, const BusPlan& plan);
void add_node(PlanLines& lines, const BusPlan& plan, std::size_t index);
void add_image(PlanLines& lines, const BusPlan& plan, const std::optional<NodeId>& only);
/// Writes nothing if no output of the bus could have limits.
void add_limits(PlanLines& lines, const BusPlan& plan, const std::optional<NodeId>& only);
/// Returns one text for each axis or output with limits: its limits, grouped by their sources.
std::vector<std::string> brief_limits(const BusPlan& plan);
void add_lcm(PlanLines& lines, const BusPlan& plan, const LcmOptions& options);
void add_boot(PlanLines& lines, const NodePlan& node);

/// Returns the type, for example `INTEGER16`, or the width in bits if the type is unknown.
std::string bits_text(const Signal& signal);

}  // namespace takt
