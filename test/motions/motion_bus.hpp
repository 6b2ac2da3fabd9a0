#pragma once
#include <deque>
#include <string>
#include <takt/image_t.hpp>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_stream_t.hpp>
#include <takt/motion_t.hpp>
#include <utility>
#include <vector>

#include "master/gateway/bridge.hpp"
#include "master/sim/device/device.hpp"
#include "test/motions/axes_in_virtual_time.hpp"

namespace takt::test {

// States and outcomes of axis_motion_t.
inline constexpr std::int8_t standing = 1;
inline constexpr std::int8_t moving = 2;
inline constexpr std::int8_t stopping = 3;
inline constexpr std::int8_t done = 1;
inline constexpr std::int8_t stopped = 2;
inline constexpr std::int8_t refused = 4;

/// LCM in memory: keeps the newest motion_t and the cycle of the newest image, and delivers what an
/// application sends.
class MotionLcm final : public Transport {
 public:
  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    if (channel == "DEMO_MOTION") {
      if (const auto found = decode<motion_t>(data)) motion = *found;
    }
    if (channel == "DEMO_IMAGE") {
      if (const auto found = decode<image_t>(data)) cycle = found->cycle;
    }
    if (listener) listener(channel, data);
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler& handler) override {
    for (const auto& [channel, data] : std::exchange(waiting, {})) handler(channel, data);
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  template <class T>
  void send(const std::string& channel, const T& message) {
    std::vector<std::byte> data(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(data.data(), 0, message.getEncodedSize());
    waiting.emplace_back(channel, std::move(data));
  }

  motion_t motion{};
  std::int64_t cycle = 0;  ///< of the newest image
  std::deque<std::pair<std::string, std::vector<std::byte>>> waiting;
  std::function<void(const std::string&, std::span<const std::byte>)> listener;
};

class WorldClocks final : public Clocks {
 public:
  explicit WorldClocks(const sim::World& world) : world_{world} {}
  Time now() const noexcept override { return world_.now(); }
  Time wall_offset() const noexcept override { return offset; }

  Time offset{};  ///< clock of the day minus the time of the world

 private:
  const sim::World& world_;
};

/// Two axes in virtual time with their gateway, and an application that sends messages.
class MotionBus final : public AxesInVirtualTime {
 public:
  static constexpr std::int64_t session = 7;

  explicit MotionBus(sim::Faults faults = {}, const char* file = demo)
      : AxesInVirtualTime{std::move(faults), file},
        clocks{world},
        bridge{master, lcm, clocks, options(),
               [this](const Notice& notice) { notices.push_back(notice); }} {
    begin();
  }

  /// Boots both drives, and commands them to Operation enabled by command_t of `instance`. The time
  /// to live of the commands is the configured one, 500 cycles.
  void enable(std::int64_t instance = 5) {
    each_cycle = [this, instance] { send_enable(instance); };
    ASSERT_TRUE(run_until([&] { return enabled(0) && enabled(1); }));
    keep_alive();  // from now on, the bus thread reads the axes
    run(5);
    each_cycle = {};
  }
  bool enabled(std::size_t axis) { return (value(axis, 0x6041).value_or(0) & 0x6F) == 0x27; }
  /// Position of the simulated drive in rad.
  double position(std::size_t axis) { return scale * static_cast<double>(*value(axis, 0x6064)); }
  /// Target position that the simulated drive has received, in counts.
  std::int64_t target(std::size_t axis) { return *value(axis, 0x607A); }

  motion_command_t command(const std::string& kind, std::int32_t id, std::int64_t instance = 5) {
    motion_command_t message{};
    message.schema = message_schema;
    message.session = session;
    message.instance = instance;
    message.sender = "test";
    message.cycle = lcm.cycle;
    message.id = id;
    message.kind = kind;
    return message;
  }
  static motion_goal_t goal(const std::string& node, double position) {
    motion_goal_t goal{};
    goal.node = node;
    goal.position = position;
    goal.max_velocity = 3.0;
    goal.max_acceleration = 20.0;
    goal.max_jerk = 400.0;
    return goal;
  }
  void send(motion_command_t message) {
    message.num_goals = static_cast<std::int32_t>(message.goals.size());
    lcm.send(bridge.channels().motion_command, message);
  }
  void move_one(std::int32_t id, double shoulder, std::int64_t instance = 5) {
    motion_command_t message = command("move", id, instance);
    message.goals = {goal("shoulder", shoulder)};
    send(message);
  }
  void move_both(std::int32_t id, double shoulder, double elbow) {
    motion_command_t message = command("move", id);
    message.goals = {goal("shoulder", shoulder), goal("elbow", elbow)};
    send(message);
  }
  /// A gear of the elbow behind this leader, with the limits of goal().
  motion_gear_t gear(std::int32_t id, const std::string& leader, double ratio) {
    motion_gear_t message{};
    message.schema = message_schema;
    message.session = session;
    message.instance = 5;
    message.sender = "test";
    message.cycle = lcm.cycle;
    message.id = id;
    message.leader = leader;
    message.goals = {goal("elbow", 0.0)};
    message.numerator = {ratio};
    message.denominator = {1.0};
    message.max_phase_error = {0.0};
    message.num_goals = 1;
    return message;
  }
  void send(const motion_gear_t& message) { lcm.send(bridge.channels().motion_gear, message); }
  /// Points of these nodes, with the limits of goal().
  void send_stream(std::int32_t id, const std::vector<std::string>& nodes, std::int64_t first,
                   const std::vector<motion_point_t>& points) {
    motion_stream_t message{};
    message.schema = message_schema;
    message.session = session;
    message.instance = 5;
    message.sender = "test";
    message.cycle = lcm.cycle;
    message.id = id;
    for (const std::string& node : nodes) message.goals.push_back(goal(node, 0.0));
    message.num_goals = static_cast<std::int32_t>(message.goals.size());
    message.first_point = first;
    message.points = points;
    message.num_points = static_cast<std::int32_t>(points.size());
    for (motion_point_t& point : message.points) {
      point.num_axes = static_cast<std::int32_t>(point.position.size());
      point.velocity.resize(point.position.size(), std::numeric_limits<double>::quiet_NaN());
      point.num_accelerations = static_cast<std::int32_t>(point.acceleration.size());
    }
    lcm.send(bridge.channels().motion_stream, message);
  }
  void keep_alive() { send(command("alive", 0)); }
  /// A command_t of these outputs of an axis, by the index of their objects.
  void send_outputs(std::size_t axis,
                    const std::vector<std::pair<std::uint16_t, std::int64_t>>& outputs,
                    std::int32_t time_to_live = 0) {
    command_t message{};
    message.schema = message_schema;
    message.session = session;
    message.instance = 5;
    message.sender = "test";
    message.cycle = lcm.cycle;
    const auto& signals = network.plan.layout.signals;
    for (std::size_t i = network.plan.layout.inputs; i < signals.size(); ++i) {
      for (const auto& [index, value] : outputs) {
        if (signals[i].node_index != axes[axis].node_index) continue;
        if (signals[i].object.index != index) continue;
        message.signals.push_back(static_cast<std::int32_t>(i));
        message.values.push_back(value);
      }
    }
    message.time_to_live = time_to_live;
    message.num_values = static_cast<std::int32_t>(message.values.size());
    lcm.send(bridge.channels().command, message);
  }
  void send_controlword(std::size_t axis, std::int64_t word, std::int32_t time_to_live = 0) {
    send_outputs(axis, {{0x6040, word}}, time_to_live);
  }
  /// The application releases its nodes.
  void release() {
    command_t message{};
    message.schema = message_schema;
    message.session = session;
    message.instance = 5;
    message.sender = "test";
    message.cycle = lcm.cycle;
    message.release = 1;
    lcm.send(bridge.channels().command, message);
  }
  /// Returns what the newest motion_t reports about an axis.
  axis_motion_t axis(std::size_t i) const {
    return i < lcm.motion.axes.size() ? lcm.motion.axes[i] : axis_motion_t{};
  }
  bool said(const std::string& kind, const std::string& part) const {
    return std::ranges::any_of(notices, [&](const Notice& notice) {
      return notice.kind == kind && notice.text.find(part) != std::string::npos;
    });
  }

  static constexpr double scale = 6.283185307179586e-4;
  MotionLcm lcm;
  WorldClocks clocks;
  std::vector<Notice> notices;
  Bridge bridge;
  bool front_runs = true;

 private:
  void run_cycle() override {
    master.cycle();
    if (front_runs) bridge.serve();
  }
  static BridgeOptions options() {
    BridgeOptions made;
    made.session = session;
    made.motions = true;
    return made;
  }
  std::optional<std::int64_t> value(std::size_t axis, std::uint16_t index) {
    const NodeId node = network.plan.nodes[axes[axis].node_index].id;
    return world.device(node)->objects().number({index, 0});
  }
  void send_enable(std::int64_t instance) {
    command_t message{};
    message.schema = message_schema;
    message.session = session;
    message.instance = instance;
    message.sender = "test";
    message.cycle = lcm.cycle;
    const auto& signals = network.plan.layout.signals;
    for (std::size_t i = network.plan.layout.inputs; i < signals.size(); ++i) {
      for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        if (signals[i].node_index != axes[axis].node_index) continue;
        const std::int64_t word = *value(axis, 0x6041);
        const std::int64_t next = (word & 0x4F) == 0x40   ? 0x06
                                  : (word & 0x6F) == 0x21 ? 0x07
                                                          : 0x0F;
        const std::uint16_t object = signals[i].object.index;
        if (object != 0x6040 && object != 0x6060) continue;
        message.signals.push_back(static_cast<std::int32_t>(i));
        message.values.push_back(object == 0x6040 ? next : 8);
      }
    }
    message.num_values = static_cast<std::int32_t>(message.values.size());
    if (message.cycle > 0) lcm.send(bridge.channels().command, message);
  }
};

}  // namespace takt::test
