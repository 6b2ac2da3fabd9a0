#include "apps/takt/simulate/motion/motion_observer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <takt/motion_t.hpp>

#include "master/lcm/channel_names.hpp"
#include "master/lcm/messages.hpp"

namespace takt {
namespace {

constexpr std::size_t observer_room = 1000;  // messages

void enlarge(double& largest, double value) { largest = std::max(largest, std::abs(value)); }

bool is_in_progress(const MotionOutcome& outcome) { return outcome.begin && !outcome.end; }

void take(const axis_motion_t& motion, MotionOutcome& outcome) {
  for (AxisMaxima& axis : outcome.axes) {
    if (axis.speed_word || axis.node_id != motion.node_id || axis.number != motion.axis) continue;
    enlarge(axis.following_error, motion.following_error);
    enlarge(axis.velocity, motion.velocity);
    enlarge(axis.acceleration, motion.acceleration);
  }
}

}  // namespace

MotionObserver::MotionObserver(VirtualLcm& lcm, const std::string& bus,
                               std::span<MotionOutcome> outcomes)
    : lcm_{lcm.join(observer_room)}, channel_{channel_name(bus, "MOTION")}, outcomes_{outcomes} {
  lcm_.subscribe(channel_);
}

void MotionObserver::act(Time) {
  lcm_.serve([this](std::string_view, std::span<const std::byte> data) {
    const auto part = decode<motion_t>(data);
    if (!part) return;
    for (MotionOutcome& outcome : outcomes_) {
      if (!is_in_progress(outcome)) continue;
      for (const axis_motion_t& motion : part->axes) take(motion, outcome);
    }
  });
}

void MotionObserver::see(const ImageView& image) {
  for (MotionOutcome& outcome : outcomes_) {
    if (!is_in_progress(outcome)) continue;
    for (AxisMaxima& axis : outcome.axes) {
      if (!axis.speed_word) continue;
      const SpeedWord& word = *axis.speed_word;
      enlarge(axis.velocity, static_cast<double>(image.values[word.signal]) * word.scale);
    }
  }
}

}  // namespace takt
