#pragma once
#include <cstdint>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/service/emcy_producer.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// The SYNC consumer of a device: identifier 0x1005, supervision 0x1006, window 0x1007, counter
/// overflow 0x1019. CiA 301, 7.2.5.
class SyncConsumer {
 public:
  SyncConsumer(ObjectStore& store, EmcyProducer& emcy);

  void set_may_produce(bool may) noexcept { may_produce_ = may; }
  void reset() noexcept;
  CobId id() const noexcept;
  /// Returns the counter of this SYNC. Returns 0 if the SYNC has no counter, or if its length is
  /// not as expected (EMCY 8240).
  std::uint8_t on_sync(const Frame& frame, Time now) noexcept;
  /// Returns true if SYNC has just become overdue according to 0x1006.
  bool on_time(Time now) noexcept;
  Time deadline() const noexcept { return deadline_; }
  /// Returns the end of the synchronous window of the newest SYNC; `never` means no window.
  Time window_end() const noexcept { return window_end_; }

  Abort check_write(const Object& object, std::uint64_t raw) const noexcept;

 private:
  EmcyProducer& emcy_;
  Object* cob_;
  Object* period_;
  Object* window_;
  Object* overflow_;
  bool may_produce_ = false;  ///< bit 30 of 0x1005 may be set
  Time deadline_ = never;
  Time window_end_ = never;
};

}  // namespace takt::sim
