#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/table/motion_axes.hpp"
#include "master/attach.hpp"
#include "master/master_run.hpp"
#include "master/sim/bus/sim_port.hpp"

namespace takt::test {

/// The axes of a network file in virtual time, and the master of their bus, which runs cycle by
/// cycle.
class AxesInVirtualTime {
 public:
  static constexpr const char* demo = TAKT_SOURCE_DIR "/share/demo/two_axes.yaml";
  /// This network maps 60B1, and limits velocity (4 rad/s) and acceleration (100 rad/s^2).
  static constexpr const char* velocity_offset =
      TAKT_SOURCE_DIR "/test/motions/data/velocity_offset.yaml";

  AxesInVirtualTime(sim::Faults faults, const char* file)
      : network{load_network(file)},
        axes{motion_axes(network.plan)},
        world{network.devices,
              {.seed = 3, .bitrate = network.plan.bitrate, .faults = std::move(faults)}},
        port{world, {.sync = network.plan.cycle.sync_cob_id}},
        master{network.plan} {}
  AxesInVirtualTime(const AxesInVirtualTime&) = delete;
  AxesInVirtualTime& operator=(const AxesInVirtualTime&) = delete;
  virtual ~AxesInVirtualTime() = default;

  void cycle() {
    run_cycle();
    if (each_cycle) each_cycle();
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) cycle();
  }
  template <class Condition>
  bool run_until(Condition condition, int most = 5000) {
    for (int i = 0; i < most; ++i) {
      cycle();
      if (condition()) return true;
    }
    return false;
  }

  LoadedNetwork network;
  std::vector<MotionAxis> axes;
  sim::World world;
  sim::SimPort port;
  MasterRun master;
  std::function<void()> each_cycle;  ///< runs after each cycle

 protected:
  void begin() {
    master.attach(port);
    master.begin();
  }

 private:
  virtual void run_cycle() = 0;
};

}  // namespace takt::test
