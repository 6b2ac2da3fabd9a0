#pragma once
#include <takt/histogram_t.hpp>

#include "eds_parser/values/time.hpp"
#include "master/lcm/messages.hpp"
#include "master/rt/exchange/histogram.hpp"

namespace takt {

/// Measures how long after SYNC this program receives each image, as an ordinary subscriber. Images
/// of a daemon on another machine are left out, because its monotonic clock differs from ours.
class ImageDelay {
 public:
  /// Notes an image that arrived at `now` (monotonic). `offset` is CLOCK_REALTIME minus
  /// CLOCK_MONOTONIC on this machine. An image in several parts counts when its last part arrives.
  void take(const image_t& image, Time now, Time offset);
  /// Returns the histogram `sync_to_callback` of the times since the last call. It is empty if no
  /// image came from this machine.
  histogram_t finish();

 private:
  Histogram times_;
  HistogramSnapshot earlier_;
};

}  // namespace takt
