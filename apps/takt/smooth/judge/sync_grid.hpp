#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt::smooth {

/// One SYNC, and the number of periods since the one before: 1, or more if SYNC was missing.
struct Tick {
  Time when{};
  std::uint32_t periods = 1;
};

/// The SYNC of a recording: its period and its deviations.
struct SyncGrid {
  Time period{};              ///< 0 if there is no SYNC
  std::vector<Tick> ticks;    ///< ticks without the surplus SYNCs
  std::uint64_t missing = 0;  ///< periods without SYNC
  std::uint64_t surplus = 0;  ///< SYNCs that come in addition to one in each period
  Time first_missing{};
  Time first_surplus{};
  Time jitter{};                 ///< 95 of 100 intervals differ less than this from the period
  Time largest_deviation{};      ///< largest deviation of an interval without missing SYNC
  std::uint64_t unpunctual = 0;  ///< intervals that differ by more than a tenth of the period
  Time first_unpunctual{};
};

/// Finds the period of SYNC. `planned` is the period by the settings; it helps if SYNC comes twice
/// in each period.
SyncGrid sync_grid(std::span<const Time> syncs, std::optional<Time> planned);

}  // namespace takt::smooth
