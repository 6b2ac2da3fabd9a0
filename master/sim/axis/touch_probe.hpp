#pragma once
#include <cstdint>

#include "master/sim/axis/axis_objects.hpp"
#include "master/sim/mechanics/travel_sensors.hpp"

namespace takt::sim {

/// The touch probe: two inputs that latch the position at their edges, or at the index pulse.
/// CiA 402-2, 0x60B8 to 0x60BD.
class TouchProbe {
 public:
  explicit TouchProbe(AxisObjects& objects) noexcept : objects_{objects} {}

  void reset() noexcept;
  /// Takes the edges and index pulses that the sensors have found in their last look(). `origin` is
  /// the position of their zero.
  void look(const TravelSensors& sensors, double origin) noexcept;

 private:
  struct Input;

  std::uint16_t look_at(const Input& input, const TravelSensors& sensors, double origin) noexcept;

  AxisObjects& objects_;
  std::uint16_t function_ = 0;  ///< 0x60B8 at the last look
  std::uint16_t status_ = 0;
};

}  // namespace takt::sim
