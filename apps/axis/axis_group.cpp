#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <map>
#include <optional>
#include <poll.h>
#include <span>
#include <string_view>
#include <takt/axis.hpp>
#include <takt/motion_t.hpp>
#include <utility>

#include "apps/axis/find_axes.hpp"
#include "apps/axis/node_holders.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/lcm/envelope/envelope.hpp"
#include "master/lcm/messages.hpp"
#include "master/lcm/random_number.hpp"

namespace takt {
namespace {

constexpr std::size_t most_events = 256;
/// Most rounds in which one call empties the queue, so that a flood of messages cannot hold the
/// caller.
constexpr int most_rounds = 16;
/// How often wait() checks whether the newest image is stale.
constexpr std::chrono::milliseconds longest_pause{1};

/// taktd accepts names of 1 to 64 bytes.
std::string sender_name(const std::string& program, std::int64_t instance) {
  constexpr std::size_t longest = 64;
  std::array<char, 10> digits{};
  std::snprintf(digits.data(), digits.size(), " %08x", static_cast<std::uint32_t>(instance));
  return program.substr(0, longest + 1 - digits.size()) + digits.data();
}

timespec to_timespec(std::chrono::nanoseconds time) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  return {.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()};
}

}  // namespace

class AxisGroup::State {
 public:
  using Clock = std::chrono::steady_clock;

  State(std::unique_ptr<Transport> transport, AxisGroupOptions given);

  void serve();
  void take(std::string_view channel, std::span<const std::byte> data);
  void listen_to(std::string_view name);
  void take_image(std::span<const std::byte> data);
  void take_layout(std::span<const std::byte> data);
  void take_status(std::span<const std::byte> data);
  void take_speed_axes(std::span<const std::byte> data);
  void use_speed_axes();
  void take_motion(std::span<const std::byte> data);
  void report_schema(std::int16_t schema);
  bool publish(command_t& command);
  template <class Message>
  bool send(const std::string& channel, Message& message);
  /// The same for a message about motions, from the newest image.
  template <class Message>
  bool send_goals(const std::string& channel, Message& message);
  std::optional<axis_motion_t> motion_of(const AxisSignals& signals) const;
  std::chrono::nanoseconds age() const { return Clock::now() - arrival; }
  std::chrono::nanoseconds period() const { return std::chrono::nanoseconds{input.period_ns()}; }
  bool is_stale() const { return input.has_image() && age() > options.stale_cycles * period(); }

  std::unique_ptr<Transport> lcm;
  AxisGroupOptions options;
  std::int64_t instance;
  std::string sender;
  std::string bus;
  std::string heard;  // first bus whose layout arrived; only if no bus was configured
  std::string image_channel;
  std::string layout_channel;
  std::string speed_axes_channel;
  std::string command_channel;
  std::string secured_channel;
  std::string motion_channel;
  std::string motion_command_channel;
  std::string motion_gear_channel;
  std::string event_channel;
  std::string status_channel;
  ImageInput input;
  AxisControl axes;
  NodeHolders holders;
  std::map<std::int16_t, node_status_t> nodes;                            // by node-ID
  std::map<std::pair<std::int16_t, std::int8_t>, axis_motion_t> motions;  // by node-ID and axis
  std::vector<speed_axis_t> speed_axes;                                   // of the layout
  std::vector<std::optional<speed_axes_t>> speed_parts;  // of the newest messages about them
  bool fresh = false;
  bool new_layout = false;
  bool reported_stale = false;
  bool reported_schema = false;
  bool commands = false;  // something was sent since the last release
  Clock::time_point arrival{};
  std::optional<EnvelopeSeal> seal;  // empty if there is no key
  std::vector<event_t> events;
  std::vector<std::byte> buffer;
};

AxisGroup::State::State(std::unique_ptr<Transport> transport, AxisGroupOptions given)
    : lcm{std::move(transport)},
      options{std::move(given)},
      instance{options.instance != 0 ? options.instance : random_number()},
      sender{sender_name(options.sender, instance)},
      holders{sender} {
  if (options.bus.empty()) {
    lcm->subscribe(any_bus("LAYOUT"));
    lcm->subscribe(any_bus("SPEED_AXES"));
  } else {
    listen_to(options.bus);
    lcm->subscribe(layout_channel);
    lcm->subscribe(speed_axes_channel);
  }
}

void AxisGroup::State::listen_to(std::string_view name) {
  bus = name;
  image_channel = channel_name(bus, "IMAGE");
  layout_channel = channel_name(bus, "LAYOUT");
  speed_axes_channel = channel_name(bus, "SPEED_AXES");
  command_channel = channel_name(bus, "COMMAND");
  secured_channel = channel_name(bus, "SECURED");
  event_channel = channel_name(bus, "EVENT");
  status_channel = channel_name(bus, "STATUS");
  motion_channel = channel_name(bus, "MOTION");
  motion_command_channel = channel_name(bus, "MOTION_COMMAND");
  motion_gear_channel = channel_name(bus, "MOTION_GEAR");
  lcm->subscribe(motion_channel);
  lcm->subscribe(image_channel);
  lcm->subscribe(event_channel);
  lcm->subscribe(status_channel);
}

void AxisGroup::State::take(std::string_view channel, std::span<const std::byte> data) {
  if (bus.empty()) {
    if (const auto name = bus_of_channel(channel, "LAYOUT"); !name.empty()) heard = name;
  } else if (channel == image_channel) {
    take_image(data);
  } else if (channel == layout_channel) {
    take_layout(data);
  } else if (channel == status_channel) {
    take_status(data);
  } else if (channel == speed_axes_channel) {
    take_speed_axes(data);
  } else if (channel == motion_channel) {
    take_motion(data);
  } else if (channel == event_channel && events.size() < most_events) {
    if (auto event = decode<event_t>(data)) events.push_back(std::move(*event));
  }
}

void AxisGroup::State::take_image(std::span<const std::byte> data) {
  const auto part = decode<image_t>(data);
  if (part) {
    fresh |= input.take(*part);
  } else if (part.error() == DecodeFault::schema_1) {
    report_schema(1);
  }
}

void AxisGroup::State::take_layout(std::span<const std::byte> data) {
  const auto part = decode<layout_t>(data);
  if (!part) return;
  if (part->schema != message_schema) return report_schema(part->schema);
  if (!input.take(*part)) return;
  new_layout = true;
  holders.clear();
  nodes.clear();
  motions.clear();
  speed_axes.clear();
  if (!speed_parts.empty()) use_speed_axes();
}

void AxisGroup::State::take_status(std::span<const std::byte> data) {
  const auto part = decode<status_t>(data);
  const bool fits = part && part->schema == message_schema && input.has_layout();
  if (!fits || part->session != input.session()) return;
  holders.take(*part);
  for (const node_status_t& node : part->nodes) nodes.insert_or_assign(node.node_id, node);
}

/// The speed axes come before their layout, so all parts are kept until both are there.
void AxisGroup::State::take_speed_axes(std::span<const std::byte> data) {
  auto part = decode<speed_axes_t>(data);
  constexpr std::int16_t most_parts = 128;
  const bool fits = part && part->schema == message_schema && part->parts >= 1 &&
                    part->parts <= most_parts && part->part >= 0 && part->part < part->parts;
  if (!fits) return;
  speed_parts.resize(static_cast<std::size_t>(part->parts));
  speed_parts[static_cast<std::size_t>(part->part)] = std::move(*part);
  if (input.has_layout()) use_speed_axes();
}

/// Takes over the speed axes if all parts are of the layout that is known.
void AxisGroup::State::use_speed_axes() {
  std::vector<speed_axis_t> found;
  for (const auto& part : speed_parts) {
    if (!part || part->session != input.session()) return;
    found.insert(found.end(), part->axes.begin(), part->axes.end());
  }
  speed_axes = std::move(found);
}

void AxisGroup::State::take_motion(std::span<const std::byte> data) {
  const auto part = decode<motion_t>(data);
  const bool fits = part && part->schema == message_schema && input.has_layout();
  if (!fits || part->session != input.session()) return;
  for (const axis_motion_t& axis : part->axes) {
    motions.insert_or_assign({axis.node_id, axis.axis}, axis);
  }
}

std::optional<axis_motion_t> AxisGroup::State::motion_of(const AxisSignals& signals) const {
  const std::int32_t controlword = input.signals()[*signals.controlword].index;
  const auto found = motions.find({signals.node, number_of_axis(controlword)});
  if (found == motions.end()) return std::nullopt;
  return found->second;
}

void AxisGroup::State::report_schema(std::int16_t schema) {
  if (std::exchange(reported_schema, true) || events.size() == most_events) return;
  event_t event{};
  event.schema = message_schema;
  event.kind = "other_schema";
  event.severity = 2;
  event.text = daemon_schema_text(schema);
  events.push_back(std::move(event));
}

void AxisGroup::State::serve() {
  std::vector<pollfd> descriptors;
  int ready = 1;
  for (int i = 0; i < most_rounds && ready > 0; ++i) {  // empties the queue: only the newest counts
    input.set_time(std::chrono::nanoseconds{Clock::now().time_since_epoch()}.count());
    lcm->serve(
        [this](std::string_view channel, std::span<const std::byte> data) { take(channel, data); });
    descriptors.clear();
    lcm->watch(descriptors);
    ready = ::poll(descriptors.data(), descriptors.size(), 0);
  }
  if (bus.empty() && !heard.empty()) listen_to(heard);
}

bool AxisGroup::State::publish(command_t& command) {
  command.time_to_live = options.time_to_live;
  return send(command_channel, command);
}

template <class Message>
bool AxisGroup::State::send(const std::string& channel, Message& message) {
  using std::chrono::microseconds;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  message.utime = std::chrono::duration_cast<microseconds>(now).count();
  message.instance = instance;
  message.sender = sender;
  const Bytes bytes = encode(message, buffer);
  if (!seal) return lcm->publish(channel, bytes);
  return lcm->publish(secured_channel, seal->seal(channel, bytes, message.session, now));
}

template <class Message>
bool AxisGroup::State::send_goals(const std::string& channel, Message& message) {
  commands = true;
  message.schema = message_schema;
  message.session = input.session();
  message.cycle = input.cycle();
  message.num_goals = static_cast<std::int32_t>(message.goals.size());
  return send(channel, message);
}

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
    const auto pause = to_timespec(std::min<std::chrono::nanoseconds>(left, longest_pause));
    ::ppoll(descriptors.data(), descriptors.size(), &pause, nullptr);
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
  return state_->motion_of(state_->axes.signals(axis));
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
