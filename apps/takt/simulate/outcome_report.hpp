#pragma once
#include <ostream>

#include "apps/takt/simulate/simulation.hpp"

namespace takt {

void print_json(std::ostream& out, const SimulationOutcome& outcome);
void print_text(std::ostream& out, const SimulationOutcome& outcome);

}  // namespace takt
