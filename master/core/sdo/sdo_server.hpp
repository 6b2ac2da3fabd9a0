#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "eds_parser/table/sdo_access.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/machine.hpp"
#include "master/core/sdo/own_dictionary.hpp"
#include "master/wire/frame.hpp"
#include "master/wire/sdo_block_codec.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {

/// SDO server of the object dictionary of the master: expedited, segmented and block transfers, one
/// at a time. All values are short. After one second of silence of the client, the server aborts
/// its transfer. Bus thread only. CiA 301, 7.2.4.
///
/// | state              | event                    | next state          | sent                |
/// | ------------------ | ------------------------ | ------------------- | ------------------- |
/// | idle               | upload of up to 4 bytes  | idle                | value               |
/// | idle               | upload of a longer value | upload              | size                |
/// | upload             | request of a segment     | upload, then idle   | segment             |
/// | idle               | expedited download       | idle                | confirmation        |
/// | idle               | segmented download       | download            | confirmation        |
/// | download           | segment                  | download, then idle | confirmation        |
/// | idle               | block download           | block_download      | size of a sub-block |
/// | block_download     | end of a sub-block       | block_download      | confirmation        |
/// | block_download     | last segment             | block_download_end  | confirmation        |
/// | block_download_end | end                      | idle                | confirmation        |
/// | idle               | block upload             | block_offered       | size                |
/// | block_offered      | start                    | block_upload        | segments            |
/// | block_upload       | all segments were sent   | block_upload_wait   |                     |
/// | block_upload_wait  | confirmation             | block_upload        | segments            |
/// | block_upload_wait  | confirmation of the last | block_upload_end    | end, with the CRC   |
/// | block_upload_end   | confirmation of the end  | idle                |                     |
/// | any                | abort of the client      | idle                |                     |
/// | any                | wrong request, silence   | idle                | abort               |
class SdoServer {
 public:
  SdoServer(SdoChannel channel, const OwnDictionary& dictionary) noexcept
      : channel_{channel}, dictionary_{dictionary} {}

  /// States whether the server accepts a request for an NMT command now.
  enum class Orders : std::uint8_t { taken, refused };

  /// Takes a frame of a client.
  void on_frame(const Frame& frame, Time now, Orders orders) noexcept;
  /// Handles the time-out and sends at most one frame.
  void on_time(Time now, Outbox& out) noexcept;
  Time deadline() const noexcept { return to_send_ || sending_block() ? at_once : deadline_; }

  /// Returns once the NMT command that a client has requested by 0x1F82.
  std::optional<OwnDictionary::Order> take_order() noexcept;

  bool idle() const noexcept { return state_ == State::idle && !to_send_ && !order_; }

 private:
  enum class State : std::uint8_t {
    idle,
    upload,
    download,
    block_download,
    block_download_end,
    block_offered,  // The server waits for the start of a block upload.
    block_upload,
    block_upload_wait,  // The server waits for the confirmation of a sub-block.
    block_upload_end,
  };

  void on_initiate(const Frame& frame) noexcept;
  void begin_upload() noexcept;
  void begin_block_upload(const Frame& frame) noexcept;
  void begin_download(const Frame& frame) noexcept;
  void begin_block_download(const Frame& frame) noexcept;
  void on_upload_segment(const Frame& frame) noexcept;
  void on_download_segment(const Frame& frame) noexcept;
  void on_block_segment(const Frame& frame) noexcept;
  void on_block_download_end(const Frame& frame) noexcept;
  void on_block_upload(const Frame& frame) noexcept;
  void write(std::span<const std::byte> value, const Frame& confirmation) noexcept;
  bool take_bytes(std::span<const std::uint8_t> bytes) noexcept;
  void answer(const Frame& frame, State next) noexcept;
  void abort(std::uint32_t code) noexcept {
    answer(sdo_abort(channel_.answer, object_, code), State::idle);
  }
  bool sending_block() const noexcept { return state_ == State::block_upload; }
  Frame next_block_segment() noexcept;

  SdoChannel channel_;
  const OwnDictionary& dictionary_;
  State state_ = State::idle;
  Orders orders_ = Orders::taken;
  ObjectKey object_;
  bool toggle_ = false;
  bool crc_used_ = false;
  std::uint8_t block_segments_ = 0;
  std::uint8_t in_block_ = 0;  // segments of this sub-block that were sent or received
  std::size_t base_ = 0;       // offset of the first byte of this sub-block
  OwnDictionary::Value value_;
  Time deadline_ = never;
  std::optional<Frame> to_send_;
  std::optional<OwnDictionary::Order> order_;
};

}  // namespace takt
