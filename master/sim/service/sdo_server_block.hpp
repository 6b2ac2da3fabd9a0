#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "master/sim/dictionary/abort.hpp"
#include "master/sim/service/sdo_faults.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// Returns the CRC of block transfers, bit by bit. CiA 301, 7.2.4.3.16.
std::uint16_t block_crc(std::span<const std::byte> data) noexcept;

using SdoBytes = std::array<std::uint8_t, 8>;

/// The server side of a block download, from the accepted initiate to the end. CiA 301, 7.2.4.3.9.
class BlockReceiver {
 public:
  enum class Then : std::uint8_t {
    wait,     ///< wait for more segments
    confirm,  ///< send confirmation()
    finish,   ///< all data is there: write it, then confirm the end
    abort,    ///< abort with code()
  };

  void begin(bool crc, std::uint8_t segments, bool size_known, std::size_t size) noexcept;
  Then on_segment(const SdoBytes& frame, const SdoFaults& faults, std::vector<std::byte>& data);
  Then on_end(const SdoBytes& frame, std::vector<std::byte>& data);
  /// Handles silence of the client in the middle of a sub-block. The server confirms the segments
  /// received so far; if there are none, it aborts with a timeout.
  Then on_silence() noexcept;

  bool awaits_end() const noexcept { return all_ && !in_block_; }
  SdoBytes confirmation(const SdoFaults& faults) noexcept;
  Abort code() const noexcept { return code_; }

 private:
  Then refuse(Abort code) noexcept;

  bool crc_ = false;
  bool size_known_ = false;
  bool all_ = false;       // the last segment was received in sequence
  bool in_block_ = false;  // a sub-block has begun and needs a confirmation
  bool deaf_once_ = true;  // a fault may still lose one segment
  std::uint8_t segments_ = 0;
  std::uint8_t got_ = 0;
  std::size_t size_ = 0;
  unsigned total_ = 0;  // segments seen in all
  Abort code_ = Abort::none;
};

/// The server side of a block upload. CiA 301, 7.2.4.3.13.
class BlockSender {
 public:
  void begin(bool crc, std::uint8_t segments, std::size_t size) noexcept;
  /// Makes the next segment of the present sub-block. Returns false if the sub-block is complete.
  bool next(std::span<const std::byte> data, const SdoFaults& faults, SdoBytes& segment) noexcept;
  /// Handles a confirmation. Returns false if the confirmation is invalid; then code() gives the
  /// abort code.
  bool on_confirm(const SdoBytes& frame) noexcept;
  bool all_confirmed() const noexcept { return all_confirmed_; }
  SdoBytes end(std::span<const std::byte> data, const SdoFaults& faults) const noexcept;
  Abort code() const noexcept { return code_; }

 private:
  bool crc_ = false;
  bool all_confirmed_ = false;
  bool lose_once_ = true;
  std::uint8_t segments_ = 0;
  std::uint8_t sent_ = 0;  // segments sent in this sub-block
  std::size_t size_ = 0;
  std::size_t base_ = 0;  // first byte of this sub-block
  unsigned total_ = 0;    // segments sent in all
  Abort code_ = Abort::none;
};

}  // namespace takt::sim
