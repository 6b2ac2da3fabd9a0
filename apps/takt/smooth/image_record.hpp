#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <takt/image_t.hpp>
#include <takt/signal_t.hpp>
#include <vector>

#include "apps/takt/smooth/judge/bus_record.hpp"

namespace takt::smooth {

/// Makes a record from the images of a running daemon. An image has the values of a cycle, but not
/// the times of its frames: SYNC and arrivals are therefore not judged.
class ImageRecord {
 public:
  /// `signals` is the layout of the bus, and `period` that of SYNC.
  ImageRecord(std::string source, const std::vector<signal_t>& signals, Time period);

  /// Takes an image, or a part of a large one.
  void take(const image_t& image);
  BusRecord finish();

 private:
  /// The destination of a value of the image.
  struct Route {
    std::size_t axis = 0;
    ObjectKey object{};
    bool output = false;
  };

  BusRecord out_;
  Time period_;
  std::multimap<std::int32_t, Route> routes_;
  std::int64_t first_cycle_ = 0;
  std::int64_t newest_cycle_ = -1;
};

}  // namespace takt::smooth
