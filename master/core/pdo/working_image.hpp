#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace takt {

/// The current values of a bus: inputs as received, outputs as last packed. Bus thread only.
struct WorkingImage {
  explicit WorkingImage(std::size_t signals) : values(signals, 0), stale((signals + 63) / 64, 0) {}

  void set_stale(std::size_t signal, bool on) noexcept {
    const std::uint64_t bit = 1ULL << (signal % 64);
    stale[signal / 64] = on ? stale[signal / 64] | bit : stale[signal / 64] & ~bit;
  }
  bool is_stale(std::size_t signal) const noexcept {
    return ((stale[signal / 64] >> (signal % 64)) & 1) != 0;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(values, stale);
  }

  std::vector<std::int64_t> values;
  std::vector<std::uint64_t> stale;  ///< bit n % 64 of word n / 64 belongs to signal n
};

}  // namespace takt
