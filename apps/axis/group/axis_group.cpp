#include <algorithm>
#include <poll.h>
#include <utility>

#include "apps/axis/group/axis_group_state.hpp"
#include "master/lcm/random_number.hpp"

namespace takt {
namespace {

/// Longest time between two checks whether the newest image is stale.
constexpr std::chrono::milliseconds longest_pause{1};

}  // namespace

Input AxisGroup::wait(std::chrono::nanoseconds longest) {
  State& state = *state_;
  const auto until = State::Clock::now() + longest;
  std::vector<pollfd> descriptors;
  while (true) {
    state.serve();
    if (std::exchange(state.new_layout, false)) {
      state.axes.set_layout(state.input);
      state.fresh = state.reported_stale = false;
      return Input::restarted;
    }
    if (std::exchange(state.fresh, false)) {
      state.arrival = State::Clock::now();
      state.reported_stale = false;
      state.axes.on_image(state.input);
      return Input::fresh;
    }
    if (!state.reported_stale && state.is_stale()) {
      state.reported_stale = true;
      return Input::stale;
    }
    const auto left = until - State::Clock::now();
    if (left <= left.zero()) return Input::nothing;
    descriptors.clear();
    state.lcm->watch(descriptors);
    surroundings().wait(descriptors, std::min<std::chrono::nanoseconds>(left, longest_pause));
  }
}

bool AxisGroup::send() {
  state_->commands = true;
  command_t& command = state_->axes.command();
  command.release = 0;
  return state_->publish(command);
}

bool AxisGroup::send_controls(std::span<const AxisControl::Index> axes) {
  state_->commands = true;
  command_t& command = state_->axes.controls(axes);
  command.release = 0;
  return state_->publish(command);
}

bool AxisGroup::send_values(command_t& command) {
  state_->commands = true;
  command.schema = message_schema;
  command.session = state_->input.session();
  command.cycle = state_->input.cycle();
  command.release = 0;
  command.num_values = static_cast<std::int32_t>(command.values.size());
  return state_->publish(command);
}

bool AxisGroup::send_motion(motion_command_t& command) {
  return state_->send_goals(state_->motion_command_channel, command);
}

bool AxisGroup::send_gear(motion_gear_t& gear) {
  return state_->send_goals(state_->motion_gear_channel, gear);
}

bool AxisGroup::send_stream(motion_stream_t& stream) {
  return state_->send_goals(state_->motion_stream_channel, stream);
}

bool AxisGroup::send_request(request_t& request) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  if (request.utime == 0) {
    request.utime = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  }
  request.schema = message_schema;
  request.session = state_->input.session();
  request.sender = state_->sender;
  request.size = static_cast<std::int32_t>(request.data.size());
  return state_->seal_and_publish(state_->request_channel, request, now);
}

std::vector<reply_t> AxisGroup::take_replies() { return std::exchange(state_->replies, {}); }

bool AxisGroup::release() {
  if (!std::exchange(state_->commands, false)) return true;
  command_t command{};
  command.schema = message_schema;
  command.session = state_->input.session();
  command.cycle = state_->input.cycle();
  command.release = 1;
  return state_->publish(command);
}

AxisGroup::AxisGroup(std::unique_ptr<Transport> lcm, AxisGroupOptions options)
    : state_{std::make_unique<State>(std::move(lcm), std::move(options))} {}

AxisGroup::~AxisGroup() { release(); }

void AxisGroup::sign_with(EnvelopeKey key) {
  state_->seal.emplace(std::move(key), random_number());
}

std::vector<event_t> AxisGroup::take_events() { return std::exchange(state_->events, {}); }

void AxisGroup::set_time_to_live(std::int32_t cycles) noexcept {
  state_->options.time_to_live = cycles;
}

bool AxisGroup::load_targets(const Eigen::Ref<const Eigen::VectorXd>& positions) {
  axes().set_positions(positions);
  return send();
}

AxisControl& AxisGroup::axes() noexcept { return state_->axes; }
const AxisControl& AxisGroup::axes() const noexcept { return state_->axes; }
const ImageInput& AxisGroup::input() const noexcept { return state_->input; }
const std::string& AxisGroup::sender() const noexcept { return state_->sender; }
const std::string& AxisGroup::bus() const noexcept { return state_->bus; }
std::chrono::nanoseconds AxisGroup::period() const noexcept { return state_->period(); }
std::chrono::nanoseconds AxisGroup::age() const { return state_->age(); }

const NodeHolder& AxisGroup::holder(AxisControl::Index axis) const {
  return state_->holders[state_->axes.signals(axis).node];
}

const NodeHolder& AxisGroup::holder_of_node(std::int16_t node) const {
  return state_->holders[node];
}

const std::vector<speed_axis_t>& AxisGroup::speed_axes() const noexcept {
  return state_->speed_axes;
}

std::optional<axis_motion_t> AxisGroup::motion(AxisControl::Index axis) const {
  const State::Motion* motion = state_->motion_of(state_->axes.signals(axis));
  if (motion == nullptr) return std::nullopt;
  return motion->axis;
}

std::int64_t AxisGroup::motion_cycle(AxisControl::Index axis) const {
  const State::Motion* motion = state_->motion_of(state_->axes.signals(axis));
  return motion == nullptr ? -1 : motion->cycle;
}

std::optional<node_status_t> AxisGroup::node_status(AxisControl::Index axis) const {
  return status_of_node(state_->axes.signals(axis).node);
}

std::optional<node_status_t> AxisGroup::status_of_node(std::int16_t node) const {
  const auto found = state_->nodes.find(node);
  if (found == state_->nodes.end()) return std::nullopt;
  return found->second;
}

}  // namespace takt
