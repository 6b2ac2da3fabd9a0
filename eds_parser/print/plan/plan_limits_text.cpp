#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"
#include "eds_parser/table/output_limits.hpp"

namespace takt {
namespace {

std::string owner(const BusPlan& plan, const LimitLine& line) {
  const std::string& node = plan.nodes[line.node_index].name;
  if (line.axis == 0) return node + " " + to_string(line.object);
  return line.axis == 1 ? node : fmt::format("{}.{}", node, line.axis);
}

/// Returns for example `-1.5 .. 1.5 rad`, `2 rad/s` or `from 3 V`.
std::string value(const LimitLine& line) {
  if (line.source == LimitSource::none) return "none";
  const bool bounds = line.kind == LimitKind::position || line.kind == LimitKind::range;
  std::string text;
  if (!line.low && !line.high) {
    text = "as the device says";
  } else if (!bounds) {
    text = number_text(line.high.value_or(0.0));
  } else if (line.low && line.high) {
    text = number_text(*line.low) + " .. " + number_text(*line.high);
  } else {
    text = line.low ? "from " + number_text(*line.low) : "up to " + number_text(*line.high);
  }
  return line.unit.empty() ? text : text + " " + line.unit;
}

/// Returns for example `, of the sum 60FF:00 + 60B1:00`, or nothing if no offset is added.
std::string sums(const BusPlan& plan, const LimitLine& line) {
  std::string text;
  for (const LimitSum& sum : sums_of(plan.limits, line)) {
    text += (text.empty() ? ", of the sum " : " and ") +
            to_string(plan.layout.signals[sum.target].object) + " + " +
            to_string(plan.layout.signals[sum.offset].object);
  }
  return text;
}

std::string source(const BusPlan& plan, const LimitLine& line) {
  const bool for_motions = line.kind == LimitKind::jerk || line.kind == LimitKind::following_error;
  const std::string unchecked = for_motions ? ", used for planned motion only"
                                            : ", not checked: no output carries this value";
  switch (line.source) {
    case LimitSource::none:
      return fmt::format("proposal: `{}` ({})", line.proposal, line.because);
    case LimitSource::file:
      return "from the network file" + (line.signals.empty() ? unchecked : sums(plan, line));
    case LimitSource::device:
      return "read from the device at boot, " + to_string(line.object) + sums(plan, line);
  }
  return {};
}

}  // namespace

void add_limits(PlanLines& lines, const BusPlan& plan, const std::optional<NodeId>& only) {
  const auto wanted = [&](const LimitLine& line) {
    return !only || *only == plan.nodes[line.node_index].id;
  };
  if (std::ranges::none_of(plan.limits.lines, wanted)) return;
  lines.line("");
  lines.line(
      "limits of commands; the master does not send values outside them, and the node takes its "
      "fallback:");
  std::size_t widest_owner = 0;
  std::size_t widest_value = 0;
  for (const LimitLine& line : plan.limits.lines) {
    if (!wanted(line)) continue;
    widest_owner = std::max(widest_owner, owner(plan, line).size());
    widest_value = std::max(widest_value, value(line).size());
  }
  for (const LimitLine& line : plan.limits.lines) {
    if (!wanted(line)) continue;
    lines.line("  {:<{}}  {:<12}  {:<{}}  {}", owner(plan, line), widest_owner, name(line.kind),
               value(line), widest_value, source(plan, line));
  }
}

std::vector<std::string> brief_limits(const BusPlan& plan) {
  struct Owner {
    std::string name;
    std::string file{};
    std::string device{};
    std::string none{};
  };
  std::vector<Owner> owners;
  for (const LimitLine& line : plan.limits.lines) {
    const std::string of = owner(plan, line);
    if (owners.empty() || owners.back().name != of) owners.push_back({.name = of});
    Owner& last = owners.back();
    const bool from_device = line.source == LimitSource::device;
    const bool from_file = line.source == LimitSource::file;
    std::string& text = from_file ? last.file : from_device ? last.device : last.none;
    if (!text.empty()) text += ", ";
    text += name(line.kind);
    if (from_file) text += " " + value(line);
    if (from_device) text += " " + to_string(line.object);
  }
  std::vector<std::string> texts;
  for (const Owner& each : owners) {
    std::string text = each.name + ":";
    if (!each.file.empty()) text += " file: " + each.file + ";";
    if (!each.device.empty()) text += " device: " + each.device + ";";
    if (!each.none.empty()) text += " none: " + each.none + ";";
    text.pop_back();
    texts.push_back(std::move(text));
  }
  return texts;
}

}  // namespace takt
