#include "master/sim/mechanics/travel_sensors.hpp"

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
}

void TravelSensors::add(TravelSwitch which, const std::optional<ZoneParameters>& zone) {
  One& one = switches_[static_cast<std::size_t>(which)];
  if (!zone) return;
  one.zone = ZoneSwitch{*zone};
  one.active = one.zone->active(load_);
}

void TravelSensors::look(double motor, double load) noexcept {
  const Stretch way{load_, load};
  for (One& one : switches_) {
    if (!one.zone) continue;
    const SwitchEdge edge = one.zone->edge(way);
    one.active = one.zone->active(load);
    one.edge = edge.kind;
    one.edge_at = motor_ + edge.part * (motor - motor_);
  }
  crossed_ = index_.crossed({motor_, motor});
  motor_ = motor;
  load_ = load;
}

std::uint32_t TravelSensors::inputs() const noexcept {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < switches_.size(); ++i) {
    if (switches_[i].active) bits |= input_bits[i];
  }
  return bits;
}

}  // namespace takt::sim
