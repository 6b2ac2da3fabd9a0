#pragma once
#include <cmath>

#include "test/unit/master/motion/beat/plant.hpp"

namespace takt::motion::test {

inline MotionOrder gear_order(const Plant& plant, std::uint8_t axis, const GearTask& task) {
  return {.id = plant.ids,
          .axis = axis,
          .group = axis,
          .ending = Ending::gear,
          .begin = plant.cycle + 1,
          .from = {},
          .profile = {},
          .gear = task,
          .stop = Plant::limits,
          .timeout = 1'000'000};
}

/// Axis 1 follows axis 0.
inline GearTask behind_axis(double ratio) {
  return {.kind = LeaderKind::commanded, .leader_axis = 0, .ratio = ratio};
}

inline MotionOrder jog(const Plant& plant, double velocity) {
  MotionOrder order = plant.order(0, plant.last[0].commanded, 1);
  order.profile = Plant::plan(order.from, {.velocity = velocity}, Goal::velocity);
  order.ending = Ending::cruise;
  order.timeout = 1'000'000;
  return order;
}

/// An encoder with this counter, as the leader of axis 0.
class Encoder {
 public:
  Encoder(Plant& plant, unsigned bits) : plant_{plant}, bits_{bits} {}

  GearTask task(double scale) const {
    return {.kind = LeaderKind::measured,
            .signal = 7,
            .bits = static_cast<std::uint8_t>(bits_),
            .scale = scale,
            .filter_time = 0.02,
            .ratio = 1.0};
  }
  void show(double counts) {
    const auto raw = static_cast<std::int64_t>(std::floor(counts));
    const std::int64_t mask = (std::int64_t{1} << bits_) - 1;
    plant_.inputs[0].leaders[0] = {
        .signal = 7, .age = LeaderSample::Age::fresh, .counts = raw & mask};
  }
  void miss() { plant_.inputs[0].leaders[0].age = LeaderSample::Age::missing; }

 private:
  Plant& plant_;
  unsigned bits_;
};

}  // namespace takt::motion::test
