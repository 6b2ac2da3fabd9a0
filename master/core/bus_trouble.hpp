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
  wire_blocked,  ///< the SYNC before was not on the wire yet, or the controller is bus-off
};

}  // namespace takt
