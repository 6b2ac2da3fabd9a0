#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"
#include "master/sim/pdo/pdo_record.hpp"
#include "master/sim/service/emcy_producer.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// One RPDO of a device. The RPDO checks the length of each frame, applies it at once or at the
/// next SYNC, and monitors the deadline. CiA 301, 7.2.2 and 7.5.2.35.
class Rpdo {
 public:
  explicit Rpdo(PdoRecord record) : record_{record} {}

  const PdoRecord& record() const noexcept { return record_; }
  /// Returns the length of the mapping in bytes.
  std::uint8_t length() const noexcept { return mapping_.bytes(); }
  void start() noexcept;
  void stop() noexcept { running_ = false; }
  void reconfigure() noexcept;

  /// Keeps the data of an ordinary synchronous frame until SYNC. Returns false, and keeps nothing,
  /// if on_frame() has more to do: to monitor a deadline, or to report the start or the end of an
  /// error.
  bool keep_until_sync(const Frame& frame, Time now, Time window_end,
                       const EmcyProducer& emcy) noexcept;
  /// Returns true if the frame acts at once; the caller then calls apply().
  bool on_frame(const Frame& frame, Time now, Time window_end, EmcyProducer& emcy) noexcept;
  /// Returns true if received data waits for SYNC.
  bool waits() const noexcept { return full_ && synchronous_; }
  /// Writes the received data into the mapped objects.
  void apply() noexcept;
  void on_time(Time now, EmcyProducer& emcy) noexcept;
  Time deadline() const noexcept { return deadline_; }
  /// Returns false if no frame waits and none can be received, until start() or a change of the
  /// record.
  bool live() const noexcept { return record_.valid() || full_ || deadline_ != never; }

 private:
  bool length_is_good(const Frame& frame, EmcyProducer& emcy) noexcept;

  PdoRecord record_;
  bool running_ = false;
  bool synchronous_ = false;
  bool full_ = false;
  std::uint64_t data_ = 0;
  Time deadline_ = never;
  PdoMapping mapping_;  ///< large, so it is the last member
};

}  // namespace takt::sim
