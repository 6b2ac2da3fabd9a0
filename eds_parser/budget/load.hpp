#pragma once
#include "eds_parser/budget/traffic.hpp"

namespace takt {

/// Shares of the bus capacity; 1 is the whole capacity.
struct BusLoad {
  double typical = 0;   ///< SYNC, PDOs, error control and TIME, with a usual number of stuff bits
  double worst = 0;     ///< the same with worst stuffing
  double services = 0;  ///< greatest share of SDO, in addition to `worst`
};

BusLoad bus_load(const BusTraffic& traffic, std::uint32_t bitrate) noexcept;

}  // namespace takt
