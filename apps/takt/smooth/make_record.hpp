#pragma once
#include "apps/takt/smooth/judge/bus_record.hpp"
#include "apps/takt/smooth/pdo_map.hpp"
#include "apps/takt/smooth/trace.hpp"

namespace takt::smooth {

/// Finds the axes of a map, without samples: all that have a set-point in an RPDO. An axis with
/// set-points of several modes is in the list once for each of them; keep_used_set_points() selects
/// one.
std::vector<AxisRecord> axes_of(const PdoMap& map);

/// Keeps for each axis only the set-point of the mode in which the axis was for the longest time.
void keep_used_set_points(std::vector<AxisRecord>& axes);

/// Returns the list that takes the samples of a signal of an axis, or null if the signal is not
/// judged. `output` is true for a signal of an RPDO.
std::vector<Sample>* samples_of(AxisRecord& axis, ObjectKey object, bool output);

/// Extracts the signals of all axes from the frames.
BusRecord make_record(const Trace& trace, const PdoMap& map);

}  // namespace takt::smooth
