#include "master/rt/exchange/process_image.hpp"

#include <algorithm>
#include <cassert>

namespace takt {

ImageRing::ImageRing(std::size_t signals, std::size_t tpdos)
    : signals_{signals},
      words_{(signals + 63) / 64},
      tpdos_{tpdos},
      stamps_(slots),
      values_(slots * signals, 0),
      stale_(slots * words_, 0),
      pdos_(slots * tpdos) {}

bool ImageRing::publish(const ImageStamp& stamp, std::span<const std::int64_t> values,
                        std::span<const std::uint64_t> stale_bits,
                        std::span<const PdoMark> pdos) noexcept {
  assert(values.size() == signals_ && stale_bits.size() == words_ && pdos.size() == tpdos_);
  const std::size_t head = head_.load(std::memory_order_relaxed);
  if (head - tail_.load(std::memory_order_acquire) == slots) {
    overruns_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  const std::size_t slot = head % slots;
  stamps_[slot] = stamp;
  std::ranges::copy(values, values_.data() + slot * signals_);
  std::ranges::copy(stale_bits, stale_.data() + slot * words_);
  std::ranges::copy(pdos, pdos_.data() + slot * tpdos_);
  head_.store(head + 1, std::memory_order_release);
  return true;
}

ImageView ImageRing::view_of(std::size_t position) const noexcept {
  const std::size_t slot = position % slots;
  return {stamps_[slot],
          {values_.data() + slot * signals_, signals_},
          {stale_.data() + slot * words_, words_},
          {pdos_.data() + slot * tpdos_, tpdos_}};
}

void ImageRing::release() noexcept {
  if (!holding_) return;
  tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  holding_ = false;
}

bool ImageRing::take(ImageView& view) noexcept {
  release();
  const std::size_t tail = tail_.load(std::memory_order_relaxed);
  if (tail == head_.load(std::memory_order_acquire)) return false;
  view = view_of(tail);
  holding_ = true;
  return true;
}

bool ImageRing::take_newest(ImageView& view) noexcept {
  release();
  const std::size_t head = head_.load(std::memory_order_acquire);
  if (tail_.load(std::memory_order_relaxed) == head) return false;
  tail_.store(head - 1, std::memory_order_release);
  return take(view);
}

}  // namespace takt
