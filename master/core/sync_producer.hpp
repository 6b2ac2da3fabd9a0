#pragma once
#include <cstdint>

#include "master/wire/sync.hpp"

namespace takt {

/// Makes the SYNC frames of the master. The counter runs 1..overflow and counts only SYNCs that are
/// made: a missed cycle makes none. CiA 301, 7.2.5.2.
class SyncProducer {
 public:
  /// `overflow` is 0x1019: 0 = no counter, else 2..240.
  constexpr SyncProducer(CobId id, std::uint8_t overflow) noexcept : id_{id}, overflow_{overflow} {}

  /// The next SYNC; make one only to send it.
  constexpr Frame next() noexcept {
    if (overflow_ == 0) return sync_frame(id_);
    counter_ = counter_ >= overflow_ ? std::uint8_t{1} : static_cast<std::uint8_t>(counter_ + 1);
    return sync_frame(id_, counter_);
  }
  /// Of the newest SYNC; 0: none yet, or no counter.
  constexpr std::uint8_t counter() const noexcept { return counter_; }
  /// The next counter is 1 again: the master comes out of NMT state Stopped.
  constexpr void restart() noexcept { counter_ = 0; }

 private:
  CobId id_;
  std::uint8_t overflow_;
  std::uint8_t counter_ = 0;
};

}  // namespace takt
