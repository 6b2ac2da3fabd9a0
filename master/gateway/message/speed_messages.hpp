#pragma once
#include <cstdint>
#include <takt/speed_axes_t.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Describes the speed axes of the plan, with a few axes per message. Empty if there are none.
std::vector<speed_axes_t> speed_messages(const BusPlan& plan, std::int64_t session);

}  // namespace takt
