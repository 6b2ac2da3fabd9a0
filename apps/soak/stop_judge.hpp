#pragma once
#include <cstdint>
#include <vector>

#include "apps/soak/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/core/ordered_stop.hpp"
#include "master/sim/world.hpp"

namespace takt {

/// Holds the verdict of an ordered stop against the simulated drives themselves: an axis that the
/// master confirms was at standstill when its power stage went off, and it is off.
class StopJudge {
 public:
  StopJudge(const BusPlan& plan, sim::World& world, Verdict& verdict);

  /// The stop is asked for.
  void begin();
  /// After each cycle from then on.
  void look();
  void hear(const Event& event);
  /// The stop is over.
  void judge(StopResult result);
  /// Axes that had their power stage on when the stop began, and were confirmed.
  std::uint64_t confirmed() const noexcept { return confirmed_; }

 private:
  struct Axis {
    const NodePlan* node = nullptr;
    const AxisPlan* plan = nullptr;
    bool powered = false;         ///< now
    bool was_powered = false;     ///< at some time since the stop began
    std::int64_t speed_then = 0;  ///< when its power stage went off last
    bool blamed = false;          ///< the master says that it was not stopped
  };

  sim::World& world_;
  Verdict& verdict_;
  std::vector<Axis> axes_;
  bool begun_ = false;
  std::uint64_t confirmed_ = 0;
};

}  // namespace takt
