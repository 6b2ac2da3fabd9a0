#pragma once
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/bus/world.hpp"
#include "master/sim/random.hpp"

namespace takt::soak {

/// A foreign device on the bus that sends random frames: random identifiers, lengths and contents,
/// and frames that nearly make sense (PDOs of a wrong length, SDO responses that nobody requested,
/// foreign NMT commands).
class Intruder {
 public:
  Intruder(sim::World& world, const BusPlan& plan, sim::Random random)
      : world_{world}, port_{world.attach()}, plan_{plan}, random_{random} {}

  /// Sends some frames or none, at random. To be called often.
  void act() noexcept;
  void leave() noexcept { gone_ = true; }
  std::uint64_t sent() const noexcept { return sent_; }

 private:
  Frame frame() noexcept;
  CobId identifier() noexcept;

  sim::World& world_;
  sim::RemotePort& port_;
  const BusPlan& plan_;
  sim::Random random_;
  double activity_ = 0;  ///< probability of a frame in each act()
  std::uint64_t sent_ = 0;
  bool gone_ = false;
};

}  // namespace takt::soak
