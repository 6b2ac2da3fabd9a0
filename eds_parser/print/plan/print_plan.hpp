#pragma once
#include <iosfwd>
#include <optional>
#include <ostream>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/run_options.hpp"

namespace takt {

/// Which parts of a plan to print, and the options to print with it.
struct PlanPrint {
  std::optional<NodeId> node;  ///< only this node; empty = all nodes
  RealtimeOptions realtime;
  LcmOptions lcm;
};

/// Prints the plan for people: bus, cycle with its time budget, nodes with their PDOs, image, LCM
/// channels, and boot plans step by step with the bytes of every frame.
void print_plan_text(std::ostream& out, const BusPlan& plan, const PlanPrint& what);

/// Prints the plan as one JSON document. Times are in microseconds, bytes are hex pairs.
void print_plan_json(std::ostream& out, const BusPlan& plan, const PlanPrint& what);

}  // namespace takt
