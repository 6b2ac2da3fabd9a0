#include "master/gateway/motion/motion_messages.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "master/lcm/messages.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t axes_a_message = 13;  // 92 bytes each

/// Makes the message about one axis. `turn` is the turn of the positions in their unit: the
/// positions of a rotary axis are reported inside its turn.
axis_motion_t to_message(const MotionAxis& axis, const Turn& turn, const motion::AxisReport& report,
                         const ShownMotion& shown, double period) {
  axis_motion_t message{};
  message.axis = static_cast<std::int8_t>(axis.number + 1);
  message.state = static_cast<std::int8_t>(report.state);
  message.id = shown.id;
  message.ended_id = shown.ended_id;
  message.outcome = static_cast<std::int8_t>(shown.ended);
  message.homing = static_cast<std::int8_t>(report.homing);
  message.needs_homing = axis.needs_homing ? 1 : 0;
  message.homing_timeout_ms = static_cast<std::int32_t>(axis.homing_timeout / 1ms);
  message.position = turn.inside(report.commanded.position);
  message.velocity = report.commanded.velocity;
  message.acceleration = report.commanded.acceleration;
  message.actual_position = turn.inside(report.actual.position);
  message.actual_velocity = report.actual.velocity;
  message.following_error = report.following_error;
  message.time_left = static_cast<double>(report.cycles_left) * period;
  message.gear = static_cast<std::int8_t>(report.gear);
  message.phase_error = report.phase_error;
  return message;
}

}  // namespace

std::vector<motion_t> motion_messages(const BusPlan& plan, const std::vector<MotionAxis>& axes,
                                      const MotionSnapshot& snapshot,
                                      const std::vector<ShownMotion>& shown) {
  const double period = std::chrono::duration<double>{plan.cycle.period}.count();
  std::vector<motion_t> messages;
  for (std::size_t first = 0; first < axes.size(); first += axes_a_message) {
    motion_t message{};
    message.schema = message_schema;
    message.cycle = static_cast<std::int64_t>(snapshot.cycle);
    const std::size_t end = std::min(first + axes_a_message, axes.size());
    for (std::size_t i = first; i < end; ++i) {
      const Signal& target = plan.layout.signals[axes[i].target];
      const Turn turn = axes[i].turn.in_unit(target.scale, target.offset);
      message.axes.push_back(to_message(axes[i], turn, snapshot.axes[i], shown[i], period));
      message.axes.back().node_id = plan.nodes[axes[i].node_index].id.value();
    }
    message.num_axes = static_cast<std::int32_t>(message.axes.size());
    messages.push_back(std::move(message));
  }
  number_parts(messages);
  return messages;
}

}  // namespace takt
