#pragma once
#include <cstdint>

namespace takt::sim {

/// What is wrong with the SDO server of a device, or merely its own way. Block transfers are
/// counted in segments from 1; 0: does not happen.
struct SdoFaults {
  bool refuse_block = false;       ///< knows no block transfer: 0504 0001
  bool mute_block = false;         ///< gives no answer to the beginning of one
  bool no_crc = false;             ///< can't compute one
  std::uint8_t block_size = 127;   ///< segments of a sub-block
  unsigned lose_segment = 0;       ///< this one vanishes, once, in each transfer
  unsigned silent_after = 0;       ///< says nothing more after so many segments
  unsigned abort_after = 0;        ///< aborts with 0800 0000 after so many segments
  bool wrong_crc = false;          ///< sends another one, and finds another one
  bool wrong_ackseq = false;       ///< confirms more segments than were sent
  bool early_confirm = false;      ///< confirms as soon as a segment is missing
  bool wrong_block_size = false;   ///< offers sub-blocks of 0 segments
  int announce_more = 0;           ///< bytes added to the size that is announced; may be negative
  bool no_size = false;            ///< expedited answers without size, others without announcement
  std::uint8_t pad_expedited = 0;  ///< expedited answers have at least so many bytes
};

}  // namespace takt::sim
