#pragma once
#include <optional>

#include "master/motion/phase_writer.hpp"
#include "master/motion/transfer.hpp"

namespace takt::motion {

/// A motion of a given duration with one constant velocity in its middle, which the axis reaches
/// and leaves in the shortest time. An axis that has more time than it needs moves in this way.
struct Cruise {
  double velocity = 0.0;
  double duration = 0.0;  ///< of the part with this velocity, in s
};

/// Returns the cruise that makes `transfer` in `duration` with this distance, if its velocity lies
/// between `lowest` and `highest`.
std::optional<Cruise> find_cruise(const Transfer& transfer, double duration, double distance,
                                  double lowest, double highest) noexcept;

/// Appends the phases of a motion with `cruise`.
void add_cruise(const Transfer& transfer, const Cruise& cruise, PhaseWriter& writer) noexcept;

}  // namespace takt::motion
