#pragma once
#include <cstdint>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/core/stop_state.hpp"
#include "master/sim/bus/world.hpp"

namespace takt::soak {

/// Checks the result of an ordered stop against the simulated drives themselves: an axis that the
/// master confirms must have been at standstill when its power stage went off, and the power stage
/// must still be off.
class StopJudge {
 public:
  StopJudge(const BusPlan& plan, sim::World& world, Verdict& verdict);

  /// Call this when the stop is requested.
  void begin();
  /// Call this after each cycle of the stop.
  void look();
  void hear(const Event& event);
  /// Call this when the stop is over.
  void judge(StopResult result);
  /// Returns the number of confirmed axes whose power stage was on at some time since the stop
  /// began.
  std::uint64_t confirmed() const noexcept { return confirmed_; }

 private:
  struct Axis {
    const NodePlan* node = nullptr;
    const AxisPlan* plan = nullptr;
    bool powered = false;         ///< the power stage is on now
    bool was_powered = false;     ///< the power stage was on at some time since the stop began
    std::int64_t speed_then = 0;  ///< speed when the power stage last went off
    bool blamed = false;          ///< the master reports that the axis was not stopped
  };

  sim::World& world_;
  Verdict& verdict_;
  std::vector<Axis> axes_;
  bool begun_ = false;
  std::uint64_t confirmed_ = 0;
};

}  // namespace takt::soak
