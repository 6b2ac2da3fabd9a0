#pragma once
#include <cstdint>

namespace takt {

/// Stage of the ordered stop of a bus.
enum class StopStage : std::uint8_t {
  running,     ///< No stop was requested.
  fallback,    ///< Every output takes its declared fallback.
  quick_stop,  ///< The axes stop quickly; each is disabled after it was seen at standstill.
  disable,     ///< The time is over; axes that are still enabled are disabled.
  disarm,      ///< The supervision of the master by the devices is switched off.
  nmt,         ///< The nodes receive their last NMT command.
  done,        ///< The stop is over; SYNC may end.
};

/// The result of an ordered stop. The numbers are those of `stop` in status_t.
enum class StopResult : std::uint8_t {
  none,         ///< No stop was requested.
  under_way,    ///< The result is not decided yet.
  confirmed,    ///< Every axis was seen at standstill and disabled, or was disabled before.
  unconfirmed,  ///< At least one axis was not seen at standstill and disabled.
};

}  // namespace takt
