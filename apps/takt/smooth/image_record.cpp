#include "apps/takt/smooth/image_record.hpp"

#include <algorithm>
#include <utility>

#include "apps/takt/smooth/make_record.hpp"

namespace takt::smooth {
namespace {

/// An image that comes more cycles than this after the first one belongs to another run.
constexpr std::int64_t most_cycles = 1'000'000'000;

/// Returns the layout in the form of a map: the outputs of a node as one RPDO, the inputs as a
/// TPDO.
PdoMap map_of(const std::vector<signal_t>& signals) {
  PdoMap map;
  for (const signal_t& signal : signals) {
    const auto node = static_cast<std::uint8_t>(signal.node_id);
    const bool output = signal.output != 0;
    map.nodes[node].name = signal.node;
    const CobId id = CobId::base((output ? 0x200U : 0x180U) + node);
    MapPdo& pdo = map.pdos[id];
    pdo.id = id;
    pdo.node = node;
    pdo.is_rpdo = output;
    pdo.fields.push_back(
        {{static_cast<std::uint16_t>(signal.index), static_cast<std::uint8_t>(signal.sub)},
         0,
         static_cast<unsigned>(signal.bits)});
  }
  return map;
}

}  // namespace

ImageRecord::ImageRecord(std::string source, const std::vector<signal_t>& signals, Time period)
    : period_{period} {
  out_.source = std::move(source);
  out_.with_times = false;
  out_.planned_period = period;
  out_.axes = axes_of(map_of(signals));
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const signal_t& signal = signals[i];
    const ObjectKey object{static_cast<std::uint16_t>(signal.index),
                           static_cast<std::uint8_t>(signal.sub)};
    for (std::size_t axis = 0; axis < out_.axes.size(); ++axis) {
      if (out_.axes[axis].node != signal.node_id) continue;
      if (samples_of(out_.axes[axis], object, signal.output != 0) == nullptr) continue;
      routes_.emplace(static_cast<std::int32_t>(i), Route{axis, object, signal.output != 0});
    }
  }
}

void ImageRecord::take(const image_t& image) {
  if (newest_cycle_ < 0) first_cycle_ = image.cycle;
  if (image.cycle < newest_cycle_ || image.cycle - first_cycle_ > most_cycles) return;
  // The times are those of an exact period, because only the values are judged.
  const Time sync = period_ * (image.cycle - first_cycle_);
  if (image.cycle > newest_cycle_) out_.syncs.push_back(sync);
  newest_cycle_ = image.cycle;
  for (std::int32_t i = 0; i < image.num_values; ++i) {
    const std::int32_t signal = image.first_signal + i;
    const auto [first, last] = routes_.equal_range(signal);
    if (first == last || std::ranges::find(image.stale, signal) != image.stale.end()) continue;
    for (auto at = first; at != last; ++at) {
      const Route& route = at->second;
      const Time when = sync + (route.output ? period_ / 2 : period_ / 4);
      samples_of(out_.axes[route.axis], route.object, route.output)
          ->push_back({when, image.values[static_cast<std::size_t>(i)]});
    }
  }
}

BusRecord ImageRecord::finish() {
  if (!out_.syncs.empty()) out_.length = out_.syncs.back();
  keep_used_set_points(out_.axes);
  out_.remarks.emplace_back(
      "The images of the daemon show values, not the times of frames: SYNC and arrivals are not "
      "judged. `takt smooth live --bus can0` judges them.");
  return std::move(out_);
}

}  // namespace takt::smooth
