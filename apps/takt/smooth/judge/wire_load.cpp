#include "apps/takt/smooth/judge/wire_load.hpp"

#include <array>
#include <cstddef>

#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {

std::uint16_t wire_bits(const Frame& frame) noexcept {
  const unsigned data = frame.rtr ? 0 : 8U * frame.length;
  const unsigned head = frame.id.is_extended() ? 67 : 47;
  const unsigned stuffed = (head - 13 + data) / 16;
  return static_cast<std::uint16_t>(head + data + stuffed);
}

double wire_load(const BusRecord& bus, Time from, Time until) {
  if (until <= from) return 0;
  const double bit_ns = 1e9 / bus.bitrate;
  double busy = 0;
  auto at = std::ranges::upper_bound(bus.frames, from, {}, &WireFrame::when);
  for (; at != bus.frames.end() && at->when <= until; ++at) {
    const Time begin = at->when - Time{static_cast<std::int64_t>(bit_ns * at->bits)};
    busy += static_cast<double>((at->when - std::max(begin, from)).count());
  }
  return std::min(1.0, busy / static_cast<double>((until - from).count()));
}

std::uint32_t guessed_bitrate(const std::vector<WireFrame>& frames) {
  constexpr std::array<std::uint32_t, 7> usual{1'000'000, 800'000, 500'000, 250'000,
                                               125'000,   100'000, 50'000};
  std::vector<double> bit_times;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    bit_times.push_back(static_cast<double>((frames[i].when - frames[i - 1].when).count()) /
                        frames[i].bits);
  }
  if (bit_times.size() < 100) return 0;
  for (const std::uint32_t rate : usual) {
    const double bit = 1e9 / rate;
    const auto below = std::ranges::count_if(bit_times, [&](double t) { return t < 0.85 * bit; });
    const auto near =
        std::ranges::count_if(bit_times, [&](double t) { return t > 0.85 * bit && t < 1.1 * bit; });
    const auto all = static_cast<std::ptrdiff_t>(bit_times.size());
    if (below * 50 < all && near * 20 > all) return rate;
  }
  return 0;
}

}  // namespace takt::smooth
