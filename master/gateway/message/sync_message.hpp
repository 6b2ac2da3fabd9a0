#pragma once
#include <cstdint>
#include <takt/sync_status_t.hpp>

#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/exchange/status_board.hpp"

namespace takt {

/// Reports the source of SYNC and whether the cycle follows it.
sync_status_t sync_message(const BusPlan& plan, const BusStatus& bus);

}  // namespace takt
