#pragma once
#include <cstdint>
#include <span>
#include <takt/pdo_status_t.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/exchange/exchange.hpp"

namespace takt {

/// Most PDOs in one pdo_status_t, which then stays below message_bytes.
inline constexpr std::size_t pdos_a_message = 16;

/// Returns the state of every PDO as messages: TPDOs, then RPDOs, in the order of the plan. `marks`
/// belong to the image of `cycle`; they are empty before the first image.
std::vector<pdo_status_t> pdo_messages(const BusPlan& plan, const StatusSnapshot& snapshot,
                                       std::span<const PdoMark> marks, std::uint64_t cycle);

}  // namespace takt
