#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Counts of a Histogram at one moment. The difference of two snapshots covers the time between
/// them.
struct HistogramSnapshot {
  static constexpr unsigned fine = 8;      ///< bins per octave
  static constexpr unsigned octaves = 27;  ///< 125 ns * 2^27 = 16.8 s
  static constexpr std::size_t bins = std::size_t{fine} * (octaves + 1);

  std::array<std::uint64_t, bins> counts{};

  std::uint64_t total() const noexcept;
  /// Returns the upper edge of the bin below which the fraction `p` of all times lies. Returns 0 if
  /// the histogram is empty.
  Time percentile(double p) const noexcept;
  Time minimum() const noexcept { return percentile(0.0); }
  Time maximum() const noexcept { return percentile(1.0); }
  /// Returns the counts per octave: element i counts the times in [2^i, 2^(i+1)) * 125 ns, as in
  /// timing_t.
  std::array<std::uint64_t, octaves> by_octave() const noexcept;

  HistogramSnapshot operator-(const HistogramSnapshot& earlier) const noexcept;
};

/// Histogram of times with a resolution of one eighth of an octave above 125 ns. One thread records
/// and other threads take snapshots, without a lock.
class Histogram {
 public:
  /// Negative times count as zero.
  [[gnu::always_inline]] void record(Time time) noexcept {
    std::atomic<std::uint64_t>& bin = counts_[bin_of(time)];
    bin.store(bin.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  HistogramSnapshot snapshot() const noexcept;

  /// Bins 0..7 are linear with a width of 125 ns / 8; above them each octave has eight bins.
  static constexpr std::size_t bin_of(Time time) noexcept {
    if (time <= Time{0}) return 0;
    const std::uint64_t units = static_cast<std::uint64_t>(time.count()) * 8 / 125;
    if (units < 8) return static_cast<std::size_t>(units);
    const auto octave = static_cast<unsigned>(std::bit_width(units)) - 4;  // 0: [8, 16)
    if (octave >= HistogramSnapshot::octaves) return HistogramSnapshot::bins - 1;
    return (std::size_t{octave} + 1) * 8 + ((units >> octave) & 7);
  }
  /// Returns the upper edge of the bin: the shortest time that belongs to the next bin.
  static constexpr Time upper_edge(std::size_t bin) noexcept {
    const std::uint64_t octave = bin / 8;
    const std::uint64_t step = bin % 8 + 1;
    const std::uint64_t units = octave == 0 ? step : (8 + step) << (octave - 1);
    return Time{static_cast<std::int64_t>(units * 125 / 8)};
  }

 private:
  std::array<std::atomic<std::uint64_t>, HistogramSnapshot::bins> counts_{};
};

}  // namespace takt
