#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"

namespace takt::sim {

/// Deviations of a device family from CiA 301 in its PDOs and its SYNC. The defaults conform to CiA
/// 301.
struct DeviceTraits {
  enum class Timer : std::uint8_t {
    restarts,    ///< every transmission restarts the timer, whatever triggered it
    own_raster,  ///< only expiry restarts the timer; frames sent by events do not shift it
    alone,       ///< while the timer is set, changes of values send nothing
  };

  Timer timer = Timer::restarts;
  bool timer_at_sync = false;     ///< type 0: expiry of the event timer is an event
  bool compares_samples = false;  ///< type 0: a change counts only if it is still present at SYNC
  bool answers_255 = false;       ///< type 255 without event timer: RPDO n triggers TPDO n
  bool reports_state_at_start = true;  ///< event-driven TPDOs are sent once on entering OPERATIONAL
  bool answers_rtr = true;     ///< answers remote requests if bit 30 of the COB-ID allows them
  bool produces_sync = false;  ///< bit 30 of 0x1005 may be set
  Time inhibit_unit = std::chrono::microseconds{100};  ///< unit of the inhibit time 0x1800:03
  Time inhibit_floor{};  ///< minimum; shorter inhibit times, including 0, become this
};

}  // namespace takt::sim
