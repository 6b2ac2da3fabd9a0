#pragma once
#include "eds_parser/network_file/load_network.hpp"
#include "master/attach.hpp"
#include "master/lcm/clocks.hpp"
#include "master/master_run.hpp"
#include "master/sim/bus/sim_port.hpp"
#include "master/sim/bus/world.hpp"

namespace takt::fuzz {

inline const LoadedNetwork& demo_network() {
  static const auto loaded = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  return loaded;
}

/// The whole master of the demo and its simulated devices in virtual time, booted.
class VirtualMaster {
 public:
  VirtualMaster()
      : world_{demo_network().devices, {.bitrate = demo_network().plan.bitrate}},
        port_{world_, {.sync = demo_network().plan.cycle.sync_cob_id}},
        master{demo_network().plan} {
    master.attach(port_);
    master.begin();
    for (int i = 0; i < 400; ++i) master.cycle();
  }
  Time now() const noexcept { return world_.now(); }

 private:
  sim::World world_;
  sim::SimPort port_;

 public:
  MasterRun master;
};

/// The clocks of a VirtualMaster.
class VirtualClocks final : public Clocks {
 public:
  explicit VirtualClocks(const VirtualMaster& of) : of_{of} {}
  Time now() const noexcept override { return of_.now(); }
  Time wall_offset() const noexcept override { return std::chrono::days{20454}; }

 private:
  const VirtualMaster& of_;
};

}  // namespace takt::fuzz
