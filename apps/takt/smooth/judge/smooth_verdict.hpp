#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/takt/smooth/judge/axis_cycles.hpp"
#include "apps/takt/smooth/judge/bus_record.hpp"
#include "apps/takt/smooth/judge/finding.hpp"
#include "apps/takt/smooth/judge/sync_grid.hpp"

namespace takt::smooth {

/// The result for one axis. Times count from the beginning of the recording.
struct AxisVerdict {
  std::string name{};
  std::uint8_t node = 0;
  unsigned axis = 0;  ///< counts from 0
  ObjectKey set_point{};
  CobId set_point_id{};
  std::uint64_t set_points = 0;  ///< number of frames with the set-point
  std::uint64_t cycles = 0;      ///< number of all cycles
  std::uint64_t moving = 0;      ///< cycles in motion
  std::uint64_t without = 0;     ///< cycles in motion without a set-point
  std::uint64_t with_two = 0;    ///< cycles in motion with more than one set-point
  Time period{};                 ///< nominal time between two set-points
  Time interpolation{};          ///< 60C2; 0 = not known
  double peak_velocity = 0;      ///< peak velocity of the set-points, increments per second
  std::vector<Finding> findings{};
};

/// The result for a recording.
struct Verdict {
  std::string source{};
  Time length{};
  SyncGrid sync{};
  std::vector<Finding> findings{};  ///< findings about SYNC
  std::vector<AxisVerdict> axes{};
  std::vector<std::string> remarks{};
  /// Returns true if there is a finding of severity `error`.
  bool rough() const;
};

/// Finds the causes of rough motions in a recording. A cause that follows from another one is left
/// out.
Verdict judge(const BusRecord& bus);

}  // namespace takt::smooth
