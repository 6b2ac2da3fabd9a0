#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/sdo_access.hpp"
#include "master/core/sdo/sdo_question.hpp"
#include "master/core/sdo/sdo_step.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// The client side of one upload without blocks: expedited, or by segments. CiA 301, 7.2.4.3.5 and
/// 7.2.4.3.6.
///
/// | state    | event             | next state | sent                         |
/// | -------- | ----------------- | ---------- | ---------------------------- |
/// | initiate | expedited value   | (done)     |                              |
/// | initiate | size of the value | segments   | request of the first segment |
/// | segments | segment           | segments   | request of the next segment  |
/// | segments | last segment      | (done)     |                              |
class SdoUpload {
 public:
  /// `buffer` must live until the end of the upload.
  SdoUpload(SdoChannel channel, ObjectKey object, std::span<std::byte> buffer) noexcept
      : channel_{channel},
        object_{object},
        buffer_{buffer},
        to_send_{upload_request(channel.request, object)} {}

  /// Returns the frame to send now, or std::nullopt if the client waits for the server.
  std::optional<Frame> to_send() const noexcept { return to_send_; }
  /// Notes that the frame of to_send() was sent.
  void sent() noexcept { to_send_.reset(); }

  /// Returns the answer that the newest request expects.
  SdoQuestion question() const noexcept;
  /// Returns true if no data were transferred yet.
  bool initiates() const noexcept { return state_ == State::initiate; }
  /// Processes an answer of the server. `frame` must fit the answer that question() describes.
  SdoStep on_answer(const Frame& frame) noexcept {
    return initiates() ? on_initiate(frame) : on_segment(frame);
  }

  /// Returns the number of bytes that were received.
  std::size_t moved() const noexcept { return moved_; }
  /// Returns the size that the server has announced, or std::nullopt.
  std::optional<std::uint32_t> announced() const noexcept { return announced_; }

 private:
  enum class State : std::uint8_t { initiate, segments };

  SdoStep on_initiate(const Frame& frame) noexcept;
  SdoStep on_segment(const Frame& frame) noexcept;
  bool take(std::span<const std::uint8_t> bytes) noexcept;
  void request_segment() noexcept { to_send_ = upload_segment_request(channel_.request, toggle_); }

  SdoChannel channel_;
  ObjectKey object_;
  std::span<std::byte> buffer_;
  State state_ = State::initiate;
  bool toggle_ = false;  ///< toggle bit of the segment that was requested last
  std::size_t moved_ = 0;
  std::optional<std::uint32_t> announced_;
  std::optional<Frame> to_send_;
};

}  // namespace takt
