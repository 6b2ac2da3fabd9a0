#pragma once
#include <string>
#include <vector>

#include "eds_parser/budget/what_if.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Returns the names of the PDOs, for example "TPDO1 arm, TPDO2 arm".
std::string names_of(const std::vector<PdoChange>& changes);

/// Moves event-driven TPDOs that have priority over synchronous frames to identifiers behind all
/// synchronous frames. Empty if there are no such TPDOs, or if not enough identifiers are free.
std::vector<PdoChange> lower_priorities(const BusPlan& plan);

/// Lets the last `count` synchronous TPDOs take turns at every second SYNC. Empty if there are
/// fewer.
WhatIf by_turns(const BusPlan& plan, std::size_t count);

/// Lengthens the inhibit times of event-driven TPDOs to `factor` times the distance of two frames
/// that the budget counts: the inhibit time, else the event timer or the SYNC period, whichever is
/// shorter.
std::vector<PdoChange> longer_inhibits(const BusPlan& plan, unsigned factor);

/// Rounds a period up to the next value that people would write, in us.
std::uint32_t round_period(std::uint32_t period_us);

/// Returns for example "SYNC every 2300 us instead of 2000 us".
std::string period_text(const BusPlan& plan, std::uint32_t period_us);
/// Returns for example "`service_frames: 8` instead of 16".
std::string services_text(const BusPlan& plan, std::uint16_t frames);
/// Returns for example "500 kbit/s instead of 250".
std::string bitrate_text(const BusPlan& plan, std::uint16_t kbit);

}  // namespace takt
