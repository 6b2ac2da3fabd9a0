#pragma once
#include <cstdint>

namespace takt::sim {

/// Faults and peculiarities of the SDO server of a device. Counts of segments in block transfers
/// start at 1; 0 means that the fault does not occur.
struct SdoFaults {
  bool refuse_block = false;      ///< supports no block transfer and aborts with 0504 0001
  bool mute_block = false;        ///< does not answer the initiate of a block transfer
  bool no_crc = false;            ///< does not support a CRC
  std::uint8_t block_size = 127;  ///< segments of a sub-block
  unsigned lose_segment = 0;      ///< number of the segment that is lost once in each transfer
  unsigned silent_after = 0;      ///< falls silent after this number of segments
  unsigned abort_after = 0;       ///< aborts with 0800 0000 after this number of segments
  bool wrong_crc = false;         ///< sends a wrong CRC, and computes a wrong one for received data
  bool wrong_ackseq = false;      ///< confirms more segments than were sent
  bool early_confirm = false;     ///< confirms as soon as a segment is missing
  bool wrong_block_size = false;  ///< offers sub-blocks of 0 segments
  int announce_more = 0;          ///< bytes added to the announced size; may be negative
  bool no_size = false;  ///< expedited answers have no size, other answers do not announce it
  std::uint8_t pad_expedited = 0;  ///< minimum size of expedited answers in bytes
};

}  // namespace takt::sim
