#pragma once
#include <string>
#include <takt/node_status_t.hpp>

#include "apps/takt/live/text/line.hpp"

namespace takt {

std::string nmt_name(int state);  ///< returns for example "operational"
/// Returns for example "ready" or "step 4 of 31".
std::string boot_name(const node_status_t& node);
/// Returns the name of status_t::stop: "none", "under way", "confirmed" or "not confirmed".
std::string stop_name(int stop);
/// Returns the state in diagnosis_t as a word, for example "running".
std::string bus_condition(int state);

PaintedText nmt_text(int state);
/// Returns the text of boot_name() in the colour of the state. A boot in progress is shortened to
/// "boot 4/31", so that the text has at most 18 columns.
PaintedText boot_text(const node_status_t& node);

}  // namespace takt
