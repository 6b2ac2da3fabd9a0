#pragma once
#include <ostream>

#include "apps/takt/simulate/simulation.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Returns a time in microseconds.
constexpr double us(Time time) noexcept { return static_cast<double>(time.count()) / 1e3; }

void print_json(std::ostream& out, const SimulationOutcome& outcome);
void print_text(std::ostream& out, const SimulationOutcome& outcome);

}  // namespace takt
