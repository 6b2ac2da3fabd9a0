#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/sdo_access.hpp"
#include "master/core/sdo/sdo_block.hpp"
#include "master/core/sdo/sdo_step.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// The client side of one block download. It sends the segments of a sub-block without waiting in
/// between, goes back to the first segment that the server has missed, and ends with the CRC. CiA
/// 301, 7.2.4.3.9.
///
/// | state    | event                            | next state | sent                    |
/// | -------- | -------------------------------- | ---------- | ----------------------- |
/// | initiate | server accepts                   | segments   | segments of a sub-block |
/// | segments | confirmation, segments are left  | segments   | segments of a sub-block |
/// | segments | confirmation of the last segment | end        | end, with the CRC       |
/// | end      | confirmation of the end          | (done)     |                         |
class SdoBlockDownload {
 public:
  /// Begins a download. `value` must live until its end.
  void begin(SdoChannel channel, ObjectKey object, std::span<const std::byte> value) noexcept;
  /// Returns the bytes that begin() was given.
  std::span<const std::byte> value() const noexcept { return value_; }

  /// Returns the frame to send now, or std::nullopt if the client waits for the server.
  std::optional<Frame> to_send() const noexcept;
  /// Notes that the frame of to_send() was sent.
  void sent() noexcept;
  /// Returns true if the server will answer the frame that is to be sent next.
  bool answered() const noexcept;

  /// Takes a frame of the server, except for aborts.
  SdoStep on_frame(const Frame& frame) noexcept;

  /// Returns true if the server has not accepted the transfer yet.
  bool initiates() const noexcept { return state_ == State::initiate; }
  /// Returns the number of bytes that the server has confirmed.
  std::size_t moved() const noexcept { return confirmed_; }

 private:
  enum class State : std::uint8_t { initiate, segments, end };

  bool accepts(const Frame& frame) const noexcept;
  SdoStep on_accept(const Frame& frame) noexcept;
  SdoStep on_confirm(const Frame& frame) noexcept;
  std::size_t offset() const noexcept { return confirmed_ + sent_in_block_ * segment_bytes; }

  SdoChannel channel_;
  ObjectKey object_;
  std::span<const std::byte> value_;
  State state_ = State::initiate;
  bool waits_ = false;  ///< the client waits for the server
  bool crc_used_ = false;
  std::uint8_t block_segments_ = 0;
  std::uint8_t sent_in_block_ = 0;
  std::uint8_t stalled_blocks_ = 0;
  std::optional<SdoBlockConfirm> newest_;
  std::uint16_t crc_ = 0;
  std::size_t summed_ = 0;  ///< number of bytes that crc_ covers
  std::size_t confirmed_ = 0;
};

}  // namespace takt
