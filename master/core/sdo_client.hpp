#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/sdo_access.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/event.hpp"
#include "master/core/late_answers.hpp"
#include "master/core/machine.hpp"
#include "master/core/sdo_block_download.hpp"
#include "master/core/sdo_block_upload.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {

/// How a transfer ended.
struct SdoResult {
  SdoFault fault = SdoFault::none;
  std::uint32_t abort_code = 0;
  std::size_t size = 0;    ///< bytes received, or sent
  bool shortened = false;  ///< fewer bytes came than the device had announced
};

/// How an upload is asked for. Block falls back to plain where the device refuses it, or does not
/// answer.
enum class SdoMode : std::uint8_t { plain, block };

/// SDO client of one node on one channel: one transfer at a time, expedited, segmented or block.
/// Works on the caller's buffer, which must live until the result is taken. A transfer that falls
/// silent is aborted on the bus, so that the server isn't left half-way. CiA 301, 7.2.4.
class SdoClient {
 public:
  /// Downloads of so many bytes go by block where the node allows it. One that finds no answer to
  /// its first frame goes by segments: nothing was written yet.
  static constexpr std::size_t block_from = 128;

  explicit SdoClient(NodeId server) noexcept : SdoClient{default_sdo_channel(server)} {}
  /// `segments`: of a sub-block that the server sends, 1..127.
  explicit SdoClient(SdoChannel channel, SdoBlockUse block = SdoBlockUse::automatic,
                     std::uint8_t segments = most_block_segments) noexcept
      : channel_{channel}, block_use_{block}, segments_{segments} {}

  /// Nothing is running, no result is waiting and no abort is still to be sent.
  bool idle() const noexcept { return state_ == State::idle && !result_ && !to_send_; }

  /// Both only when idle. `timeout` is the longest silence of the server, restarted by each frame.
  void upload(ObjectKey object, std::span<std::byte> buffer, Time timeout,
              SdoMode mode = SdoMode::plain) noexcept;
  void download(ObjectKey object, std::span<const std::byte> value, Time timeout) noexcept;

  /// Ends a running transfer with an abort on the bus; its result is `cancelled`.
  void cancel() noexcept;
  /// Forgets everything: the server has been reset and knows of no transfer.
  void drop() noexcept;

  void on_frame(const Frame& frame, Time now) noexcept;
  /// Looks at the deadline and sends at most one frame.
  void on_time(Time now, Outbox& out) noexcept;
  Time deadline() const noexcept;

  /// The result of the transfer, once.
  std::optional<SdoResult> take_result() noexcept;
  /// The device has shown that it knows no block transfer; told once. All further ones are plain.
  struct NoBlock {
    ObjectKey object;
    std::uint32_t abort_code = 0;  ///< 0: it gave no answer
  };
  std::optional<NoBlock> take_no_block() noexcept;
  /// Bytes of the running transfer that are through.
  std::size_t progress() const noexcept;
  /// Bytes that the device said the running upload has; 0: it did not say.
  std::size_t announced() const noexcept;

  /// The master itself was away for so long: the server is not late by that.
  void excuse(Time away) noexcept {
    if (deadline_ != never) deadline_ += away;
  }

  /// In the middle of a block transfer: the next frame of the server comes soon.
  bool streams() const noexcept {
    return state_ == State::block_upload || state_ == State::block_download;
  }
  /// The server sends one segment after another, as fast as the wire takes them.
  bool awaits_sub_block() const noexcept {
    return state_ == State::block_upload && !to_send_ && block_upload_.awaits_sub_block();
  }
  /// A frame was sent, and the server has not answered it.
  bool awaits_answer() const noexcept { return deadline_ != never && !next_frame(); }
  const SdoChannel& channel() const noexcept { return channel_; }
  /// The newest frames of the newest transfer, for reports. Length 0: there is none.
  const Frame& last_sent() const noexcept { return last_sent_; }
  /// Some frame of the transfer was sent.
  bool begun() const noexcept { return last_sent_.length != 0; }
  const Frame& last_received() const noexcept { return last_received_; }
  /// Object of an answer that came in place of the one that was asked for; none: none did.
  std::optional<ObjectKey> answered() const noexcept { return answered_; }
  /// How late answers come of requests that have timed out; 0: none has come.
  Time lateness() const noexcept { return late_.longest(); }
  void forget_lateness() noexcept { late_.reset(); }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(block_refused_, block_ended_, late_segments_, object_, given_up_, late_, answered_);
    state(late_possible_);
  }

 private:
  enum class State : std::uint8_t {
    idle,
    upload_initiate,
    upload_segments,
    download_initiate,
    download_segments,
    block_upload,
    block_download,
    falling_back,  // the first frame of a block transfer found no answer; its abort is to be sent
    settling,      // aborted while segments were under way: the server may refuse each of them
  };

  bool blocks() const noexcept { return block_use_ != SdoBlockUse::off && !block_refused_; }
  bool in_initiate() const noexcept {
    return state_ == State::upload_initiate || state_ == State::download_initiate;
  }
  void begin(State state, ObjectKey object, Time timeout) noexcept;
  void begin_plain(State state) noexcept;
  std::optional<Frame> next_frame() const noexcept;
  Answer answer_to_next() const noexcept;
  void frame_sent(const Frame& frame, Time now) noexcept;
  Time patience() const noexcept;
  void on_silence() noexcept;
  void finish(SdoResult result) noexcept;
  void abort(SdoFault fault, std::uint32_t code) noexcept;
  void on_abort(const Frame& frame, Time now) noexcept;
  void on_block(const Frame& frame, Time now) noexcept;
  bool unanswered_block() const noexcept;
  bool fall_back(std::uint32_t code) noexcept;
  void heard(const Frame& frame) noexcept;
  void learn_no_block(std::uint32_t code) noexcept;
  bool is_whole(const Frame& frame) const noexcept;
  bool is_of_earlier_block(const Frame& frame) const noexcept;
  void on_wrong_answer(const Frame& frame) noexcept;
  void on_other_object(const Frame& frame) noexcept;
  void on_upload_initiate(const Frame& frame) noexcept;
  void on_upload_segment(const Frame& frame) noexcept;
  void on_download_confirmed(const Frame& frame) noexcept;
  void on_download_segment_confirmed(const Frame& frame) noexcept;
  bool take_bytes(std::span<const std::uint8_t> bytes) noexcept;
  void send_segment() noexcept;

  SdoChannel channel_;
  SdoBlockUse block_use_;
  std::uint8_t segments_;
  State state_ = State::idle;
  bool uploads_ = false;
  bool toggle_ = false;
  bool last_segment_sent_ = false;
  bool block_refused_ = false;  ///< the device knows no block transfer
  bool block_unheard_ = false;  ///< this transfer was begun by block, and found no answer
  bool block_ended_ = false;    ///< well, by the transfer before this one
  bool left_stream_ = false;    ///< given up in the middle of a sub-block
  bool late_segments_ = false;  ///< of a block upload that was given up may still come
  ObjectKey object_;
  std::optional<ObjectKey> given_up_;  ///< object of a transfer whose answer may still come
  Time timeout_{};
  Time deadline_ = never;
  std::span<std::byte> buffer_;             ///< upload
  std::span<const std::byte> value_;        ///< download
  std::size_t done_ = 0;                    ///< bytes
  std::optional<std::uint32_t> announced_;  ///< size that the server indicated
  SdoBlockUpload block_upload_;
  SdoBlockDownload block_download_;
  std::optional<Frame> to_send_;
  std::optional<SdoResult> result_;
  std::optional<NoBlock> no_block_;
  SdoResult settled_;  ///< the result when it has settled
  LateAnswers late_;
  bool late_possible_ = false;         ///< the transfer before was given up in silence
  bool late_now_ = false;              ///< the newest frame answers a request that has timed out
  Time asked_at_{};                    ///< when the newest transfer was asked for
  std::optional<ObjectKey> answered_;  ///< in place of what was asked for
  Frame previous_answer_;              ///< the last one of the transfer before
  Frame last_sent_;
  Frame last_received_;
};

}  // namespace takt
