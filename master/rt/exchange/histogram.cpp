#include "master/rt/exchange/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace takt {

std::uint64_t HistogramSnapshot::total() const noexcept {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

Time HistogramSnapshot::percentile(double p) const noexcept {
  const std::uint64_t all = total();
  if (all == 0) return Time{0};
  const double wanted = std::max(1.0, std::ceil(p * static_cast<double>(all)));
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    seen += counts[bin];
    if (static_cast<double>(seen) >= wanted) return Histogram::upper_edge(bin);
  }
  return Histogram::upper_edge(bins - 1);
}

std::array<std::uint64_t, HistogramSnapshot::octaves> HistogramSnapshot::by_octave()
    const noexcept {
  std::array<std::uint64_t, octaves> sums{};
  for (std::size_t bin = 0; bin < bins; ++bin) {
    sums[bin < 2 * fine ? 0 : bin / fine - 1] += counts[bin];
  }
  return sums;
}

HistogramSnapshot HistogramSnapshot::operator-(const HistogramSnapshot& earlier) const noexcept {
  HistogramSnapshot difference;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    difference.counts[bin] = counts[bin] - earlier.counts[bin];
  }
  return difference;
}

HistogramSnapshot Histogram::snapshot() const noexcept {
  HistogramSnapshot result;
  for (std::size_t bin = 0; bin < HistogramSnapshot::bins; ++bin) {
    result.counts[bin] = counts_[bin].load(std::memory_order_relaxed);
  }
  return result;
}

}  // namespace takt
