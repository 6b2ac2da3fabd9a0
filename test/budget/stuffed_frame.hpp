#pragma once
#include "master/sim/random.hpp"
#include "master/wire/frame.hpp"
#include "test/budget/plan_traffic.hpp"

namespace takt {

/// Tries many data for a frame, and returns the frame with the most stuff bits.
Frame stuffed(const PlanFrame& what, sim::Random& random);

}  // namespace takt
