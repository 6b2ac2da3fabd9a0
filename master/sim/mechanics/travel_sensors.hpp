#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "eds_parser/table/mechanics.hpp"
#include "master/sim/mechanics/zone_switch.hpp"

namespace takt::sim {

/// The switches on the way of an axis.
enum class TravelSwitch : std::uint8_t { negative_limit, positive_limit, home, probe_1, probe_2 };
inline constexpr std::size_t travel_switches = 5;

/// The switches that an axis meets on its way, and the index pulses of its encoder. The load
/// operates the switches. The position of an edge is that of the motor at this moment, because a
/// drive latches the position of its motor. All positions are in counts, without the shift of
/// homing.
class TravelSensors {
 public:
  /// `turn` is a turn of the motor. `index` is the place of an index pulse if the table has none.
  TravelSensors(const TravelParameters& table, double turn, double index) noexcept;

  /// Updates the switches and the index pulse for the way since the last call.
  void look(double motor, double load) noexcept;

  bool has(TravelSwitch which) const noexcept { return at(which).zone.has_value(); }
  bool active(TravelSwitch which) const noexcept { return at(which).active; }
  /// Returns the edge of a switch in the last look(). If there was one, edge_at() is the position
  /// of the motor there.
  EdgeKind edge(TravelSwitch which) const noexcept { return at(which).edge; }
  double edge_at(TravelSwitch which) const noexcept { return at(which).edge_at; }
  /// Returns the position of the index pulse that the motor has crossed in the last look().
  const std::optional<double>& index() const noexcept { return crossed_; }
  /// Returns the digital inputs 0x60FD: limits in bits 0 and 1, home in bit 2, probes in bits 16
  /// and 17.
  std::uint32_t inputs() const noexcept;

 private:
  struct One {
    std::optional<ZoneSwitch> zone{};
    bool active = false;
    EdgeKind edge = EdgeKind::none;
    double edge_at = 0;
  };

  const One& at(TravelSwitch which) const noexcept {
    return switches_[static_cast<std::size_t>(which)];
  }
  void add(TravelSwitch which, const std::optional<ZoneParameters>& zone);
  void look_at_switches(double motor, double load) noexcept;
  void find_next_edges() noexcept;

  std::array<One, travel_switches> switches_;
  IndexPulse index_;
  std::optional<double> crossed_{};
  double motor_ = 0;
  double load_ = 0;
  bool has_edges_ = false;  ///< the load has crossed an edge in the last look()
  double edge_below_ = 0;   ///< the nearest edge of a switch that is not above the load
  double edge_above_ = 0;   ///< the nearest edge above the load
};

}  // namespace takt::sim
