#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/sim/abort.hpp"
#include "master/sim/dictionary.hpp"
#include "master/sim/transmitter.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// The default SDO server of a device: expedited and segmented transfers both ways, one at a time.
/// CiA 301, 7.2.4.
class SdoServer {
 public:
  SdoServer(Dictionary& dictionary, NodeId node);

  CobId request_id() const noexcept { return CobId::base(0x600u + node_.value()); }
  /// Silent: NMT stopped or reset.
  void reset() noexcept;
  /// Answers are ready after `latency`, the time that the device computes.
  void set_latency(Time latency) noexcept { latency_ = latency; }
  void on_frame(const Frame& frame, Time now, Transmitter& out) noexcept;
  /// The client has fallen silent within a transfer.
  void on_time(Time now, Transmitter& out) noexcept;
  Time deadline() const noexcept { return deadline_; }

 private:
  enum class State : std::uint8_t { idle, uploading, downloading };

  void on_initiate(const Frame& frame, Time now, Transmitter& out) noexcept;
  void start_upload(Time now, Transmitter& out) noexcept;
  void upload_segment(const Frame& frame, Time now, Transmitter& out) noexcept;
  void start_download(const Frame& frame, Time now, Transmitter& out) noexcept;
  void start_segmented_download(const Frame& frame, Time now, Transmitter& out) noexcept;
  void download_segment(const Frame& frame, Time now, Transmitter& out) noexcept;
  void finish_download(Time now, Transmitter& out) noexcept;
  void answer(std::uint8_t command, std::span<const std::byte> data, Time now,
              Transmitter& out) noexcept;
  void confirm(std::uint8_t command, Time now, Transmitter& out) noexcept;
  void abort(Abort code, Time now, Transmitter& out) noexcept;
  void send(Frame frame, Time now, Transmitter& out) noexcept;
  Abort check_size(std::size_t size) const noexcept;

  Dictionary& dictionary_;
  NodeId node_;
  Time latency_{};
  State state_ = State::idle;
  ObjectKey key_;
  bool toggle_ = false;
  bool size_known_ = false;
  std::size_t size_ = 0;
  std::size_t done_ = 0;
  std::vector<std::byte> buffer_;
  Time deadline_ = never;
};

}  // namespace takt::sim
