#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "master/wire/frame.hpp"

namespace takt {

/// Counts the frames of each 11-bit identifier that the bus thread has handed to the bus, so that
/// the diagnostic socket can distinguish them from the frames of others. One thread writes, and any
/// thread may read without a lock.
class SentFrames {
 public:
  /// Writer: counts frames before they are sent, so that a reader never sees a frame that is not
  /// counted yet.
  void add(std::span<const Frame> frames) noexcept { change(frames, 1); }
  /// Writer: subtracts frames that were refused after all.
  void take_back(std::span<const Frame> frames) noexcept { change(frames, ~std::uint32_t{0}); }

  std::uint32_t of(CobId id) const noexcept {
    return counts_[id.id() & 0x7FF].load(std::memory_order_acquire);
  }

 private:
  void change(std::span<const Frame> frames, std::uint32_t by) noexcept {
    for (const Frame& frame : frames) {
      if (frame.id.is_extended()) continue;
      std::atomic<std::uint32_t>& count = counts_[frame.id.id()];
      count.store(count.load(std::memory_order_relaxed) + by, std::memory_order_release);
    }
  }
  std::array<std::atomic<std::uint32_t>, 2048> counts_{};
};

}  // namespace takt
