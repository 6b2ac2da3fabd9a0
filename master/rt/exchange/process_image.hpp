#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/core/pdo_status.hpp"

namespace takt {

/// The number of an image, its times, and how many PDOs are missing in it.
struct ImageStamp {
  std::uint64_t cycle = 0;  ///< cycle number; jumps by the number of missed periods
  std::uint64_t beat = 0;   ///< SYNCs sent or followed so far
  Time sync_time{};         ///< time of SYNC, by its echo if there is one
  Time publish_time{};
  std::uint32_t missing = 0;  ///< expected PDOs that did not arrive
};

/// One image as the front thread sees it; valid until the next take().
struct ImageView : ImageStamp {
  std::span<const std::int64_t> values;       ///< all signals: inputs, then outputs as last sent
  std::span<const std::uint64_t> stale_bits;  ///< signal n is bit n % 64 of word n / 64
  std::span<const PdoMark> pdos{};            ///< rows of PdoTable::tpdos

  /// Cycles since the newest frame of this TPDO; 0 if the frame came in this cycle. It is
  /// not valid until the first frame has come (`received` of the mark is 0).
  std::uint32_t age(std::size_t tpdo) const noexcept {
    return static_cast<std::uint32_t>(cycle) - pdos[tpdo].cycle;
  }
};

/// Carries images from the bus thread to the front thread: 64 slots, one producer, one consumer,
/// wait-free. A full ring drops the newest image and counts the loss.
class ImageRing {
 public:
  static constexpr std::size_t slots = 64;

  explicit ImageRing(std::size_t signals, std::size_t tpdos = 0);

  /// Bus thread: adds an image. Returns false if the front thread is 64 images behind.
  bool publish(const ImageStamp& stamp, std::span<const std::int64_t> values,
               std::span<const std::uint64_t> stale_bits,
               std::span<const PdoMark> pdos = {}) noexcept;

  /// Front thread: takes the next image in order, and frees the image of the previous call. Returns
  /// false if there is none.
  bool take(ImageView& view) noexcept;
  /// Front thread: takes the newest image and skips older ones. Returns false if there is none.
  bool take_newest(ImageView& view) noexcept;

  /// Returns the number of images lost because the front thread was too slow. Any thread.
  std::uint64_t overruns() const noexcept { return overruns_.load(std::memory_order_relaxed); }

 private:
  ImageView view_of(std::size_t position) const noexcept;
  void release() noexcept;

  std::size_t signals_;
  std::size_t words_;  ///< words of stale bits per image
  std::size_t tpdos_;
  std::vector<ImageStamp> stamps_;
  std::vector<std::int64_t> values_;
  std::vector<std::uint64_t> stale_;
  std::vector<PdoMark> pdos_;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
  bool holding_ = false;  // front thread only
  alignas(64) std::atomic<std::uint64_t> overruns_{0};
};

}  // namespace takt
