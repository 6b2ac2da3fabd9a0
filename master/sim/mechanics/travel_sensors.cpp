#include "master/sim/mechanics/travel_sensors.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>

namespace takt::sim {
namespace {

constexpr std::array<std::uint32_t, travel_switches> input_bits{1U << 0, 1U << 1, 1U << 2, 1U << 16,
                                                                1U << 17};

}  // namespace

TravelSensors::TravelSensors(const TravelParameters& table, double turn, double index) noexcept
    : index_{turn, table.index.value_or(index)} {
  if (table.switches) {
    add(TravelSwitch::negative_limit, ZoneParameters{.high = table.switches->low});
    add(TravelSwitch::positive_limit, ZoneParameters{.low = table.switches->high});
  }
  add(TravelSwitch::home, table.home);
  add(TravelSwitch::probe_1, table.probe_1);
  add(TravelSwitch::probe_2, table.probe_2);
  find_next_edges();
}

void TravelSensors::add(TravelSwitch which, const std::optional<ZoneParameters>& zone) {
  One& one = switches_[static_cast<std::size_t>(which)];
  if (!zone) return;
  one.zone = ZoneSwitch{*zone};
  one.active = one.zone->active(load_);
}

void TravelSensors::look(double motor, double load) noexcept {
  const bool crosses = load < edge_below_ || load >= edge_above_;
  if (crosses || has_edges_) look_at_switches(motor, load);
  has_edges_ = crosses;
  motor_ = motor;
  load_ = load;
  if (crosses) find_next_edges();
  crossed_ = index_.move_to(motor);
}

void TravelSensors::look_at_switches(double motor, double load) noexcept {
  const Stretch way{load_, load};
  for (One& one : switches_) {
    if (!one.zone) continue;
    const SwitchEdge edge = one.zone->edge(way);
    one.active = one.zone->active(load);
    one.edge = edge.kind;
    one.edge_at = motor_ + edge.part * (motor - motor_);
  }
}

void TravelSensors::find_next_edges() noexcept {
  edge_below_ = -std::numeric_limits<double>::infinity();
  edge_above_ = std::numeric_limits<double>::infinity();
  for (const One& one : switches_) {
    if (!one.zone) continue;
    for (const double edge : {one.zone->low(), one.zone->high()}) {
      if (load_ < edge) edge_above_ = std::min(edge_above_, edge);
      if (load_ >= edge) edge_below_ = std::max(edge_below_, edge);
    }
  }
}

std::uint32_t TravelSensors::inputs() const noexcept {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < switches_.size(); ++i) {
    if (switches_[i].active) bits |= input_bits[i];
  }
  return bits;
}

}  // namespace takt::sim
