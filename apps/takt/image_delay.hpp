#pragma once
#include <cstdint>
#include <string_view>
#include <takt/histogram_t.hpp>

#include "eds_parser/table/time.hpp"
#include "master/gateway/messages.hpp"
#include "master/rt/histogram.hpp"

namespace takt {

/// How long after SYNC this program, a subscriber as any other, has each image in its hands. Images
/// of a daemon on another machine are left out, since its monotonic clock is not ours.
class ImageDelay {
 public:
  /// An image that arrived at `now` (monotonic); `offset` is CLOCK_REALTIME minus CLOCK_MONOTONIC
  /// here. An image in several parts counts when its last part is there.
  void take(const image_t& image, Time now, Time offset);
  /// The times since the last call: `sync_to_callback`, without any where no image came from this
  /// machine.
  histogram_t finish();

 private:
  Histogram times_;
  HistogramSnapshot earlier_;
};

}  // namespace takt
