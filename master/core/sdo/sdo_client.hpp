#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/sdo_access.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/event.hpp"
#include "master/core/machine.hpp"
#include "master/core/sdo/late_answers.hpp"
#include "master/core/sdo/sdo_block_download.hpp"
#include "master/core/sdo/sdo_block_upload.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {

/// How a transfer ended.
struct SdoResult {
  SdoFault fault = SdoFault::none;
  std::uint32_t abort_code = 0;
  std::size_t size = 0;    ///< number of bytes that were received or sent
  bool shortened = false;  ///< fewer bytes came than the device has announced
};

/// How an upload is requested. A block upload falls back to a plain one if the device refuses it or
/// does not answer.
enum class SdoMode : std::uint8_t { plain, block };

/// SDO client of one node on one channel. It runs one transfer at a time: expedited, segmented or
/// block. It works on the buffer of the caller, which must live until the result is taken. A
/// transfer in which the server becomes silent is aborted on the bus, so that the server does not
/// stay in the middle of it. Bus thread only. CiA 301, 7.2.4.
class SdoClient {
 public:
  /// Downloads of at least this number of bytes are block transfers if the settings of the node
  /// allow it. If the first frame of a block download finds no answer, the transfer falls back to
  /// segments, because nothing was written yet.
  static constexpr std::size_t block_from = 128;

  explicit SdoClient(NodeId server) noexcept : SdoClient{default_sdo_channel(server)} {}
  /// `segments` is the number of segments in a sub-block that the server sends, 1..127.
  explicit SdoClient(SdoChannel channel, SdoBlockUse block = SdoBlockUse::automatic,
                     std::uint8_t segments = most_block_segments) noexcept
      : channel_{channel}, block_use_{block}, segments_{segments} {}

  /// No transfer is running, no result waits to be taken and no abort waits to be sent.
  bool idle() const noexcept { return state_ == State::idle && !result_ && !to_send_; }

  /// Begins an upload; the client must be idle. `timeout` is the longest permitted silence of the
  /// server; each frame restarts it.
  void upload(ObjectKey object, std::span<std::byte> buffer, Time timeout,
              SdoMode mode = SdoMode::plain) noexcept;
  /// Begins a download; the client must be idle. `timeout` is as in upload().
  void download(ObjectKey object, std::span<const std::byte> value, Time timeout) noexcept;

  /// Ends a running transfer with an abort on the bus; its result is `cancelled`.
  void cancel() noexcept;
  /// Forgets the running transfer, because the server was reset and does not know it any more.
  void drop() noexcept;

  /// Takes a frame of the server.
  void on_frame(const Frame& frame, Time now) noexcept;
  /// Handles the time-out and sends at most one frame.
  void on_time(Time now, Outbox& out) noexcept;
  Time deadline() const noexcept;

  /// Returns the result of the transfer once.
  std::optional<SdoResult> take_result() noexcept;
  /// The device does not support block transfer; all further transfers are plain.
  struct NoBlock {
    ObjectKey object;
    std::uint32_t abort_code = 0;  ///< 0 means that it gave no answer
  };
  /// Reports once that the device does not support block transfer.
  std::optional<NoBlock> take_no_block() noexcept;
  /// Number of transferred bytes of the running transfer.
  std::size_t progress() const noexcept;
  /// Size of the running upload that the device has announced; 0 means none.
  std::size_t announced() const noexcept;

  /// Extends the time-out by the time for which the master itself did not run.
  void excuse(Time away) noexcept {
    if (deadline_ != never) deadline_ += away;
  }

  /// A block transfer is under way, so the next frame of the server comes soon.
  bool streams() const noexcept {
    return state_ == State::block_upload || state_ == State::block_download;
  }
  /// The server sends a sub-block, one segment after another, as fast as the wire permits.
  bool awaits_sub_block() const noexcept {
    return state_ == State::block_upload && !to_send_ && block_upload_.awaits_sub_block();
  }
  /// A frame was sent, and the server has not answered it.
  bool awaits_answer() const noexcept { return deadline_ != never && !next_frame(); }
  const SdoChannel& channel() const noexcept { return channel_; }
  /// The last frame of the client in the newest transfer, for reports. A length of 0 means that
  /// there is none.
  const Frame& last_sent() const noexcept { return last_sent_; }
  /// A frame of the newest transfer was sent.
  bool begun() const noexcept { return last_sent_.length != 0; }
  /// The last frame of the server in the newest transfer, for reports. A length of 0 means that
  /// there is none.
  const Frame& last_received() const noexcept { return last_received_; }
  /// The server has sent a frame without any byte in the newest transfer.
  bool empty_answer() const noexcept { return empty_answer_; }
  /// When the newest frame of the server came, whatever it was.
  Time heard_at() const noexcept { return heard_at_; }
  /// The object of an answer that did not fit the request; std::nullopt if there was none.
  std::optional<ObjectKey> answered() const noexcept { return answered_; }
  /// The longest time until the answer to a request that had timed out; 0 means that no such answer
  /// came.
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
    falling_back,  // The first frame of a block transfer found no answer, and its abort waits to be
                   // sent.
    settling,  // The transfer was aborted while segments were under way, and the server may refuse
               // each of them.
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
  SdoQuestion question() const noexcept;
  bool asks_plainly() const noexcept {
    return in_initiate() || state_ == State::upload_segments || state_ == State::download_segments;
  }
  void give_up_late() noexcept;
  void note_late(const Frame& frame, Time now) noexcept;
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
  void on_wrong_toggle() noexcept;
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
  bool block_refused_ = false;  ///< the device does not support block transfer
  bool block_unheard_ = false;  ///< this transfer began as a block transfer and found no answer
  bool block_ended_ = false;    ///< the previous transfer was a block transfer and succeeded
  bool left_stream_ = false;    ///< the transfer was given up in the middle of a sub-block
  bool late_segments_ = false;  ///< segments of a block upload that was given up may still come
  ObjectKey object_;
  /// Object of a transfer that was given up, whose answer may still come.
  std::optional<ObjectKey> given_up_;
  Time timeout_{};
  Time deadline_ = never;
  std::span<std::byte> buffer_;             ///< destination of an upload
  std::span<const std::byte> value_;        ///< source of a download
  std::size_t done_ = 0;                    ///< transferred bytes
  std::optional<std::uint32_t> announced_;  ///< size that the server indicated
  SdoBlockUpload block_upload_;
  SdoBlockDownload block_download_;
  std::optional<Frame> to_send_;
  std::optional<SdoResult> result_;
  std::optional<NoBlock> no_block_;
  SdoResult settled_;  ///< the result after State::settling
  LateAnswers late_;
  /// The previous transfer was given up, but not because of a protocol error.
  bool late_possible_ = false;
  bool late_now_ = false;  ///< the newest frame answers a request that has timed out
  bool unfit_ = false;     ///< an answer to the newest request was ignored because it does not fit
  bool empty_answer_ = false;          ///< a frame without any byte came in the newest transfer
  Time asked_at_{};                    ///< when the newest frame was sent
  Time heard_at_{};                    ///< when the newest frame of the server came
  std::optional<ObjectKey> answered_;  ///< object of an answer that did not fit the request
  Frame previous_answer_;              ///< the last answer of the previous transfer
  Frame last_sent_;
  Frame last_received_;
};

}  // namespace takt
