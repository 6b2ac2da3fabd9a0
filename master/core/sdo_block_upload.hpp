#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/sdo_access.hpp"
#include "master/core/sdo_block.hpp"
#include "master/wire/frame.hpp"
#include "master/wire/sdo_block_codec.hpp"

namespace takt {

/// The client's side of one block upload: takes the segments that come in sequence, confirms each
/// sub-block with what it has, and checks the CRC at the end. CiA 301, 7.2.4.3.13.
class SdoBlockUpload {
 public:
  struct Begin {
    SdoChannel channel;
    ObjectKey object;
    std::uint8_t segments = most_block_segments;  ///< of a sub-block, 1..127
    /// Up to so many bytes the server may answer with an ordinary upload; 0: never.
    std::uint8_t threshold = 0;
  };
  /// `buffer` must live until the end.
  void begin(const Begin& begin, std::span<std::byte> buffer) noexcept;

  /// The frame to send now; none: it is the server's turn.
  std::optional<Frame> to_send() const noexcept;
  void sent() noexcept { to_send_ = Next::nothing; }
  /// The server answers the frame that is to be sent with a sub-block.
  bool asks_for_sub_block() const noexcept {
    return state_ == State::segments && to_send_ != Next::nothing;
  }
  /// A sub-block was asked for and has not ended.
  bool awaits_sub_block() const noexcept {
    return state_ == State::segments && to_send_ == Next::nothing;
  }

  /// Frames of the server, aborts excepted. `done`: the end is to be confirmed by to_send().
  SdoBlockStep on_frame(const Frame& frame) noexcept;

  /// The server has fallen silent in a sub-block: what came is confirmed, so that it may repeat the
  /// rest. False: there is nothing to confirm, or this has been tried.
  bool confirm_after_silence() noexcept;
  /// Silence that calls for confirm_after_silence.
  bool in_sub_block() const noexcept {
    return state_ == State::segments && holds_ && !asked_again_;
  }

  /// The server has taken up the transfer.
  bool accepted() const noexcept { return state_ != State::initiate; }
  /// Bytes received in sequence; at the end exact, before that without the newest segment.
  std::size_t received() const noexcept { return done_; }
  std::optional<std::uint32_t> announced() const noexcept { return announced_; }

 private:
  enum class State : std::uint8_t { initiate, segments, end, done };
  enum class Next : std::uint8_t { nothing, initiate, start, confirm, end };

  SdoBlockStep on_accept(const Frame& frame) noexcept;
  SdoBlockStep on_segment(const Frame& frame) noexcept;
  SdoBlockStep on_end(const Frame& frame) noexcept;
  bool repeats_last(const Frame& frame) const noexcept;
  std::uint16_t crc_with_held(const SdoBlockEnd& end) const noexcept;
  void confirm() noexcept;
  // The newest segment, or what of it is data, into the buffer. False: no room.
  bool commit(std::size_t bytes) noexcept;

  Begin setup_{};
  std::span<std::byte> buffer_;
  State state_ = State::initiate;
  Next to_send_ = Next::nothing;
  bool crc_used_ = false;
  bool holds_ = false;  ///< a segment that is not committed: it may be the last
  bool last_held_ = false;
  bool asked_again_ = false;
  std::uint8_t in_sequence_ = 0;  ///< segments of this sub-block
  std::uint8_t confirmed_ = 0;    ///< what the confirmation says
  std::uint8_t fruitless_ = 0;
  std::uint16_t crc_ = 0;
  std::optional<std::uint32_t> announced_;
  std::size_t done_ = 0;
  std::array<std::uint8_t, segment_bytes> held_{};
};

}  // namespace takt
