#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "eds_parser/table/sdo_access.hpp"
#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/event.hpp"
#include "master/core/machine.hpp"
#include "master/core/sdo/late_answers.hpp"
#include "master/core/sdo/previous_transfer.hpp"
#include "master/core/sdo/sdo_block_download.hpp"
#include "master/core/sdo/sdo_block_upload.hpp"
#include "master/core/sdo/sdo_download.hpp"
#include "master/core/sdo/sdo_upload.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {

/// The result of a transfer.
struct SdoResult {
  SdoFault fault = SdoFault::none;
  std::uint32_t abort_code = 0;
  std::size_t size = 0;    ///< number of bytes that were received or sent
  bool shortened = false;  ///< fewer bytes came than the device has announced
};

/// The kind of upload that is requested. If the device refuses a block upload or does not answer
/// it, the client makes a plain upload.
enum class SdoMode : std::uint8_t { plain, block };

/// The newest frames of a transfer, for reports. A length of 0 means that there is no such frame.
struct SdoTrace {
  Frame sent;                 ///< last frame of the client
  Frame received;             ///< last frame of the server
  bool empty_answer = false;  ///< the server has sent a frame without any byte
};

/// SDO client of one node on one channel. It runs one transfer at a time: expedited, segmented or
/// block. It works on the buffer of the caller, which must live until the result is taken. A
/// transfer in which the server becomes silent is aborted on the bus, so that the server does not
/// stay in the middle of it. Bus thread only. CiA 301, 7.2.4.
///
/// | state         | event                               | next state    | sent                |
/// | ------------- | ----------------------------------- | ------------- | ------------------- |
/// | idle          | upload(), download()                | running       | first request       |
/// | running       | answer                              | running       | next request        |
/// | running       | last answer                         | idle          | end of block upload |
/// | running       | abort: no block transfer            | running       | plain request       |
/// | running       | abort in a block download with data | settling      |                     |
/// | running       | any other abort                     | idle          |                     |
/// | running       | silence in a sub-block, once        | running       | confirmation        |
/// | running       | no answer to a block request        | withdrawing   | abort               |
/// | running       | silence, wrong answer, cancel()     | idle          | abort               |
/// | withdrawing   | the abort was sent                  | without_block | plain request       |
/// | withdrawing   | cancel()                            | idle          | abort               |
/// | without_block | first answer, or refusal of blocks  | running       | next request        |
/// | without_block | silence, wrong answer, cancel()     | idle          | abort               |
/// | settling      | 20 ms                               | idle          |                     |
/// | any           | drop()                              | idle          |                     |
class SdoClient {
 public:
  /// Downloads of at least this number of bytes are block transfers if the settings of the node
  /// allow it. If the first frame of a block download is not answered, the transfer falls back to
  /// segments, because nothing was written yet.
  static constexpr std::size_t block_from = 128;

  explicit SdoClient(NodeId server) noexcept : SdoClient{default_sdo_channel(server)} {}
  /// `segments` is the number of segments in a sub-block that the server sends, 1..127.
  explicit SdoClient(SdoChannel channel, SdoBlockUse block = SdoBlockUse::automatic,
                     std::uint8_t segments = most_block_segments) noexcept
      : channel_{channel}, block_use_{block}, segments_{segments} {}

  /// Returns true if no transfer is running, no result waits to be taken and no abort waits to be
  /// sent.
  bool idle() const noexcept { return state_ == State::idle && !result_ && !closing_; }

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
  std::optional<SdoResult> take_result() noexcept { return std::exchange(result_, std::nullopt); }
  /// The report that the device does not support block transfer. All further transfers are plain.
  struct NoBlock {
    ObjectKey object;
    std::uint32_t abort_code = 0;  ///< 0 means that the device gave no answer
  };
  /// Reports once that the device does not support block transfer.
  std::optional<NoBlock> take_no_block() noexcept;
  /// Returns the number of transferred bytes of the running transfer.
  std::size_t progress() const noexcept;
  /// Returns the size of the running upload that the device has announced; 0 means none.
  std::size_t announced() const noexcept;

  /// Extends the time-out by the time for which the master itself did not run.
  void extend_deadlines(Time away) noexcept {
    if (deadline_ != never) deadline_ += away;
  }

  /// Returns true if a block transfer is running, so the next frame of the server comes soon.
  bool streams() const noexcept { return state_ == State::running && is_block(); }
  /// Returns true if the server sends a sub-block, one segment after another, as fast as the wire
  /// permits.
  bool awaits_sub_block() const noexcept {
    return state_ == State::running && block_upload() && block_upload()->awaits_sub_block();
  }
  /// Returns true if a frame was sent, and the server has not answered it.
  bool awaits_answer() const noexcept { return deadline_ != never && !next_frame(); }
  const SdoChannel& channel() const noexcept { return channel_; }
  /// Returns the newest frames of the newest transfer.
  const SdoTrace& trace() const noexcept { return trace_; }
  /// Returns true if a frame of the newest transfer was sent.
  bool begun() const noexcept { return trace_.sent.length != 0; }
  /// Returns the time at which the newest frame of the server came, of whatever kind it was.
  Time heard_at() const noexcept { return heard_at_; }
  /// Returns the object of an answer that did not fit the request; std::nullopt if there was none.
  std::optional<ObjectKey> answered() const noexcept { return answered_; }
  /// Returns the longest time until the answer to a request that had timed out; 0 means that no
  /// such answer came.
  Time lateness() const noexcept { return late_.longest(); }
  void forget_lateness() noexcept { late_.reset(); }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(block_support_, object_, previous_, late_, answered_);
  }

 private:
  enum class State : std::uint8_t {
    idle,
    running,
    withdrawing,  ///< The first request of a block transfer was not answered, and the abort of this
                  ///< transfer waits to be sent.
    without_block,  ///< As `running`, after `withdrawing` and before the first answer, which shows
                    ///< that the server is silent only for block transfers.
    settling,  ///< The server has aborted the transfer before it has received all segments that
               ///< were sent, and may refuse each of them.
  };
  /// States whether the server supports block transfer, according to its answers so far.
  enum class BlockSupport : std::uint8_t { assumed, lacking };
  /// The last frame of a transfer that has ended: an abort, or the end of a block upload.
  struct Closing {
    Frame frame;
    Answer answer = Answer::none;
  };
  /// The request that was sent last.
  struct Asked {
    Time at{};
    bool misanswered = false;  ///< an answer to it was ignored because it does not fit
  };

  const SdoUpload* plain_upload() const noexcept { return std::get_if<SdoUpload>(&transfer_); }
  const SdoDownload* plain_download() const noexcept {
    return std::get_if<SdoDownload>(&transfer_);
  }
  const SdoBlockUpload* block_upload() const noexcept {
    return std::get_if<SdoBlockUpload>(&transfer_);
  }
  const SdoBlockDownload* block_download() const noexcept {
    return std::get_if<SdoBlockDownload>(&transfer_);
  }
  bool is_block() const noexcept { return block_upload() || block_download(); }
  bool initiates() const noexcept;
  bool runs() const noexcept { return state_ == State::running || state_ == State::without_block; }
  /// Returns true if the first request of a transfer without blocks is not answered yet.
  bool initiates_plain() const noexcept { return runs() && !is_block() && initiates(); }
  /// Returns true if the first request of a block transfer is not answered yet.
  bool unanswered_block() const noexcept { return streams() && initiates(); }
  bool may_use_block() const noexcept {
    return block_use_ != SdoBlockUse::off && block_support_ == BlockSupport::assumed;
  }
  std::optional<SdoQuestion> question() const noexcept;
  std::optional<Frame> next_frame() const noexcept;
  Answer answer_to_next() const noexcept;

  void begin(ObjectKey object, Time timeout) noexcept;
  void begin_without_block(State state) noexcept;
  void frame_sent(const Frame& frame, Time now) noexcept;
  Time answer_timeout() const noexcept;
  void on_silence() noexcept;
  void give_up_late() noexcept;
  void finish(const SdoResult& result, PreviousTransfer::End end) noexcept;
  void abort(SdoFault fault, std::uint32_t code) noexcept;

  bool note_late(const Frame& frame, Time now) noexcept;
  bool is_whole(const Frame& frame) const noexcept;
  void on_plain_answer(const Frame& frame, Time now, bool late) noexcept;
  void on_other_object(const Frame& frame, bool late) noexcept;
  void on_wrong_answer(const Frame& frame, bool late) noexcept;
  void on_block(const Frame& frame, Time now) noexcept;
  void on_step(const SdoStep& step, const Frame& frame, Time now) noexcept;
  void on_done() noexcept;
  void on_abort(const Frame& frame, Time now) noexcept;
  bool is_abort_of_previous(const Frame& frame) noexcept;
  bool fall_back(std::uint32_t code) noexcept;
  void heard(const Frame& frame) noexcept;
  void learn_no_block(std::uint32_t code) noexcept;

  SdoChannel channel_;
  SdoBlockUse block_use_;
  std::uint8_t segments_;
  State state_ = State::idle;
  std::variant<SdoBlockUpload, SdoBlockDownload, SdoUpload, SdoDownload> transfer_;
  BlockSupport block_support_ = BlockSupport::assumed;
  ObjectKey object_;
  Time timeout_{};
  Time deadline_ = never;
  Asked asked_;
  std::optional<Closing> closing_;
  std::optional<SdoResult> result_;
  std::optional<NoBlock> no_block_;
  SdoResult settled_;  ///< the result after State::settling
  PreviousTransfer previous_;
  LateAnswers late_;
  Time heard_at_{};                    ///< time at which the newest frame of the server came
  std::optional<ObjectKey> answered_;  ///< object of an answer that did not fit the request
  SdoTrace trace_;
};

}  // namespace takt
