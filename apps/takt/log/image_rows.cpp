#include "apps/takt/log/image_rows.hpp"

#include <algorithm>

namespace takt::logging {

ImageRows::ImageRows(const std::vector<LoggedSignal>& signals)
    : raw_(signals.size()), fresh_(signals.size()) {
  for (std::size_t column = 0; column < signals.size(); ++column) {
    columns_.emplace_back(signals[column].position, column);
  }
  std::ranges::sort(columns_);
}

std::optional<LogRow> ImageRows::take(const image_t& image) {
  if (image.part == 0) {
    cycle_ = image.cycle;
    next_part_ = 0;
    std::ranges::fill(fresh_, std::uint8_t{0});
  }
  if (image.cycle != cycle_ || image.part != next_part_ || image.first_signal < 0) return {};
  ++next_part_;
  const auto first = static_cast<std::size_t>(image.first_signal);
  auto at = std::ranges::lower_bound(columns_, std::pair{first, std::size_t{0}});
  for (; at != columns_.end() && at->first - first < image.values.size(); ++at) {
    raw_[at->second] = image.values[at->first - first];
    fresh_[at->second] = 1;
  }
  for (const std::int32_t stale : image.stale) {
    const auto position = static_cast<std::size_t>(stale);
    const auto found = std::ranges::lower_bound(columns_, std::pair{position, std::size_t{0}});
    if (found != columns_.end() && found->first == position) fresh_[found->second] = 0;
  }
  if (next_part_ != image.parts || cycle_ <= last_cycle_) return {};
  const std::int64_t lost = last_cycle_ < 0 ? 0 : cycle_ - last_cycle_ - 1;
  last_cycle_ = cycle_;
  return LogRow{.utime = image.utime,
                .sync_ns = image.sync_mono_ns,
                .cycle = cycle_,
                .lost = lost,
                .raw = raw_,
                .fresh = fresh_};
}

}  // namespace takt::logging
