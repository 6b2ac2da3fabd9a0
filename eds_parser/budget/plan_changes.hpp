#pragma once
#include <string>
#include <vector>

#include "eds_parser/budget/what_if.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// A change of a network file with its description.
struct Suggestion {
  std::string text;  ///< "SYNC every 2300 us instead of 2000 us"
  WhatIf changes;
};

/// Returns the names of the PDOs, for example "TPDO1 arm, TPDO2 arm".
std::string names_of(const std::vector<PdoChange>& changes);

/// Moves event-driven TPDOs that have priority over synchronous frames to identifiers behind all
/// synchronous frames. Empty if there are no such TPDOs, or if not enough identifiers are free.
std::vector<PdoChange> lower_priorities(const BusPlan& plan);
Suggestion lower_priority_of(std::vector<PdoChange> pdos);

/// Lets the last `count` synchronous TPDOs take turns at every second SYNC. Changes no PDO if there
/// are fewer.
Suggestion by_turns(const BusPlan& plan, unsigned count);

/// Lengthens the inhibit times of event-driven TPDOs to `factor` times the distance of two frames
/// that the budget counts: the inhibit time, else the event timer or the SYNC period, whichever is
/// shorter.
Suggestion longer_inhibits(const BusPlan& plan, unsigned factor);

/// Rounds a period up to the next value that people would write, in us.
std::uint32_t round_period(std::uint32_t period_us);

Suggestion other_period(const BusPlan& plan, std::uint32_t period_us);
Suggestion other_service_frames(const BusPlan& plan, std::uint16_t frames);
/// Returns one change for each bit rate that is higher than that of the plan, the lowest first.
std::vector<Suggestion> higher_bitrates(const BusPlan& plan);

}  // namespace takt
