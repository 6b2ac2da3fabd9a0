#pragma once
#include "eds_parser/budget/traffic.hpp"

namespace takt {

/// Shares of the bus; 1 is all of it.
struct BusLoad {
  double typical = 0;  ///< SYNC, PDOs, error control and TIME, with as many stuff bits as they have
  double worst = 0;    ///< the same with worst stuffing
  double services = 0;  ///< what the master gives to SDO at most, on top of `worst`
};

BusLoad bus_load(const BusTraffic& traffic, std::uint32_t bitrate) noexcept;

}  // namespace takt
