#pragma once
#include <string>
#include <takt/node_status_t.hpp>

#include "apps/takt/live/view/line.hpp"

namespace takt {

std::string nmt_name(int state);                   ///< for example "operational"
std::string boot_name(const node_status_t& node);  ///< for example "ready" or "step 4 of 31"
/// Returns the name of status_t::stop: "none", "under way", "confirmed" or "not confirmed".
std::string stop_name(int stop);
std::string bus_condition(int state);  ///< state in diagnosis_t, for example "running"

PaintedText nmt_text(int state);
/// Returns the same as boot_name() in the colour of the state, in at most 18 columns.
PaintedText boot_text(const node_status_t& node);

}  // namespace takt
