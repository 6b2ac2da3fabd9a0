#pragma once
#include <cstdint>

namespace takt {

/// Why the CAN interface accepted no more frames: Event::detail of `send_buffer_full`.
enum class SendTrouble : std::uint32_t {
  queue_too_short,  ///< The bus is healthy, but txqueuelen is below the number of frames that one
                    ///< cycle sends.
  nobody_acknowledges,  ///< The controller is error passive: cable, bit rate, or no other node.
  /// The controller is bus-off.
  bus_off,
};

/// Why SYNC periods were skipped: Event::detail of `cycles_missed`.
enum class MissedBecause : std::uint32_t {
  late,          ///< The bus thread did not run in time.
  wire_blocked,  ///< The controller is bus-off, or no node acknowledges the previous SYNC.
  sent_late,     ///< The bus thread was late with the previous SYNC, which was not on the wire yet.
  not_seen,  ///< The previous SYNC was not seen on the wire, and the controller reports no error.
};

}  // namespace takt
