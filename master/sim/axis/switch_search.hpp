#pragma once
#include <cstdint>
#include <optional>

#include "master/sim/axis/motion.hpp"
#include "master/sim/mechanics/travel_sensors.hpp"

namespace takt::sim {

/// The motions with which a homing method finds its reference. The drive moves to a switch. If the
/// method uses the edge in the direction onto the switch, the drive first leaves the switch again.
/// Then it crosses the edge slowly. CiA 402-2, homing methods.
struct HomingMethod {
  TravelSwitch seeks = TravelSwitch::home;
  bool needs_switch = true;
  double first = 1;     ///< direction of the search: 1 or -1
  double last = 1;      ///< direction in which the edge is crossed, and then the index pulse
  bool enters = false;  ///< crosses the edge onto the switch, otherwise off the switch
  bool with_index = false;
};

/// Returns how methods 1-14, 17-30, 33 and 34 work; std::nullopt for any other.
std::optional<HomingMethod> homing_method(std::int64_t number) noexcept;

/// Velocities of a search, in counts/s.
struct SearchSpeeds {
  double fast = 0;  ///< speed to the switch
  double slow = 0;  ///< speed to the edge and the index pulse
};

/// The search for the reference with the switches that the axis has.
class SwitchSearch {
 public:
  enum class Result : std::uint8_t { running, found, failed };

  void begin(const HomingMethod& method, const TravelSensors& sensors) noexcept;
  /// Moves the demand for `h` seconds. The search fails if the axis meets a limit switch that it
  /// does not seek, except once in the search for the home switch, where it turns back.
  Result step(const TravelSensors& sensors, Demand& demand, const SearchSpeeds& speeds,
              const Ramps& ramps, double h) noexcept;
  /// Returns the position of the reference in the coordinates of TravelSensors. The result is valid
  /// once the reference has been found.
  double reference() const noexcept { return reference_; }

 private:
  enum class Step : std::uint8_t { seek, settle, go_back, leave, cross, index };

  Result seek(const TravelSensors& sensors) noexcept;
  void settle(const TravelSensors& sensors) noexcept;
  Result cross(const TravelSensors& sensors) noexcept;
  void approach_edge() noexcept;
  bool blocked(const TravelSensors& sensors) const noexcept;

  HomingMethod method_{};
  Step step_ = Step::seek;
  double direction_ = 1;
  bool turned_ = false;
  double reference_ = 0;
};

}  // namespace takt::sim
