#include "eds_parser/budget/fitting_services.hpp"

#include "eds_parser/plan/cycle_compiler.hpp"

namespace takt {

std::optional<std::uint16_t> fitting_service_frames(const BusPlan& plan,
                                                    const BudgetOptions& options) {
  BusPlan tried = plan;
  const auto fits = [&](std::uint16_t frames) {
    tried.cycle.service_frames = frames;
    return bus_fits(tried, options);
  };
  if (!fits_period(plan)) return std::nullopt;
  std::uint16_t too_many = plan.cycle.service_frames;
  if (fits(too_many)) return too_many;
  std::uint16_t enough = 1;
  if (too_many <= enough || !fits(enough)) return std::nullopt;
  while (too_many - enough > 1) {
    const auto middle = static_cast<std::uint16_t>((enough + too_many) / 2);
    (fits(middle) ? enough : too_many) = middle;
  }
  return enough;
}

}  // namespace takt
