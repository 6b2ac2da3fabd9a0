#pragma once
#include <cstdint>

#include "master/sim/axis/axis_objects.hpp"
#include "master/sim/axis/motion.hpp"

namespace takt::sim {

/// Profile position mode: set-point handshake with a buffer for one set-point, and a trapezoidal
/// profile. CiA 402-2.
class ProfilePosition {
 public:
  explicit ProfilePosition(const AxisObjects& objects) : objects_{objects} {}

  void start(const Demand& demand) noexcept;
  void on_controlword(std::uint16_t before, std::uint16_t now, const Demand& demand,
                      double actual) noexcept;
  void step(Demand& demand, const Ramps& ramps, double h) noexcept;
  bool acknowledges() const noexcept { return acknowledged_ || buffered_; }
  bool arrived() const noexcept { return arrived_ && !buffered_; }
  bool limited() const noexcept { return limited_; }
  double target() const noexcept { return target_; }

 private:
  double new_target(std::uint16_t controlword, const Demand& demand, double actual) noexcept;

  const AxisObjects& objects_;
  double target_ = 0;
  double next_ = 0;
  bool buffered_ = false;
  bool arrived_ = true;
  bool acknowledged_ = false;
  bool limited_ = false;
};

/// Clamps `target` to the software position limits 0x607D. There are no limits if both are 0 or if
/// the lower one is above the upper one.
double within_limits(const AxisObjects& objects, double target, bool& limited) noexcept;

}  // namespace takt::sim
