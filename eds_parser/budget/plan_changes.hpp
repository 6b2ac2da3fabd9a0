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

/// Returns the changes that move event-driven TPDOs with priority over synchronous frames to
/// identifiers behind all synchronous frames. The list is empty if there are no such TPDOs, or if
/// not enough identifiers are free.
std::vector<PdoChange> lower_priorities(const BusPlan& plan);
Suggestion lower_priority_of(std::vector<PdoChange> pdos);

/// Returns the change with which the last `count` synchronous TPDOs are sent at every second SYNC,
/// in turns. The change contains no PDO if there are fewer such TPDOs.
Suggestion by_turns(const BusPlan& plan, unsigned count);

/// Returns the change that lengthens the inhibit times of event-driven TPDOs to `factor` times the
/// distance of two frames that the budget counts: the inhibit time, else the event timer or the
/// SYNC period, whichever is shorter.
Suggestion longer_inhibits(const BusPlan& plan, unsigned factor);

/// Rounds a period up to the next value that people would write, in us.
std::uint32_t round_period(std::uint32_t period_us);

Suggestion other_period(const BusPlan& plan, std::uint32_t period_us);
Suggestion other_service_frames(const BusPlan& plan, std::uint16_t frames);
/// Returns one change for each bit rate that is higher than that of the plan, the lowest first.
std::vector<Suggestion> higher_bitrates(const BusPlan& plan);

}  // namespace takt
