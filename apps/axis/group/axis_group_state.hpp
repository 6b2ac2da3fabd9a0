#pragma once
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <takt/axis.hpp>
#include <takt/motion_t.hpp>
#include <takt/reply_t.hpp>
#include <takt/speed_axes_t.hpp>
#include <utility>
#include <vector>

#include "apps/axis/group/node_holders.hpp"
#include "apps/axis/group/surroundings.hpp"
#include "master/lcm/envelope/envelope.hpp"
#include "master/lcm/messages.hpp"

namespace takt {

/// What an AxisGroup knows about its bus. The functions that take messages are in
/// axis_group_input.cpp.
class AxisGroup::State {
 public:
  using Clock = ProgramClock;
  /// The newest report of taktd about an axis, and the cycle of the report.
  struct Motion {
    axis_motion_t axis;
    std::int64_t cycle;
  };

  State(std::unique_ptr<Transport> transport, AxisGroupOptions given);

  void serve();
  void take(std::string_view channel, std::span<const std::byte> data);
  void listen_to(std::string_view name);
  void take_image(std::span<const std::byte> data);
  void take_layout(std::span<const std::byte> data);
  void take_reply(std::span<const std::byte> data);
  void take_status(std::span<const std::byte> data);
  void take_speed_axes(std::span<const std::byte> data);
  void use_speed_axes();
  void take_motion(std::span<const std::byte> data);
  void report_schema(std::int16_t schema);
  bool publish(command_t& command);
  /// Sends a message about outputs, in the name of this group.
  template <class Message>
  bool send(const std::string& channel, Message& message);
  /// Sends a message of any kind, in an envelope if there is a key.
  template <class Message>
  bool seal_and_publish(const std::string& channel, const Message& message,
                        std::chrono::nanoseconds now);
  /// Sends a message about motions that is computed from the newest image, in the name of this
  /// group.
  template <class Message>
  bool send_goals(const std::string& channel, Message& message);
  const Motion* motion_of(const AxisSignals& signals) const;
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
  std::string motion_stream_channel;
  std::string request_channel;
  std::string reply_channel;
  std::string event_channel;
  std::string status_channel;
  ImageInput input;
  AxisControl axes;
  NodeHolders holders;
  std::map<std::int16_t, node_status_t> nodes;                     // keys are node-IDs
  std::map<std::pair<std::int16_t, std::int8_t>, Motion> motions;  // keys are node-IDs and axes
  std::vector<speed_axis_t> speed_axes;                            // speed axes of the layout
  std::vector<std::optional<speed_axes_t>> speed_parts;            // the newest messages about them
  bool fresh = false;
  bool new_layout = false;
  bool reported_stale = false;
  bool reported_schema = false;
  bool commands = false;  // the group has sent a message since the last release
  Clock::time_point arrival{};
  std::optional<EnvelopeSeal> seal;  // empty if there is no key
  std::vector<event_t> events;
  std::vector<reply_t> replies;
  std::vector<std::byte> buffer;
};

template <class Message>
bool AxisGroup::State::send(const std::string& channel, Message& message) {
  using std::chrono::microseconds;
  const std::chrono::nanoseconds now = surroundings().wall();
  message.utime = std::chrono::duration_cast<microseconds>(now).count();
  message.instance = instance;
  message.sender = sender;
  return seal_and_publish(channel, message, now);
}

template <class Message>
bool AxisGroup::State::seal_and_publish(const std::string& channel, const Message& message,
                                        std::chrono::nanoseconds now) {
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

}  // namespace takt
