#include "master/gateway/message/speed_messages.hpp"

#include <utility>

#include "master/lcm/messages.hpp"

namespace takt {
namespace {

constexpr std::int32_t not_there = -1;

std::int32_t word_or_none(const std::optional<std::uint16_t>& word) {
  return word ? std::int32_t{*word} : not_there;
}

speed_pattern_t to_message(const WordPattern& pattern) {
  speed_pattern_t message{};
  message.mask = pattern.mask;
  message.values.assign(pattern.values.begin(), pattern.values.end());
  message.num_values = static_cast<std::int32_t>(message.values.size());
  return message;
}

speed_axis_t to_message(const BusPlan& plan, const SpeedAxisPlan& axis) {
  speed_axis_t message{};
  message.node = plan.nodes[axis.node_index].name;
  message.node_id = plan.nodes[axis.node_index].id.value();
  message.sequence = static_cast<std::int8_t>(axis.sequence);
  message.fault_reset = static_cast<std::int8_t>(axis.fault_reset);
  message.control = axis.control;
  message.set_speed = axis.set_speed;
  message.status = axis.status;
  message.actual_speed = axis.actual_speed ? std::int32_t{*axis.actual_speed} : not_there;
  message.off = axis.commands.off;
  message.stop = axis.commands.stop;
  message.run = axis.commands.run;
  message.run_reverse = word_or_none(axis.commands.run_reverse);
  message.quick_stop = word_or_none(axis.commands.quick_stop);
  message.reset = word_or_none(axis.commands.reset);
  message.ready = to_message(axis.states.ready);
  message.running = to_message(axis.states.running);
  message.reverse = to_message(axis.states.reverse);
  message.at_speed = to_message(axis.states.at_speed);
  message.standstill = to_message(axis.states.standstill);
  message.fault = to_message(axis.states.fault);
  message.unit = axis.unit;
  message.set_scale = axis.set_scale;
  message.actual_scale = axis.actual_scale;
  message.max_speed = axis.max_speed;
  message.max_acceleration = axis.max_acceleration;
  return message;
}

speed_axes_t empty_message(const BusPlan& plan, std::int64_t session) {
  speed_axes_t message{};
  message.schema = message_schema;
  message.session = session;
  message.layout_hash = static_cast<std::int64_t>(plan.layout.hash);
  return message;
}

}  // namespace

std::vector<speed_axes_t> speed_messages(const BusPlan& plan, std::int64_t session) {
  std::vector<speed_axes_t> messages;
  for (const SpeedAxisPlan& one : plan.speed_axes) {
    speed_axis_t axis = to_message(plan, one);
    const bool fits = !messages.empty() && std::cmp_less_equal(messages.back().getEncodedSize() +
                                                                   axis._getEncodedSizeNoHash(),
                                                               message_bytes);
    if (!fits) messages.push_back(empty_message(plan, session));
    messages.back().axes.push_back(std::move(axis));
    ++messages.back().num_axes;
  }
  number_parts(messages);
  return messages;
}

}  // namespace takt
