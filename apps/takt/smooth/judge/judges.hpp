#pragma once
#include <vector>

#include "apps/takt/smooth/judge/axis_cycles.hpp"
#include "apps/takt/smooth/judge/bus_record.hpp"
#include "apps/takt/smooth/judge/finding.hpp"
#include "apps/takt/smooth/judge/sync_grid.hpp"

namespace takt::smooth {

/// The data of an axis for the judges.
struct AxisView {
  const BusRecord& bus;
  const SyncGrid& sync;
  const AxisRecord& axis;
  const AxisCycles& cycles;
};

using Findings = std::vector<Finding>;

/// Each judge adds findings of one kind.
void judge_sync(const BusRecord& bus, const SyncGrid& sync, Findings& findings);
void judge_settings(const AxisView& view, Findings& findings);
void judge_senders(const AxisView& view, Findings& findings);
void judge_arrivals(const AxisView& view, Findings& findings);
void judge_values(const AxisView& view, Findings& findings);
void judge_shape(const AxisView& view, Findings& findings);
void judge_drive(const AxisView& view, Findings& findings);

/// Finds axes that get the set-points of one motion some cycles later than another axis. The
/// findings are added to `findings` at the position of the axis.
void judge_group(const std::vector<AxisView>& axes, std::vector<Findings>& findings);

}  // namespace takt::smooth
