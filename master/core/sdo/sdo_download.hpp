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

/// The client side of one download without blocks: expedited, or by segments. CiA 301, 7.2.4.3.3
/// and 7.2.4.3.4.
///
/// | state        | event                        | next state             | sent          |
/// | ------------ | ---------------------------- | ---------------------- | ------------- |
/// | initiate     | confirmation of 1 to 4 bytes | (done)                 |               |
/// | initiate     | confirmation of another size | segments               | first segment |
/// | segments     | confirmation                 | segments, last_segment | next segment  |
/// | last_segment | confirmation                 | (done)                 |               |
class SdoDownload {
 public:
  /// `value` must live until the end of the download.
  SdoDownload(SdoChannel channel, ObjectKey object, std::span<const std::byte> value) noexcept
      : channel_{channel},
        object_{object},
        value_{value},
        to_send_{download_request(channel.request, sdo_initiate(object, value))} {}

  /// Returns the frame to send now, or std::nullopt if the client waits for the server.
  std::optional<Frame> to_send() const noexcept { return to_send_; }
  /// Notes that the frame of to_send() was sent.
  void sent() noexcept { to_send_.reset(); }

  /// Returns the answer that the newest request expects.
  SdoQuestion question() const noexcept;
  /// Returns true if no data were transferred yet.
  bool initiates() const noexcept { return state_ == State::initiate; }
  /// Processes an answer of the server. `frame` must fit the answer that question() describes.
  SdoStep on_answer(const Frame& frame) noexcept;

  /// Returns the number of bytes that were sent, including the segment that is to be sent next.
  std::size_t moved() const noexcept { return moved_; }

 private:
  /// In `last_segment`, no segment is left to be sent.
  enum class State : std::uint8_t { initiate, segments, last_segment };

  void send_segment() noexcept;

  SdoChannel channel_;
  ObjectKey object_;
  std::span<const std::byte> value_;
  State state_ = State::initiate;
  bool toggle_ = false;  ///< toggle bit of the segment that was sent last
  std::size_t moved_ = 0;
  std::optional<Frame> to_send_;
};

}  // namespace takt
