#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "apps/takt/simulate/program/agenda.hpp"
#include "apps/takt/simulate/program/forger.hpp"
#include "apps/takt/simulate/program/program_faults.hpp"
#include "apps/takt/simulate/program/stage.hpp"
#include "apps/takt/simulate/program/virtual_application.hpp"
#include "apps/takt/simulate/program/virtual_daemon.hpp"
#include "apps/takt/simulate/program/virtual_lcm.hpp"
#include "master/sim/bus/faults.hpp"

namespace takt {

using VirtualApplications = std::vector<std::unique_ptr<VirtualApplication>>;

/// Applies the program faults of a fault file to the programs of a run.
class ProgramFaultActor final : public Actor {
 public:
  /// The parts of the run on which the faults act. Each application has a rival with the same name.
  struct Cast {
    VirtualLcm& lcm;
    VirtualDaemon& daemon;
    VirtualApplications& applications;
    VirtualApplications& rivals;
    Forger& forger;
  };

  /// Of the bus faults in `bus`, only `stall_master` is used: it stalls the front thread too.
  ProgramFaultActor(Cast cast, const ProgramFaults& faults, const sim::Faults& bus);

  Time next() const noexcept override { return agenda_.next(); }
  void act(Time now) override { agenda_.act(now); }
  /// Returns true if the caller has to kill the daemon, between two cycles.
  bool daemon_dies() const noexcept { return daemon_dies_; }
  void daemon_died(Time now);

 private:
  void begin(const ProgramFault& fault);
  void end(const ProgramFault& fault);
  void repeat(const ProgramFault& fault, Time now);
  void each(const ProgramFault& fault, VirtualApplications& programs,
            const std::function<void(VirtualApplication& one)>& act) const;

  Cast cast_;
  Agenda agenda_;
  bool daemon_dies_ = false;
  Time restart_ = never;  // time at which the daemon starts again
};

}  // namespace takt
