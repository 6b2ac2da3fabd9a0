#pragma once
#include <cstdint>

namespace takt {

/// Why the interface took no more frames: Event::detail of `send_buffer_full`.
enum class SendTrouble : std::uint32_t {
  queue_too_short,      ///< healthy bus, txqueuelen below what one cycle sends
  nobody_acknowledges,  ///< error passive: cable, bit rate, or no other node
  bus_off,
};

/// Why periods went by without SYNC: Event::detail of `cycles_missed`.
enum class MissedBecause : std::uint32_t {
  late,          ///< the bus thread did not run in time
  wire_blocked,  ///< the controller is bus-off, or nobody acknowledges the SYNC before
  sent_late,     ///< the bus thread was late with the SYNC before, which was not on the wire yet
  not_seen,      ///< the SYNC before was not seen on the wire, and the controller reports no error
};

}  // namespace takt
