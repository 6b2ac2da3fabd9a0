#include <algorithm>
#include <string>

#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"

namespace takt {
namespace {

std::string fallback_text(const Signal& signal) {
  if (signal.fallback == Fallback::hold) return "held";
  const bool controlword = signal.object.index % 0x800 == 0x40 && signal.bits == 16;
  if (!controlword) return std::to_string(signal.fallback_value);
  return fmt::format("0x{:04X}", static_cast<std::uint64_t>(signal.fallback_value));
}

std::string output_text(const BusPlan& plan, const Signal& signal) {
  const std::string first = signal.safe_value    ? std::to_string(*signal.safe_value)
                            : signal.seeded_from ? plan.layout.signals[*signal.seeded_from].name
                                                 : "when commanded";
  if (signal.fallback_cycles == 0) {
    return fmt::format("  first {}; a command has no time limit", first);
  }
  return fmt::format("  first {}; after {} cycle{} {}", first, signal.fallback_cycles,
                     signal.fallback_cycles == 1 ? "" : "s", fallback_text(signal));
}

std::string unit_text(const Signal& signal) {
  if (signal.unit.empty() && signal.scale == 1.0 && signal.offset == 0.0) return {};
  return fmt::format("  x {}{} {}", number_text(signal.scale),
                     signal.offset == 0.0 ? "" : " + " + number_text(signal.offset), signal.unit);
}

}  // namespace

void add_image(PlanLines& lines, const BusPlan& plan, const std::optional<NodeId>& only) {
  const ImageLayout& layout = plan.layout;
  const auto wanted = [&](const Signal& signal) { return !only || *only == signal.node; };
  const auto full_name = [&](const Signal& signal) {
    return plan.nodes[signal.node_index].name + "." + signal.name;
  };
  lines.line("");
  lines.line("image:{}", only ? ""
                              : fmt::format(" {} inputs, {} outputs, layout {:016x}", layout.inputs,
                                            layout.outputs(), layout.hash));
  std::size_t widest = 10;
  for (const Signal& signal : layout.signals) {
    if (wanted(signal)) widest = std::max(widest, full_name(signal).size());
  }
  for (std::size_t i = 0; i < layout.signals.size(); ++i) {
    const Signal& signal = layout.signals[i];
    if (!wanted(signal)) continue;
    lines.line("  {:>4} {} {:<{}}  {} {:<10}{}{}", i, signal.output ? "out" : "in ",
               full_name(signal), widest, to_string(signal.object), bits_text(signal),
               unit_text(signal), signal.output ? output_text(plan, signal) : "");
  }
}

}  // namespace takt
