#pragma once
#include <string>
#include <vector>

#include "eds_parser/budget/what_if.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// "TPDO1 arm, TPDO2 arm".
std::string names_of(const std::vector<PdoChange>& changes);

/// Identifiers behind all that is synchronous for event-driven TPDOs that are before some of it.
/// Empty: there are none, or not enough identifiers are free.
std::vector<PdoChange> lower_priorities(const BusPlan& plan);

/// The last so many synchronous TPDOs in every second SYNC, by turns. Empty: there are less.
WhatIf by_turns(const BusPlan& plan, std::size_t count);

/// Event-driven TPDOs at most each `factor` times their inhibit time, or the period where they
/// have none.
std::vector<PdoChange> longer_inhibits(const BusPlan& plan, unsigned factor);

/// The next longer period that people would write, in us.
std::uint32_t round_period(std::uint32_t period_us);

/// "SYNC every 2300 us instead of 2000 us".
std::string period_text(const BusPlan& plan, std::uint32_t period_us);
/// "500 kbit/s instead of 250".
std::string bitrate_text(const BusPlan& plan, std::uint16_t kbit);

}  // namespace takt
