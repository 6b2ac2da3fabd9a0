#include <algorithm>
#include <string>

#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"

namespace takt {
namespace {

std::string number(double value) { return fmt::format("{:.6g}", value); }

class ImageText {
 public:
  ImageText(PlanLines& lines, const BusPlan& plan, const std::optional<NodeId>& only)
      : lines_{lines}, plan_{plan}, only_{only} {}

  void image() {
    lines_.line("");
    if (!only_) {
      lines_.line("image: {} inputs, {} outputs, layout {:016x}", plan_.layout.inputs,
                  plan_.layout.outputs(), plan_.layout.hash);
    } else {
      lines_.line("image:");
    }
    std::size_t widest = 10;
    for (const Signal& signal : plan_.layout.signals) {
      if (wanted(signal.node)) widest = std::max(widest, full_name(signal).size());
    }
    for (std::size_t i = 0; i < plan_.layout.signals.size(); ++i) {
      const Signal& signal = plan_.layout.signals[i];
      if (wanted(signal.node)) value(i, signal, widest);
    }
  }

 private:
  bool wanted(NodeId id) const { return !only_ || *only_ == id; }

  std::string full_name(const Signal& signal) const {
    return plan_.nodes[signal.node_index].name + "." + signal.name;
  }

  void value(std::size_t i, const Signal& signal, std::size_t widest) {
    const std::string unit =
        signal.unit.empty() && signal.scale == 1.0 && signal.offset == 0.0
            ? ""
            : fmt::format("  x {}{} {}", number(signal.scale),
                          signal.offset == 0.0 ? "" : " + " + number(signal.offset), signal.unit);
    lines_.line("  {:>4} {} {:<{}}  {} {:<10}{}{}", i, signal.output ? "out" : "in ",
                full_name(signal), widest, to_string(signal.object), bits_text(signal), unit,
                signal.output ? output_text(signal) : "");
  }

  std::string output_text(const Signal& signal) const {
    std::string text = "  first ";
    if (signal.safe_value) {
      text += std::to_string(*signal.safe_value);
    } else if (signal.seeded_from) {
      text += plan_.layout.signals[*signal.seeded_from].name;
    } else {
      text += "when commanded";
    }
    text += "; ";
    if (signal.fallback_cycles == 0) return text + "a command has no time limit";
    text += fmt::format("after {} cycle{} ", signal.fallback_cycles,
                        signal.fallback_cycles == 1 ? "" : "s");
    return text + (signal.fallback == Fallback::hold ? "held" : fallback_text(signal));
  }

  static std::string fallback_text(const Signal& signal) {
    const auto raw = static_cast<std::uint64_t>(signal.fallback_value);
    const bool controlword = signal.object.index % 0x800 == 0x40 && signal.bits == 16;
    return controlword ? fmt::format("0x{:04X}", raw) : std::to_string(signal.fallback_value);
  }

  PlanLines& lines_;
  const BusPlan& plan_;
  const std::optional<NodeId>& only_;
};

}  // namespace

void add_image(PlanLines& lines, const BusPlan& plan, const std::optional<NodeId>& only) {
  ImageText{lines, plan, only}.image();
}

}  // namespace takt
