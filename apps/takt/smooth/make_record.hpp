#pragma once
#include "apps/takt/smooth/judge/bus_record.hpp"
#include "apps/takt/smooth/pdo_map.hpp"
#include "apps/takt/smooth/trace.hpp"

namespace takt::smooth {

/// Finds the axes of a map, without samples: all that have a set-point in an RPDO. If an axis has
/// set-points of several modes, it comes once for each of them; keep_used_set_points() decides.
std::vector<AxisRecord> axes_of(const PdoMap& map);

/// Leaves, of the set-points of one axis, the one of the mode in which the axis mostly was.
void keep_used_set_points(std::vector<AxisRecord>& axes);

/// Returns where the samples of a signal of an axis go, or null if it does not matter. `output` is
/// true for a signal of an RPDO.
std::vector<Sample>* samples_of(AxisRecord& axis, ObjectKey object, bool output);

/// Takes the signals of all axes from the frames.
BusRecord make_record(const Trace& trace, const PdoMap& map);

}  // namespace takt::smooth
