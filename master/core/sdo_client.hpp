#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/event.hpp"
#include "master/core/machine.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {

/// How a transfer ended.
struct SdoResult {
  SdoFault fault = SdoFault::none;
  std::uint32_t abort_code = 0;
  std::size_t size = 0;  ///< bytes received, or sent
};

/// SDO client of one node on its default channel: one transfer at a time, expedited or segmented.
/// Works on the caller's buffer, which must live until the result is taken. A transfer that falls
/// silent is aborted on the bus, so that the server isn't left half-way. CiA 301, 7.2.4.
class SdoClient {
 public:
  explicit SdoClient(NodeId server) noexcept : server_{server} {}

  /// Nothing is running, no result is waiting and no abort is still to be sent.
  bool idle() const noexcept { return state_ == State::idle && !result_ && !to_send_; }

  /// Both only when idle. `timeout` is the longest silence of the server, restarted by each frame.
  void upload(ObjectKey object, std::span<std::byte> buffer, Time timeout) noexcept;
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
  /// Bytes of the running transfer that are through.
  std::size_t progress() const noexcept { return done_; }

  /// The newest frames of the newest transfer, for reports. Length 0: there is none.
  const Frame& last_sent() const noexcept { return last_sent_; }
  const Frame& last_received() const noexcept { return last_received_; }

 private:
  enum class State : std::uint8_t {
    idle,
    upload_initiate,
    upload_segments,
    download_initiate,
    download_segments,
  };

  void begin(State state, ObjectKey object, Time timeout, const Frame& frame) noexcept;
  void finish(SdoResult result) noexcept;
  void abort(SdoFault fault, std::uint32_t code) noexcept;
  void on_abort(const Frame& frame) noexcept;
  void on_upload_initiate(const Frame& frame) noexcept;
  void on_upload_segment(const Frame& frame) noexcept;
  void on_download_confirmed(const Frame& frame) noexcept;
  void on_download_segment_confirmed(const Frame& frame) noexcept;
  bool take_bytes(std::span<const std::uint8_t> bytes) noexcept;
  void send_segment() noexcept;

  NodeId server_;
  State state_ = State::idle;
  bool toggle_ = false;
  bool last_segment_sent_ = false;
  ObjectKey object_;
  std::optional<ObjectKey> given_up_;  ///< object of a transfer whose answer may still come
  Time timeout_{};
  Time deadline_ = never;
  std::span<std::byte> buffer_;             ///< upload
  std::span<const std::byte> value_;        ///< download
  std::size_t done_ = 0;                    ///< bytes
  std::optional<std::uint32_t> announced_;  ///< size that the server indicated
  std::optional<Frame> to_send_;
  std::optional<SdoResult> result_;
  Frame last_sent_;
  Frame last_received_;
};

}  // namespace takt
