#pragma once
#include <optional>

#include "master/motion/phase_writer.hpp"
#include "master/motion/transfer.hpp"

namespace takt::motion {

/// A motion with a phase of constant velocity in its middle. The axis changes to this velocity and
/// from it in the shortest time. An axis that has more time than it needs moves in this way.
struct Cruise {
  double velocity = 0.0;
  double duration = 0.0;  ///< duration of the phase with this velocity, in s
};

/// Returns the cruise with which the axis makes `transfer` over `distance` in `duration`. Returns
/// std::nullopt if its velocity would not be between `lowest` and `highest`.
std::optional<Cruise> find_cruise(const Transfer& transfer, double duration, double distance,
                                  double lowest, double highest) noexcept;

/// Appends the phases of the motion that makes `transfer` with `cruise`.
void add_cruise(const Transfer& transfer, const Cruise& cruise, PhaseWriter& writer) noexcept;

}  // namespace takt::motion
