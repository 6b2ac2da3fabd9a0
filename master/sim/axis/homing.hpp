#pragma once
#include <cstdint>

#include "master/sim/axis/axis_objects.hpp"
#include "master/sim/axis/axis_servo.hpp"
#include "master/sim/axis/motion.hpp"
#include "master/sim/axis/switch_search.hpp"
#include "master/sim/random.hpp"

namespace takt::sim {

/// Homing mode. A method seeks the switch and the index pulse that the mechanics of the axis have.
/// If there are no mechanics, or if they lack the switch, the switch is ahead at a random distance
/// that takes a third of a second to one second at search speed. CiA 402-2; methods 1-14, 17-30,
/// 33-35 and 37. A drive with a list of methods (0x60E3) has only those of the list.
class Homing {
 public:
  Homing(const AxisObjects& objects, Random random) : objects_{objects}, random_{random} {}

  /// From now on, methods use the sensors of these mechanics, which must outlive the object.
  void use(const AxisServo& servo) noexcept { servo_ = &servo; }
  /// Enters the mode; homing has not been started yet.
  void start() noexcept { stage_ = Stage::idle; }
  void on_controlword(std::uint16_t before, std::uint16_t now, const Demand& demand) noexcept;
  /// Returns true when the reference has been found and the axis is at standstill. Then shift()
  /// gives the shift of the coordinates.
  bool step(Demand& demand, double deceleration, double h) noexcept;
  /// Returns the value to add to all positions. The position of the reference is then minus the
  /// home offset 0x607C.
  double shift() const noexcept;
  /// Returns bits 10, 12 and 13 of the statusword.
  std::uint16_t status_bits(bool stands) const noexcept;
  bool on_switch() const noexcept { return stage_ == Stage::leave; }

 private:
  enum class Stage : std::uint8_t { idle, seek, leave, search, stop, done, failed };

  bool begins_search(std::int64_t method) noexcept;
  void search(Demand& demand, const Ramps& ramps, double h) noexcept;
  bool seek(Demand& demand, const Ramps& ramps, double h) noexcept;

  const AxisObjects& objects_;
  Random random_;
  const AxisServo* servo_ = nullptr;
  SwitchSearch search_;
  Stage stage_ = Stage::idle;
  double direction_ = 1;
  double switch_at_ = 0;
  double reference_ = 0;
};

}  // namespace takt::sim
