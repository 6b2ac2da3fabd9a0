#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "apps/takt/simulate/program/agenda.hpp"
#include "apps/takt/simulate/program/forger.hpp"
#include "apps/takt/simulate/program/stage.hpp"
#include "apps/takt/simulate/program/virtual_application.hpp"
#include "apps/takt/simulate/program/virtual_daemon.hpp"
#include "apps/takt/simulate/program/virtual_lcm.hpp"
#include "master/sim/bus/world.hpp"
#include "master/sim/random.hpp"

namespace takt::soak {

/// The objects that the faults of programs act on.
struct Cast {
  sim::World& world;
  VirtualLcm& lcm;
  VirtualClocks& clocks;
  VirtualDaemon& daemon;
  std::vector<std::unique_ptr<VirtualApplication>>& applications;
  VirtualApplication& rival;  ///< has the name and the axes of the first application
  Forger& forger;
};

/// Applies random faults to the programs: they are stopped for a time, die and start again, and
/// have rivals; their messages are slow, repeated and forged. Each fault comes at a random time and
/// lasts for a random time.
class RandomProgramFaults final : public Actor {
 public:
  /// `mean_pause` is the mean time between two faults.
  struct Span {
    Time from{};
    Time until{};
    Time mean_pause = std::chrono::milliseconds{400};
  };

  /// `disturbed` is called with each fault, and with the time at which its effects are over.
  RandomProgramFaults(Cast cast, sim::Random random, const Span& span,
                      std::function<void(Time until)> disturbed, bool verbose);

  Time next() const noexcept override;
  void act(Time now) override;
  /// Returns true if the caller has to kill the daemon, between two cycles.
  bool daemon_dies() const noexcept { return daemon_dies_; }
  void daemon_died(Time now);
  std::uint64_t count() const noexcept { return count_; }

 private:
  void begin(Time now);
  void stall_front(Time now);
  void stall_process(Time now);
  void stall_application(Time now);
  void let_jump(Time now);
  void kill_application(Time now);
  void bring_rival(Time now);
  void slow_down_lcm(Time now);
  void announce(Time now, const char* what, Time span) const;
  Time span();
  VirtualApplication& application();

  Cast cast_;
  sim::Random random_;
  Time next_;
  Time until_;
  Time mean_pause_;
  std::function<void(Time until)> disturbed_;
  bool verbose_;
  Agenda agenda_;
  bool daemon_dies_ = false;
  std::uint64_t count_ = 0;
};

}  // namespace takt::soak
