#include "apps/takt/live/image_delay.hpp"

#include <chrono>

#include "master/gateway/message/status_messages.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// Largest difference between the clock offset in an image and the clock offset of this machine, if
/// the image comes from this machine. The offset is CLOCK_REALTIME minus CLOCK_MONOTONIC. On one
/// machine, it changes only by the corrections of NTP.
constexpr Time same_clock = 5ms;

bool is_of_this_machine(const image_t& image, Time offset) noexcept {
  const std::int64_t there = image.utime - image.sync_mono_ns / 1000;
  const std::int64_t here = offset / 1us;
  const std::int64_t limit = same_clock / 1us;
  return there > here - limit && there < here + limit;
}

}  // namespace

void ImageDelay::take(const image_t& image, Time now, Time offset) {
  const bool last = image.part + 1 == image.parts;
  if (last && is_of_this_machine(image, offset)) times_.record(now - Time{image.sync_mono_ns});
}

histogram_t ImageDelay::finish() {
  const HistogramSnapshot now = times_.snapshot();
  histogram_t message = histogram_message("sync_to_callback", now - earlier_);
  earlier_ = now;
  return message;
}

}  // namespace takt
