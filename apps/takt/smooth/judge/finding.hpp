#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt::smooth {

/// The causes of a rough motion of an axis, the most fundamental cause first. Findings of one
/// severity are listed in this order.
enum class Cause : std::uint8_t {
  no_sync,               ///< there is no SYNC on the bus
  two_sync_producers,    ///< SYNC comes twice in a period
  sync_missing,          ///< periods without SYNC
  sync_jitter,           ///< SYNC itself is not punctual
  left_operation,        ///< the drive leaves Operation enabled in motion
  mode_changed,          ///< the drive changes its mode in motion
  two_senders,           ///< two programs write one set-point
  not_synchronous,       ///< the RPDO takes effect when it arrives
  interpolation_period,  ///< 60C2 is not the period of the set-points
  clock_beat,            ///< the sender has another clock than SYNC
  bus_load,              ///< other frames delay set-points beyond the next SYNC
  late,                  ///< set-points arrive after the SYNC for which they were meant
  early,    ///< set-points arrive before the SYNC that precedes the one for which they were meant
  skipped,  ///< no set-point between two SYNCs
  overwritten,          ///< two set-points between two SYNCs
  slow_values,          ///< the value changes only every n-th cycle
  value_beat,           ///< values are computed with another clock than SYNC
  duplicated,           ///< a value is sent twice
  value_skipped,        ///< a value is left out
  velocity_jump,        ///< the velocity jumps from one cycle to the next
  set_point_ripple,     ///< the set-points are not on a smooth curve
  coarse,               ///< one increment is a large part of the velocity
  lag_in_group,         ///< an axis gets its set-points later than another one
  interpolation_unset,  ///< 60C2 is not written
  feed_forward,         ///< following error in proportion to the velocity
  actual_ripple,        ///< the drive itself causes a ripple of the actual velocity
};

/// Returns the name of a cause in JSON, which never changes.
const char* name_of(Cause cause) noexcept;

enum class Gravity : std::uint8_t { error, warning };

/// One cause of roughness, with sentences for the user.
struct Finding {
  Cause cause{};
  Gravity gravity = Gravity::error;
  std::string text{};       ///< the observation, with its figures
  std::string remedy{};     ///< advice for the user
  std::uint64_t count = 0;  ///< number of times that it was seen; 0 = all the time
  Time first{};             ///< time at which it was seen first
};

/// Puts errors before warnings and, within them, fundamental causes first.
void sort_findings(std::vector<Finding>& findings);

}  // namespace takt::smooth
