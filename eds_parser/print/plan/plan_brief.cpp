#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <ostream>
#include <string>
#include <vector>

#include "eds_parser/plan/cycle_compiler.hpp"
#include "eds_parser/print/names.hpp"
#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"
#include "eds_parser/print/plan/print_plan.hpp"

namespace takt {
namespace {

constexpr std::size_t most_lines = 24;
constexpr std::size_t most_columns = 80;
constexpr std::size_t most_name = 14;
constexpr std::size_t most_kind = 21;

using Rows = std::vector<std::string>;

/// Cuts a UTF-8 text to at most `size` bytes, but not within a character, and marks the cut by `~`.
std::string cut_to(std::string text, std::size_t size) {
  if (text.size() <= size) return text;
  std::size_t end = size - 1;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + '~';
}

/// Appends a text in lines of at most `width` columns. The first line is indented by 2 columns, the
/// others by 6.
void add_wrapped(Rows& rows, std::string_view text, std::size_t width) {
  std::string line = "  ";
  bool begins = true;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (!begins && line.size() + 1 + std::min(word.size(), width - 6) > width) {
      rows.push_back(line);
      line = "      ";
    } else if (!begins) {
      line += ' ';
    }
    line += cut_to(std::string{word}, width - 6);
    begins = false;
  }
  rows.push_back(line);
}

/// Returns for example "1 node" or "3 nodes".
std::string plural(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string watched(const NodePlan& node) {
  if (node.heartbeat_timeout != Time{}) return span_text(node.heartbeat_timeout);
  return node.guard.period == Time{} ? "no" : span_text(node.guard.life_time());
}

bool has_speed_axis(const BusPlan& plan, std::size_t node) {
  return std::ranges::find(plan.speed_axes, node, &SpeedAxisPlan::node_index) !=
         plan.speed_axes.end();
}

/// Returns the number of axes of a node: those with positions, or one if the node follows a set
/// speed.
std::size_t axes_of(const BusPlan& plan, std::size_t node) {
  return has_speed_axis(plan, node) ? 1 : plan.nodes[node].axes.size();
}

std::string kind_of(const BusPlan& plan, std::size_t at) {
  const NodePlan& node = plan.nodes[at];
  std::string text = "I/O or other";
  if (axes_of(plan, at) == 1) text = has_speed_axis(plan, at) ? "speed axis" : "axis";
  if (axes_of(plan, at) > 1) text = fmt::format("{} axes", node.axes.size());
  if (!node.boot) text += ", only watched";
  return node.mandatory ? text + ", mandatory" : text;
}

Rows node_rows(const BusPlan& plan) {
  std::size_t widest = 4;
  for (const NodePlan& node : plan.nodes) widest = std::max(widest, node.name.size());
  widest = std::min(widest, most_name);
  Rows rows;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    const NodePlan& node = plan.nodes[i];
    const auto count = [i](const auto& pdos) {
      return std::ranges::count_if(pdos, [i](const PdoRow& pdo) { return pdo.node_index == i; });
    };
    const std::string row =
        fmt::format("  {:>3} {:<{}}  {:<21} {:>2} TPDO {:>2} RPDO  {}", node.id.value(),
                    cut_to(node.name, widest), widest, cut_to(kind_of(plan, i), most_kind),
                    count(plan.pdos.tpdos), count(plan.pdos.rpdos),
                    watched(node) == "no" ? "loss not noticed" : "lost after " + watched(node));
    rows.push_back(cut_to(row, most_columns));
  }
  return rows;
}

Rows finding_rows(const Findings& findings, std::size_t width) {
  Rows rows;
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
    for (const Finding& finding : findings) {
      if (finding.severity != severity) continue;
      const std::string file = std::filesystem::path{finding.file}.filename().string();
      add_wrapped(
          rows,
          fmt::format("{}: {}:{}: {}", name(severity), file, finding.pos.line, finding.message),
          width);
    }
  }
  return rows;
}

std::string counted(const Findings& findings) {
  std::array<std::size_t, 3> counts{};
  for (const Finding& finding : findings) ++counts[static_cast<std::size_t>(finding.severity)];
  return fmt::format("findings: {}, {}, {}", plural(counts[2], "error"),
                     plural(counts[1], "warning"), plural(counts[0], "note"));
}

/// Gives each section in turn a line until no section needs more or no line is left.
std::array<std::size_t, 3> shares(const std::array<std::size_t, 3>& wanted, std::size_t lines) {
  std::array<std::size_t, 3> given{};
  bool gave = true;
  while (gave) {
    gave = false;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (given[i] == wanted[i] || lines == 0) continue;
      ++given[i];
      --lines;
      gave = true;
    }
  }
  return given;
}

void add_section(std::ostream& out, std::string_view title, const Rows& rows, std::size_t lines) {
  out << title << '\n';
  const bool whole = lines >= rows.size();
  const std::size_t shown = whole ? rows.size() : lines - std::min<std::size_t>(lines, 1);
  for (std::size_t i = 0; i < shown; ++i) out << rows[i] << '\n';
  if (!whole && lines != 0) out << "  and " << rows.size() - shown << " lines more\n";
}

std::string cycle_text(const BusPlan& plan) {
  const TimeBudget budget = time_budget(plan);
  const double fill = static_cast<double>((budget.inputs_wire + budget.outputs_wire).count()) /
                      static_cast<double>(plan.cycle.period.count());
  return fmt::format("{} {}: TPDOs until {:.0f}, outputs at {:.0f} us; PDO load {:.0f} %",
                     plan.cycle.sync ? "SYNC every" : "no SYNC, cycle of",
                     us_text(plan.cycle.period), us(plan.cycle.receive_window),
                     us(plan.cycle.output_deadline), 100.0 * fill);
}

}  // namespace

void print_plan_brief(std::ostream& out, const BusPlan& plan, const Findings& findings,
                      std::size_t width) {
  const Rows nodes = node_rows(plan);
  Rows limits;
  for (const std::string& text : brief_limits(plan)) add_wrapped(limits, text, width);
  const Rows notes = finding_rows(findings, width);
  std::size_t axes = 0;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) axes += axes_of(plan, i);
  constexpr std::size_t titles = 5;
  const auto lines = shares({nodes.size(), limits.size(), notes.size()}, most_lines - titles);
  const std::string head =
      fmt::format("bus {}: {}, {} {} at {} kbit/s, {}", plan.name,
                  plural(plan.nodes.size(), "node"), axes, axes == 1 ? "axis" : "axes",
                  plan.bitrate / 1000, plan.interface.empty() ? "simulated" : plan.interface);
  out << cut_to(head, width) << '\n' << cycle_text(plan) << '\n';
  add_section(out, "nodes:", nodes, lines[0]);
  add_section(out, limits.empty() ? "limits of commands: none" : "limits of commands, by source:",
              limits, lines[1]);
  add_section(out, counted(findings), notes, lines[2]);
}

}  // namespace takt
