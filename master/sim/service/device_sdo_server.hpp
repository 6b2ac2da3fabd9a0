#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/dictionary.hpp"
#include "master/sim/service/sdo_faults.hpp"
#include "master/sim/service/sdo_server_block.hpp"
#include "master/sim/service/transmitter.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// One SDO server of a device. It handles expedited, segmented and block transfers in both
/// directions, one at a time. CiA 301, 7.2.4.
class SdoServer {
 public:
  /// The server uses the default channel until set_channel() is called.
  SdoServer(Dictionary& dictionary, NodeId node, const SdoFaults& faults);

  void set_channel(CobId request, CobId answer) noexcept {
    request_id_ = request;
    answer_id_ = answer;
  }
  CobId request_id() const noexcept { return request_id_; }
  /// Ends a transfer without an abort message, as in NMT stopped or reset.
  void reset() noexcept;
  /// Sets the computing time of the device: an answer is ready after `latency`, the next segment of
  /// a block after `segment`.
  void set_times(Time latency, Time segment) noexcept {
    latency_ = latency;
    segment_time_ = segment;
  }
  void on_frame(const Frame& frame, Time now, Transmitter& out) noexcept;
  /// Call this when the client has been silent too long within a transfer, or the next segment of a
  /// block is due.
  void on_time(Time now, Transmitter& out) noexcept;
  Time deadline() const noexcept { return deadline_ < next_segment_ ? deadline_ : next_segment_; }

 private:
  enum class State : std::uint8_t {
    idle,
    uploading,
    downloading,
    block_receiving,
    block_offered,  // the server has answered the initiate of an upload and waits for its start
    block_sending,
    block_ended,  // the server has sent the end of an upload and waits for its confirmation
  };

  void on_initiate(const Frame& frame, Time now, Transmitter& out) noexcept;
  void start_upload(Time now, Transmitter& out) noexcept;
  void upload_segment(const Frame& frame, Time now, Transmitter& out) noexcept;
  void start_download(const Frame& frame, Time now, Transmitter& out) noexcept;
  void start_segmented_download(const Frame& frame, Time now, Transmitter& out) noexcept;
  void download_segment(const Frame& frame, Time now, Transmitter& out) noexcept;
  void finish_download(Time now, Transmitter& out) noexcept;
  void start_block_download(const Frame& frame, Time now, Transmitter& out) noexcept;
  void block_received(BlockReceiver::Then then, Time now, Transmitter& out) noexcept;
  void start_block_upload(const Frame& frame, Time now, Transmitter& out) noexcept;
  void on_block_upload(const Frame& frame, Time now, Transmitter& out) noexcept;
  void send_block_segment(Time now, Transmitter& out) noexcept;
  void reply(const SdoBytes& bytes, Time now, Transmitter& out) noexcept;
  std::uint32_t announced(std::size_t size) const noexcept;
  void answer(std::uint8_t command, std::span<const std::byte> data, Time now,
              Transmitter& out) noexcept;
  void confirm(std::uint8_t command, Time now, Transmitter& out) noexcept;
  void abort(Abort code, Time now, Transmitter& out) noexcept;
  void send(Frame frame, Time now, Transmitter& out) noexcept;
  Abort take_size(const Frame& frame, bool reported) noexcept;

  Dictionary* dictionary_;
  const SdoFaults* faults_;
  CobId request_id_;
  CobId answer_id_;
  Time latency_{};
  Time segment_time_{};
  State state_ = State::idle;
  ObjectKey key_;
  bool toggle_ = false;
  bool size_known_ = false;
  std::size_t size_ = 0;
  std::size_t done_ = 0;
  std::vector<std::byte> buffer_;
  BlockReceiver receiver_;
  BlockSender sender_;
  Time deadline_ = never;
  Time next_segment_ = never;
};

}  // namespace takt::sim
