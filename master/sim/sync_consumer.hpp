#pragma once
#include <cstdint>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/sim/abort.hpp"
#include "master/sim/emcy_producer.hpp"
#include "master/sim/object_store.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// The SYNC side of a device: identifier 0x1005, supervision 0x1006, window 0x1007, counter
/// overflow 0x1019. CiA 301, 7.2.5.
class SyncConsumer {
 public:
  SyncConsumer(ObjectStore& store, EmcyProducer& emcy);

  void set_may_produce(bool may) noexcept { may_produce_ = may; }
  void reset() noexcept;
  CobId id() const noexcept;
  /// Counter of this SYNC; 0: it has none, or one that was not expected (EMCY 8240).
  std::uint8_t on_sync(const Frame& frame, Time now) noexcept;
  /// True: SYNC has stayed away for longer than 0x1006 lets it.
  bool on_time(Time now) noexcept;
  Time deadline() const noexcept { return deadline_; }
  /// End of the synchronous window of the newest SYNC; `never`: no window.
  Time window_end() const noexcept { return window_end_; }
  Time last_sync() const noexcept { return last_sync_; }

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
  Time last_sync_{};
};

}  // namespace takt::sim
