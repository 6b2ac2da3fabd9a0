#include "eds_parser/budget/load.hpp"

#include "eds_parser/plan/frame_time.hpp"

namespace takt {
namespace {

/// Typical PDOs of n bytes, with small values and many zeros, have about 2 + 0.9 n stuff bits.
double typical_bits(const TrafficFrame& frame) noexcept {
  return shortest_frame_bits(frame.bytes, frame.cob_id.is_extended()) + 2.0 + 0.9 * frame.bytes;
}

double seconds(Time time) noexcept { return std::chrono::duration<double>(time).count(); }

}  // namespace

BusLoad bus_load(const BusTraffic& traffic, std::uint32_t bitrate) noexcept {
  BusLoad load;
  for (const auto& frame : traffic.frames) {
    const double worst = seconds(frame.frame) * frame.burst / seconds(frame.period);
    if (frame.kind == Traffic::sdo) {
      load.services += worst;
    } else if (frame.kind != Traffic::nmt && frame.kind != Traffic::emcy) {
      load.worst += worst;
      load.typical += typical_bits(frame) * frame.burst / bitrate / seconds(frame.period);
    }
  }
  return load;
}

}  // namespace takt
