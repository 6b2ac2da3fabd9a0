#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>

#include "test/budget/hand_made_bus.hpp"
#include "test/budget/random_bus.hpp"
#include "test/budget/worst_phase.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// TAKT_BUDGET_NETWORKS=5000 tests this number of random networks instead of a few.
unsigned networks() {
  const char* text = std::getenv("TAKT_BUDGET_NETWORKS");
  return text == nullptr ? 100 : static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

using Bound = std::optional<Time> BudgetRow::*;

/// Returns true if no frame remains for a later cycle, and if the outputs delay SYNC by no more
/// than the tolerance.
bool has_all_bounds(const BusBudget& budget) {
  return std::ranges::all_of(budget.rows, [](const BudgetRow& row) {
    return row.worst && (row.cycle == Time{0} || *row.worst <= row.cycle + row.tolerance);
  });
}

bool cycle_fits(const BusBudget& budget) {
  return std::ranges::all_of(
      budget.rows, [](const BudgetRow& row) { return !row.frame.in_cycle || row.fits(); });
}

/// Returns the bound of the latest synchronous frame divided by its measured end, for TPDOs or for
/// RPDOs, whichever is greater.
double widest(const BusBudget& budget, const SeenBus& seen) {
  double widest = 0;
  for (const auto kind : {Traffic::tpdo, Traffic::rpdo}) {
    Time bound{};
    Time sight{1};
    for (std::size_t i = 0; i < seen.rows.size(); ++i) {
      const auto& row = budget.rows[i];
      if (!row.frame.in_cycle || row.frame.kind != kind || *row.worst <= bound) continue;
      bound = *row.worst;
      sight = seen.rows[i].worst;
    }
    widest = std::max(widest, std::chrono::duration<double>(bound) / sight);
  }
  return widest;
}

/// Returns the greatest such quotient of SYNC and all synchronous frames.
double widest_of_each(const BusBudget& budget, const SeenBus& seen) {
  double widest = 0;
  for (std::size_t i = 0; i < seen.rows.size(); ++i) {
    const auto& row = budget.rows[i];
    if (!row.frame.in_cycle) continue;
    const Time sight = std::max(seen.rows[i].worst, Time{1});
    widest = std::max(widest, std::chrono::duration<double>(*row.worst) / sight);
  }
  return widest;
}

void take_worst(SeenBus& seen, const SeenBus& more) {
  for (std::size_t i = 0; i < seen.rows.size(); ++i) {
    seen.rows[i].worst = std::max(seen.rows[i].worst, more.rows[i].worst);
  }
}

void expect_within_bounds(const BusBudget& budget, const SeenBus& seen, Bound bound,
                          unsigned network) {
  EXPECT_EQ(seen.not_in_budget, 0U) << "network " << network;
  for (std::size_t i = 0; i < seen.rows.size(); ++i) {
    const auto& row = budget.rows[i];
    if (!(row.*bound) || seen.rows[i].frames == 0) continue;
    EXPECT_LE(seen.rows[i].worst, *(row.*bound)) << row.frame.name << " of network " << network;
  }
}

/// TAKT_BUDGET_FIRST=10000 begins with network 10000 instead of 0.
unsigned first_network() {
  const char* text = std::getenv("TAKT_BUDGET_FIRST");
  return text == nullptr ? 0 : static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

TEST(Budget, NoFrameIsLaterThanItsBound) {
  unsigned bounded = 0;
  for (unsigned n = 0; n < networks(); ++n) {
    const unsigned network = first_network() + n;
    sim::Random random{network};
    const BusPlan plan = random_bus(random);
    const Time device_time = std::chrono::microseconds{random.below(100)};
    const auto budget = bus_budget(plan, {.device_time = device_time});
    bounded += has_all_bounds(budget);
    EXPECT_EQ(bus_fits(plan, {.device_time = device_time}), budget.fits()) << network;

    const auto seen =
        run_worst_phase(plan, budget, {.device_time = device_time, .cycles = 60}, random);

    expect_within_bounds(budget, seen, &BudgetRow::worst, network);
  }
  EXPECT_GE(bounded, networks() / 3);
  std::printf("%u of %u networks have all bounds\n", bounded, networks());
}

TEST(Budget, NoFrameIsLaterThanItsBoundBehindServiceFramesInOneQueue) {
  unsigned bounded = 0;
  for (unsigned n = 0; n < networks(); ++n) {
    const unsigned network = first_network() + n;
    sim::Random random{network};
    const BusPlan plan = random_bus(random);
    const Time device_time = std::chrono::microseconds{random.below(100)};
    const auto budget = bus_budget(plan, {.device_time = device_time});
    bounded += std::ranges::all_of(
        budget.rows, [](const BudgetRow& row) { return row.worst_behind_services.has_value(); });

    const auto seen = run_worst_phase(
        plan, budget, {.device_time = device_time, .cycles = 60, .one_queue = true}, random);

    expect_within_bounds(budget, seen, &BudgetRow::worst_behind_services, network);
  }
  EXPECT_GE(bounded, networks() * 2 / 5);
  std::printf("%u of %u networks have all bounds\n", bounded, networks());
}

/// The cycles in which the longest frames meet are rare, so these networks run for more cycles.
SeenBus seen_on(const BusPlan& plan, const BusBudget& budget, sim::Random& random, double most) {
  auto seen = run_worst_phase(plan, budget, {.device_time = 30us, .cycles = 600}, random);
  for (std::uint64_t more = 1; more <= 30 && widest_of_each(budget, seen) > most; ++more) {
    take_worst(seen, run_worst_phase(plan, budget, {.device_time = 30us, .cycles = 2000},
                                     random.fork(more)));
  }
  return seen;
}

TEST(Budget, EachBoundOfAFullBusIsWithinFifteenPercentOfTheWorstSeen) {
  constexpr double most = 1.15;
  unsigned full = 0;
  double worst_of_last = 0;
  double worst = 0;
  for (unsigned n = 0; n < networks(); ++n) {
    const unsigned network = first_network() + n;
    sim::Random random{network};
    const BusPlan plan =
        random_bus(random, {.by_event = 0, .followed = 0, .least_percent = 70, .most_percent = 92});
    const auto budget = bus_budget(plan);
    if (!cycle_fits(budget)) continue;

    const auto seen = seen_on(plan, budget, random, most);

    const double any = widest_of_each(budget, seen);
    EXPECT_LE(any, most) << "SYNC or a PDO of network " << network;
    worst_of_last = std::max(worst_of_last, widest(budget, seen));
    worst = std::max(worst, any);
    ++full;
  }
  EXPECT_GE(full, networks() / 5);
  std::printf("bound / worst seen of %u full buses: %.3f at most, %.3f of the last PDOs\n", full,
              worst, worst_of_last);
}

TEST(Budget, NoFrameIsLaterThanItsBoundInABurstOfEmcys) {
  for (unsigned n = 0; n < networks(); ++n) {
    const unsigned network = first_network() + n;
    sim::Random random{network};
    const BusPlan plan = random_bus(random);
    const auto budget = bus_budget(plan);

    const auto seen =
        run_worst_phase(plan, budget, {.device_time = 30us, .cycles = 30, .emcys = true}, random);

    expect_within_bounds(budget, seen, &BudgetRow::worst_in_burst, network);
  }
}

TEST(Budget, NoFrameIsLaterThanItsBoundWithErrors) {
  unsigned bounded = 0;
  std::uint64_t errors = 0;
  for (unsigned n = 0; n < networks(); ++n) {
    const unsigned network = first_network() + n;
    sim::Random random{network};
    const BusPlan plan = random_bus(random, {.least_percent = 20, .most_percent = 80});
    const Time distance = plan.cycle.period * (10 + random.below(190)) / 100;
    const auto budget = bus_budget(plan, {.errors = {.burst = 1, .interval = distance}});
    bounded += has_all_bounds(budget);
    PhaseOptions options{.device_time = 30us, .cycles = 60, .error_distance = distance};

    const auto seen = run_worst_phase(plan, budget, options, random.fork(1));
    options.one_queue = true;
    const auto queue = run_worst_phase(plan, budget, options, random.fork(2));
    options.one_queue = false;
    options.emcys = true;
    const auto burst = run_worst_phase(plan, budget, options, random.fork(3));

    expect_within_bounds(budget, seen, &BudgetRow::worst, network);
    expect_within_bounds(budget, queue, &BudgetRow::worst_behind_services, network);
    expect_within_bounds(budget, burst, &BudgetRow::worst_in_burst, network);
    errors += seen.errors;
  }
  EXPECT_GE(bounded, networks() / 4);
  EXPECT_GE(errors, 10 * networks());
  std::printf("%u of %u networks have all bounds, %llu errors\n", bounded, networks(),
              static_cast<unsigned long long>(errors));
}

TEST(Budget, NoFrameIsLaterThanItsBoundWithManyErrorsInACycle) {
  for (std::uint8_t nodes = 5; nodes <= 25; ++nodes) {
    const BusPlan plan = hand_made_bus(nodes, nodes * 2ms);
    const auto budget = bus_budget(plan, {.errors = {.burst = 1, .interval = 600us}});
    ASSERT_TRUE(cycle_fits(budget)) << unsigned{nodes};

    const auto seen =
        run_worst_phase(plan, budget, {.device_time = 30us, .cycles = 200, .error_distance = 600us},
                        sim::Random{nodes});

    expect_within_bounds(budget, seen, &BudgetRow::worst, nodes);
    EXPECT_GE(seen.errors, 500U);
  }
}

}  // namespace
}  // namespace takt
