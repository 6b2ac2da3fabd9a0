#pragma once
#include <cstdint>

#include "master/sim/axis_objects.hpp"
#include "master/sim/motion.hpp"
#include "master/sim/random.hpp"

namespace takt::sim {

/// Homing mode. The switch that a method looks for stands somewhere ahead, a third to a whole
/// second away at search speed. CiA 402-2; methods 1-14, 17-30, 33-35, 37.
class Homing {
 public:
  Homing(const AxisObjects& objects, Random random) : objects_{objects}, random_{random} {}

  /// The mode is entered: nothing has been started.
  void start() noexcept { stage_ = Stage::idle; }
  void on_controlword(std::uint16_t before, std::uint16_t now, const Demand& demand) noexcept;
  /// True: the reference has been found; shift() moves the coordinates.
  bool step(Demand& demand, double deceleration, double h) noexcept;
  /// What is to be added to positions so that the reference reads minus 0x607C.
  double shift() const noexcept;
  /// Bits 10, 12 and 13.
  std::uint16_t status_bits(bool stands) const noexcept;
  bool on_switch() const noexcept { return stage_ == Stage::leave; }

 private:
  enum class Stage : std::uint8_t { idle, seek, leave, stop, done, failed };

  bool seek(Demand& demand, const Ramps& ramps, double h) noexcept;

  const AxisObjects& objects_;
  Random random_;
  Stage stage_ = Stage::idle;
  double direction_ = 1;
  double switch_at_ = 0;
  double reference_ = 0;
};

}  // namespace takt::sim
