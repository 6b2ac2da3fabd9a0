#pragma once
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <ostream>

#include "eds_parser/report/source.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/run_options.hpp"

namespace takt {

/// The parts of a plan to print, and the options for printing.
struct PlanPrint {
  std::optional<NodeId> node;  ///< only this node; empty = all nodes
  RealtimeOptions realtime;
  LcmOptions lcm;
};

/// Prints the plan for the user: bus, cycle with its time budget, nodes with their PDOs, image, LCM
/// channels, and boot plans step by step with the bytes of every frame.
void print_plan_text(std::ostream& out, const BusPlan& plan, const PlanPrint& what);

/// Prints one screen of 24 lines: nodes, axes, cycle, load by PDOs, limits with their sources, and
/// findings. A line has at most `width` columns (80 or more), unless a single word is longer.
void print_plan_brief(std::ostream& out, const BusPlan& plan, const Findings& findings,
                      std::size_t width = 80);

/// Prints the plan as one JSON document. Times are in microseconds, bytes are hex pairs.
void print_plan_json(std::ostream& out, const BusPlan& plan, const PlanPrint& what);

}  // namespace takt
