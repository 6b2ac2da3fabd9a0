#include "master/sim/axis/touch_probe.hpp"

#include <cmath>

namespace takt::sim {
namespace {

// Bits of 0x60B8 and 0x60B9 for input 1; those of input 2 are 8 bits above.
constexpr std::uint16_t enabled = 1U << 0;
constexpr std::uint16_t continuous = 1U << 1;
constexpr std::uint16_t by_index = 1U << 2;
constexpr std::uint16_t rising = 1U << 4;
constexpr std::uint16_t falling = 1U << 5;
constexpr std::uint16_t rising_stored = 1U << 1;
constexpr std::uint16_t falling_stored = 1U << 2;

}  // namespace

struct TouchProbe::Input {
  TravelSwitch which;
  unsigned shift;  ///< shift of the bits of this input
  Slot& rising_edge;
  Slot& falling_edge;
};

void TouchProbe::reset() noexcept {
  function_ = status_ = 0;
  objects_.probe_status.set(0);
}

void TouchProbe::look(const TravelSensors& sensors, double origin) noexcept {
  const auto function = static_cast<std::uint16_t>(objects_.probe_function.get());
  if (function == 0 && function_ == 0) return;
  const Input first{TravelSwitch::probe_1, 0, objects_.probe_1_rising, objects_.probe_1_falling};
  const Input second{TravelSwitch::probe_2, 8, objects_.probe_2_rising, objects_.probe_2_falling};
  const std::uint16_t before = function_;
  function_ = function;
  // If the function of an input has changed, nothing is stored for this input any longer.
  for (const unsigned shift : {first.shift, second.shift}) {
    const unsigned changed = (before ^ function) >> shift & 0xFF;
    if (changed != 0) status_ = static_cast<std::uint16_t>(status_ & ~(0xFFU << shift));
  }
  status_ |= look_at(first, sensors, origin);
  status_ |= look_at(second, sensors, origin);
  objects_.probe_status.set(status_);
}

/// Returns the bits of the status that one input adds.
std::uint16_t TouchProbe::look_at(const Input& input, const TravelSensors& sensors,
                                  double origin) noexcept {
  const unsigned function = function_ >> input.shift & 0xFF;
  if ((function & enabled) == 0) return 0;
  const unsigned stored = status_ >> input.shift & 0xFF;
  unsigned added = enabled;
  const bool again = (function & continuous) != 0;
  const auto latch = [&](unsigned edge, unsigned flag, Slot& slot, double position) {
    if ((function & edge) == 0 || (!again && (stored & flag) != 0)) return;
    slot.set(std::llround(position + origin));
    added |= flag;
  };
  if ((function & by_index) != 0) {
    if (sensors.index()) latch(rising, rising_stored, input.rising_edge, *sensors.index());
  } else if (sensors.edge(input.which) == EdgeKind::rising) {
    latch(rising, rising_stored, input.rising_edge, sensors.edge_at(input.which));
  } else if (sensors.edge(input.which) == EdgeKind::falling) {
    latch(falling, falling_stored, input.falling_edge, sensors.edge_at(input.which));
  }
  return static_cast<std::uint16_t>(added << input.shift);
}

}  // namespace takt::sim
