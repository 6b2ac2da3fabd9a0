#include "eds_parser/print/plan/plan_diff.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/report/text_diff.hpp"
#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

enum class Part : std::uint8_t { bus, node, image, limits, lcm, boot };

/// Key that sorts sections in the order of a plan: all nodes, then all boots.
using Key = std::pair<Part, unsigned>;
using Sections = std::map<Key, std::string>;

bool is_heading(std::string_view line) { return !line.empty() && line.front() != ' '; }

template <class Add>
std::string text_of(const Add& add) {
  std::ostringstream out;
  PlanLines lines{out};
  add(lines);
  return std::move(out).str();
}

/// Removes positions, which shift if a line is added or removed:
/// `    12 in  arm.x` becomes `  in  arm.x`.
std::string without_numbers(const std::string& text) {
  std::string out;
  for (const std::string_view line : lines_of(text)) {
    const std::size_t word = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t end = std::min(line.find_first_not_of("0123456789", word), line.size());
    const bool numbered = word >= 2 && end > word && end < line.size() && line[end] == ' ';
    std::string kept = numbered ? "  " + std::string{line.substr(end + 1)} : std::string{line};
    const std::size_t target = kept.find("-> ");  // a skip also names the number of a step
    if (numbered && target != std::string::npos) {
      const std::size_t digits = kept.find_first_not_of("0123456789", target + 3);
      kept.erase(target, digits == std::string::npos ? digits : digits - target);
    }
    out += kept + '\n';
  }
  return out;
}

/// Removes padding. Columns are as wide as their longest entry, so one more line would change all
/// others.
std::string without_padding(const std::string& text) {
  std::string out;
  for (const std::string_view line : lines_of(text)) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    out += line.substr(0, begin);
    for (std::size_t i = begin; i < line.size(); ++i) {
      const bool third = i >= begin + 2 && line.substr(i - 2, 3) == "   ";
      if (!third) out += line[i];
    }
    out += '\n';
  }
  return out;
}

/// Removes the folder of the device file, because two plans often reach the same file by different
/// paths.
std::string without_folder(std::string text, const NodePlan& node) {
  const std::string& path = node.description_file;
  const std::size_t name = path.find_last_of('/') + 1;  // npos + 1 = 0 if there is no folder
  const std::size_t at = name == 0 ? std::string::npos : text.find('(' + path + ')');
  if (at != std::string::npos) text.erase(at + 1, name);
  return text;
}

/// Adds the sections of one node, or of all nodes.
void add_node_sections(Sections& sections, const BusPlan& plan, std::optional<NodeId> only) {
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    const NodePlan& node = plan.nodes[i];
    if (only && *only != node.id) continue;
    sections[{Part::node, node.id.value()}] =
        without_folder(text_of([&](PlanLines& lines) { add_node(lines, plan, i); }), node);
    sections[{Part::boot, node.id.value()}] =
        without_numbers(text_of([&](PlanLines& lines) { add_boot(lines, node); }));
  }
}

Sections sections_of(const BusPlan& plan, std::optional<NodeId> only) {
  Sections sections;
  if (!only) {
    sections[{Part::bus, 0}] = text_of([&](PlanLines& lines) {
      add_bus(lines, plan, {});
      add_cycle(lines, plan);
    });
    sections[{Part::lcm, 0}] =
        without_padding(text_of([&](PlanLines& lines) { add_lcm(lines, plan, {}); }));
  }
  sections[{Part::image, 0}] =
      without_padding(without_numbers(text_of([&](PlanLines& l) { add_image(l, plan, only); })));
  sections[{Part::limits, 0}] =
      without_padding(text_of([&](PlanLines& lines) { add_limits(lines, plan, only); }));
  add_node_sections(sections, plan, only);
  return sections;
}

std::set<Key> keys_of(const Sections& before, const Sections& after) {
  std::set<Key> keys;
  for (const Sections* side : {&before, &after}) {
    for (const auto& [key, text] : *side) keys.insert(key);
  }
  return keys;
}

std::vector<DiffLine> lines_of_key(const Sections& before, const Sections& after, const Key& key) {
  const auto of = [&key](const Sections& side) {
    const auto found = side.find(key);
    return found == side.end() ? std::vector<std::string_view>{} : lines_of(found->second);
  };
  return diff_lines(of(before), of(after));
}

/// The sections of both sides of a comparison.
struct Compared {
  Sections before;
  Sections after;
};

std::string text_of(const Compared& sides, const std::string& before_name,
                    const std::string& after_name) {
  std::vector<DiffLine> lines;
  for (const Key& key : keys_of(sides.before, sides.after)) {
    std::ranges::move(lines_of_key(sides.before, sides.after, key), std::back_inserter(lines));
  }
  const std::string hunks = unified_hunks(lines, is_heading);
  return hunks.empty() ? "" : "--- " + before_name + "\n+++ " + after_name + '\n' + hunks;
}

std::string_view part_name(Part part) {
  static constexpr std::string_view names[]{"bus", "node", "image", "limits", "lcm", "boot"};
  return name_of(part, names);
}

std::vector<PlanChange> changes_of(const Compared& sides) {
  std::vector<PlanChange> changes;
  for (const Key& key : keys_of(sides.before, sides.after)) {
    const auto& [part, id] = key;
    PlanChange change{.part = part_name(part), .node = NodeId::from(id)};
    for (const DiffLine& line : lines_of_key(sides.before, sides.after, key)) {
      if (line.kind == DiffLine::Kind::same) continue;
      auto& side = line.kind == DiffLine::Kind::removed ? change.removed : change.added;
      side.emplace_back(trim(line.text));
    }
    if (!change.removed.empty() || !change.added.empty()) changes.push_back(std::move(change));
  }
  return changes;
}

Compared compare(const BusPlan& before, const BusPlan& after, std::optional<NodeId> only) {
  return {sections_of(before, only), sections_of(after, only)};
}

Compared compare_node(const BusPlan& before, const BusPlan& after, NodeId node) {
  Compared sides;
  add_node_sections(sides.before, before, node);
  add_node_sections(sides.after, after, node);
  return sides;
}

}  // namespace

std::string plan_diff(const PlanSide& before, const PlanSide& after, std::optional<NodeId> only) {
  return text_of(compare(before.plan, after.plan, only), before.name, after.name);
}

std::string node_diff(const PlanSide& before, const PlanSide& after, NodeId node) {
  return text_of(compare_node(before.plan, after.plan, node), before.name, after.name);
}

std::vector<PlanChange> plan_changes(const PlanSide& before, const PlanSide& after,
                                     std::optional<NodeId> only) {
  return changes_of(compare(before.plan, after.plan, only));
}

std::vector<PlanChange> node_changes(const PlanSide& before, const PlanSide& after, NodeId node) {
  return changes_of(compare_node(before.plan, after.plan, node));
}

}  // namespace takt
