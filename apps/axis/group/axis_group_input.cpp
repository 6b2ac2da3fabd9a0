#include <array>
#include <cstdio>
#include <poll.h>
#include <utility>

#include "apps/axis/group/axis_group_state.hpp"
#include "apps/axis/group/find_axes.hpp"
#include "master/lcm/channel_names.hpp"

namespace takt {
namespace {

constexpr std::size_t most_events = 256;
/// Largest number of rounds in which one call empties the queue, so that a flood of messages cannot
/// hold the caller.
constexpr int most_rounds = 16;

/// taktd accepts names of 1 to 64 bytes.
std::string sender_name(const std::string& program, std::int64_t instance) {
  constexpr std::size_t longest = 64;
  std::array<char, 10> digits{};
  std::snprintf(digits.data(), digits.size(), " %08x", static_cast<std::uint32_t>(instance));
  return program.substr(0, longest + 1 - digits.size()) + digits.data();
}

}  // namespace

AxisGroup::State::State(std::unique_ptr<Transport> transport, AxisGroupOptions given)
    : lcm{std::move(transport)},
      options{std::move(given)},
      instance{options.instance != 0 ? options.instance : surroundings().random_number()},
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
  request_channel = channel_name(bus, "REQUEST");
  reply_channel = channel_name(bus, "REPLY");
  event_channel = channel_name(bus, "EVENT");
  status_channel = channel_name(bus, "STATUS");
  motion_channel = channel_name(bus, "MOTION");
  motion_command_channel = channel_name(bus, "MOTION_COMMAND");
  motion_gear_channel = channel_name(bus, "MOTION_GEAR");
  motion_stream_channel = channel_name(bus, "MOTION_STREAM");
  lcm->subscribe(motion_channel);
  lcm->subscribe(reply_channel);
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
  } else if (channel == reply_channel) {
    take_reply(data);
  } else if (channel == event_channel && events.size() < most_events) {
    if (auto event = decode<event_t>(data)) events.push_back(std::move(*event));
  }
}

/// Other programs also send requests, so a reply may be for another program.
void AxisGroup::State::take_reply(std::span<const std::byte> data) {
  auto reply = decode<reply_t>(data);
  const bool own = reply && reply->schema == message_schema && reply->sender == sender;
  if (own && replies.size() < most_events) replies.push_back(std::move(*reply));
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

/// The messages about speed axes come before the layout to which they belong. All parts are
/// therefore kept until this layout is there.
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
    motions.insert_or_assign({axis.node_id, axis.axis}, Motion{axis, part->cycle});
  }
}

/// Returns nullptr if taktd has reported nothing about the axis.
const AxisGroup::State::Motion* AxisGroup::State::motion_of(const AxisSignals& signals) const {
  const std::int32_t controlword = input.signals()[*signals.controlword].index;
  const auto found = motions.find({signals.node, number_of_axis(controlword)});
  return found == motions.end() ? nullptr : &found->second;
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
  for (int i = 0; i < most_rounds && ready > 0; ++i) {  // empties the queue
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

}  // namespace takt
