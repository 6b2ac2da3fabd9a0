#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/sdo_access.hpp"
#include "master/core/sdo/sdo_block.hpp"
#include "master/core/sdo/sdo_step.hpp"
#include "master/wire/frame.hpp"
#include "master/wire/sdo_block_codec.hpp"

namespace takt {

/// The client side of one block upload. It accepts the segments that come in sequence, confirms
/// each sub-block with the number of these segments, and checks the CRC at the end. CiA
/// 301, 7.2.4.3.13.
///
/// | state    | event                                   | next state    | sent                    |
/// | -------- | --------------------------------------- | ------------- | ----------------------- |
/// | initiate | server accepts                          | segments      | start                   |
/// | initiate | answer without blocks                   | (SdoUpload)   |                         |
/// | segments | segment                                 | segments      |                         |
/// | segments | end of a sub-block, or silence for once | segments      | confirmation            |
/// | segments | the same, after the last segment        | end           | confirmation            |
/// | end      | end with the right CRC                  | done          | confirmation of the end |
class SdoBlockUpload {
 public:
  /// Parameters of an upload.
  struct Begin {
    SdoChannel channel;
    ObjectKey object;
    std::uint8_t segments = most_block_segments;  ///< segments of a sub-block, 1..127
    /// Protocol switch threshold: up to this number of bytes, the server may switch to an expedited
    /// or segmented upload. 0 means never.
    std::uint8_t threshold = 0;
  };
  /// Begins an upload. `buffer` must live until its end.
  void begin(const Begin& begin, std::span<std::byte> buffer) noexcept;
  /// Returns the buffer that begin() was given.
  std::span<std::byte> buffer() const noexcept { return buffer_; }

  /// Returns the frame to send now, or std::nullopt if the client waits for the server.
  std::optional<Frame> to_send() const noexcept;
  /// Notes that the frame of to_send() was sent.
  void sent() noexcept { to_send_ = Next::nothing; }
  /// Returns true if the server will answer the frame that is to be sent next with a sub-block.
  bool asks_for_sub_block() const noexcept {
    return state_ == State::segments && to_send_ != Next::nothing;
  }
  /// Returns true if a sub-block was requested and has not ended.
  bool awaits_sub_block() const noexcept {
    return state_ == State::segments && to_send_ == Next::nothing;
  }

  /// Takes a frame of the server, except for aborts. After `done`, to_send() still gives the
  /// confirmation of the end.
  SdoStep on_frame(const Frame& frame) noexcept;

  /// Handles silence of the server in a sub-block: the segments that came are confirmed, so that
  /// the server may repeat the rest. Returns false if there is nothing to confirm, or if this was
  /// tried before.
  bool confirm_after_silence() noexcept;
  /// Returns true if confirm_after_silence() must be called when the server is silent now.
  bool in_sub_block() const noexcept {
    return state_ == State::segments && held_back_ != Held::nothing && !asked_again_;
  }

  /// Returns true if the server has not accepted the transfer yet.
  bool initiates() const noexcept { return state_ == State::initiate; }
  /// Returns the number of bytes that were received in sequence. At the end, the number is exact;
  /// before, it does not include the newest segment.
  std::size_t moved() const noexcept { return done_; }
  /// Returns the size that the server has announced, or std::nullopt.
  std::optional<std::uint32_t> announced() const noexcept { return announced_; }

 private:
  enum class State : std::uint8_t { initiate, segments, end, done };
  enum class Next : std::uint8_t { nothing, initiate, start, confirm, end };
  /// The newest segment is held back, because only the end of the transfer says how many bytes of
  /// the last segment are used.
  enum class Held : std::uint8_t { nothing, segment, last_segment };

  SdoStep on_accept(const Frame& frame) noexcept;
  SdoStep on_segment(const Frame& frame) noexcept;
  SdoStep on_end(const Frame& frame) noexcept;
  bool repeats_last(const Frame& frame) const noexcept;
  std::uint16_t crc_with_held(const SdoBlockEnd& end) const noexcept;
  void confirm() noexcept;
  // Moves the data of the newest segment to the buffer. Returns false if there is no room.
  bool commit(std::size_t bytes) noexcept;

  Begin setup_{};
  std::span<std::byte> buffer_;
  State state_ = State::initiate;
  Next to_send_ = Next::nothing;
  bool crc_used_ = false;
  Held held_back_ = Held::nothing;
  bool asked_again_ = false;      ///< missing segments were requested again, and none has come
  std::uint8_t in_sequence_ = 0;  ///< segments of this sub-block that came in sequence
  std::uint8_t confirmed_ = 0;    ///< number of segments that the confirmation reports
  std::uint8_t stalled_blocks_ = 0;
  std::uint16_t crc_ = 0;
  std::optional<std::uint32_t> announced_;
  std::size_t done_ = 0;
  std::array<std::uint8_t, segment_bytes> held_{};
};

}  // namespace takt
