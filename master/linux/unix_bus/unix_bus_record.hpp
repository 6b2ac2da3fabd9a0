#pragma once
#include <cstdint>
#include <type_traits>

#include "master/linux/can/can_frame.hpp"

namespace takt {

/// One message of the bus between processes: a frame, the time at which the hub had it, and the
/// number of frames that the receiver has lost. All processes run on one machine, so the message
/// has the layout of the memory.
struct UnixBusRecord {
  static constexpr std::uint32_t signature = 0x544B'0001;  ///< "TK", version 1

  std::uint32_t magic = signature;
  std::uint32_t can_id = 0;  ///< identifier with the flags of SocketCAN
  std::uint8_t length = 0;   ///< 0..8
  std::uint8_t own = 0;      ///< 1 if the receiver itself has sent the frame
  std::uint16_t reserved = 0;
  std::uint32_t lost = 0;  ///< frames that this receiver was too slow for since it connected
  std::uint8_t data[8]{};
  /// Monotonic time in ns: set by the hub, or by the sender on a bus of two members.
  std::int64_t when = 0;
};
static_assert(sizeof(UnixBusRecord) == 32);
static_assert(std::is_trivially_copyable_v<UnixBusRecord>);

inline UnixBusRecord to_record(const Frame& frame) noexcept {
  UnixBusRecord record;
  record.can_id = kernel_id(frame);
  record.length = frame.length;
  std::memcpy(record.data, frame.data.data(), sizeof record.data);
  return record;
}

inline bool valid(const UnixBusRecord& record) noexcept {
  return record.magic == UnixBusRecord::signature && record.length <= 8;
}

}  // namespace takt
