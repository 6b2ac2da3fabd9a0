#include "eds_parser/table/mechanics.hpp"

#include <algorithm>
#include <cmath>

namespace takt {
namespace {

constexpr double largest_angle = 0.5;  // rad of the stiffest mode in one step of the integration

}  // namespace

double stiffest_mode(const MechanicsTable& table) noexcept {
  if (!table.load.stiffness) return 0;
  const double mobility = 1 / table.motor.inertia + 1 / table.load.inertia;
  return std::sqrt(*table.load.stiffness * mobility);
}

int mechanics_steps(const MechanicsTable& table) noexcept {
  const double steps = std::ceil(stiffest_mode(table) * mechanics_tick / largest_angle);
  return static_cast<int>(std::clamp(steps, 1.0, most_mechanics_steps + 1.0));
}

}  // namespace takt
