#pragma once
#include <iosfwd>
#include <optional>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/run_options.hpp"

namespace takt {

/// What of a plan to print.
struct PlanPrint {
  std::optional<NodeId> node;  ///< only this node
  RealtimeOptions realtime;
  LcmOptions lcm;
};

/// The plan for people: bus, cycle with its time budget, nodes with their PDOs, image, LCM
/// channels, boot plans step by step with the bytes of every frame.
void print_plan_text(std::ostream& out, const BusPlan& plan, const PlanPrint& what);

/// The same as one JSON document. Times in microseconds, bytes as hex pairs.
void print_plan_json(std::ostream& out, const BusPlan& plan, const PlanPrint& what);

}  // namespace takt
