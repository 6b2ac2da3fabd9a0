#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// The SYNC producer of a device: bit 30 of 0x1005, period 0x1006, counter overflow 0x1019. CiA
/// 301, 7.2.5 and 7.5.2.5.
class SyncProducer {
 public:
  explicit SyncProducer(ObjectStore& store);

  /// Starts the producer when communication begins and after a change of 0x1005, 0x1006 or 0x1019.
  /// The first SYNC comes one period later.
  void start(Time now) noexcept;
  void stop() noexcept { next_ = never; }
  /// Returns the SYNC frame if one is due. `id` replaces the identifier in 0x1005 if the device
  /// sends SYNC with another one.
  std::optional<Frame> on_time(Time now, std::optional<CobId> id) noexcept;
  Time deadline() const noexcept { return next_; }

 private:
  Time period() const noexcept;

  const Object* cob_;
  const Object* period_;
  const Object* overflow_;
  std::uint8_t counter_ = 0;
  Time next_ = never;
};

}  // namespace takt::sim
