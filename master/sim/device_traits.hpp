#pragma once
#include <cstdint>

#include "eds_parser/table/time.hpp"

namespace takt::sim {

/// How the PDOs and the SYNC of a family of devices deviate from CiA 301; the defaults are 301.
struct DeviceTraits {
  enum class Timer : std::uint8_t {
    restarts,    ///< at every transmission, whatever triggered it
    own_raster,  ///< only when it has run out: frames sent by events do not shift it
    alone,       ///< while it is set, changes send nothing
  };

  Timer timer = Timer::restarts;
  bool timer_at_sync = false;        ///< type 0: the event timer running out is an event
  bool compares_samples = false;     ///< type 0: a change counts only if SYNC still finds it
  bool answers_255 = false;          ///< type 255 without timer: TPDO n is sent when RPDO n came
  bool tells_state_at_start = true;  ///< event-driven TPDOs are sent once on entering OPERATIONAL
  bool answers_rtr = true;           ///< remote requests, where bit 30 of the COB-ID lets them
  bool produces_sync = false;        ///< bit 30 of 0x1005 may be set
  Time inhibit_unit = std::chrono::microseconds{100};  ///< of 0x1800:03
  Time inhibit_floor{};  ///< shorter inhibit times, 0 as well, are taken as this
};

}  // namespace takt::sim
