#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <takt/command_t.hpp>
#include <takt/lcm.hpp>
#include <takt/speed_axes_t.hpp>
#include <utility>
#include <vector>

#include "master/lcm/messages.hpp"
#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt::test {

/// Imitates a taktd of one inverter, and replaces LCM. Each time that the application looks for
/// messages, a cycle of 2 ms passes. The frequency goes `step` counts further in each cycle.
struct InverterDaemon {
  static constexpr std::int64_t step = 100;

  std::int64_t cycle = 0;
  std::int64_t control = 0;
  std::int64_t set_speed = 0;
  std::int64_t frequency = 0;  // 0.01 Hz, with its sign
  bool fault = false;
  bool fell_back = false;        ///< the commands are too old, once
  std::int64_t reset_from = -1;  ///< control word before the newest fault reset
  std::int32_t time_to_live = 0;
  int commands = 0;
  int releases = 0;
  double max_acceleration = 0.0;
  std::string holder;
  std::function<void(InverterDaemon&)> each_cycle;
  std::vector<std::int64_t> speeds;  ///< that were commanded while it ran
};

inline speed_pattern_t pattern(std::int32_t mask, std::vector<std::int32_t> values) {
  speed_pattern_t made{};
  made.mask = mask;
  made.num_values = static_cast<std::int32_t>(values.size());
  made.values = std::move(values);
  return made;
}

/// Signals 0 and 1 are the status word and the frequency, 2 and 3 the control word and the set
/// frequency.
inline layout_t inverter_layout() {
  layout_t layout{};
  layout.schema = 2;
  layout.parts = 1;
  layout.session = session;
  layout.hash = hash;
  layout.period_ns = 2'000'000;
  layout.signals = {signal(5, 0x2001, false, 16), signal(5, 0x2001, false, 16),
                    signal(5, 0x2101, true, 16), signal(5, 0x2101, true, 16)};
  layout.num_signals = layout.total_signals = 4;
  layout.inputs = 2;
  return layout;
}

inline speed_axes_t inverter_words() {
  speed_axes_t message{};
  message.schema = 2;
  message.parts = 1;
  message.session = session;
  message.layout_hash = hash;
  speed_axis_t axis{};
  axis.node = "pump";
  axis.node_id = 5;
  axis.status = 0;
  axis.actual_speed = 1;
  axis.control = 2;
  axis.set_speed = 3;
  axis.off = axis.stop = 5;
  axis.run = 1;
  axis.run_reverse = 2;
  axis.quick_stop = 6;
  axis.reset = 7;
  axis.ready = pattern(0xFF, {1, 2, 3});
  axis.running = pattern(0xFF, {1, 2});
  axis.reverse = pattern(0xFF, {2});
  axis.standstill = pattern(0xFF, {3});
  axis.fault = pattern(0xFF, {4});
  axis.unit = "Hz";
  axis.set_scale = axis.actual_scale = 0.01;
  axis.max_speed = 50.0;
  message.axes.push_back(axis);
  message.num_axes = 1;
  return message;
}

class InverterTransport final : public Transport {
 public:
  explicit InverterTransport(InverterDaemon& daemon) : daemon_{daemon} {}

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    if (channel == "LIFT_COMMAND") take(*decode<command_t>(data));
    return true;
  }
  void subscribe(const std::string&) override {}
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return "test"; }

  void serve(const MessageHandler& handler) override {
    ++daemon_.cycle;
    if (daemon_.cycle % 100 == 1) {
      speed_axes_t words = inverter_words();
      words.axes[0].max_acceleration = daemon_.max_acceleration;
      send(handler, "LIFT_SPEED_AXES", words);
      return send(handler, "LIFT_LAYOUT", inverter_layout());
    }
    if (daemon_.each_cycle) daemon_.each_cycle(daemon_);
    advance();
    if (daemon_.fell_back) {
      daemon_.fell_back = false;
      event_t event{};
      event.schema = 2;
      event.kind = "fallback_begun";
      event.severity = 1;
      event.node_id = 5;
      event.text = "pump stops: its commands are too old";
      send(handler, "LIFT_EVENT", event);
    }
    if (daemon_.cycle % 10 == 0) {
      status_t shown = status(daemon_.holder.empty() ? sender_ : daemon_.holder, "");
      for (node_status_t& node : shown.nodes) node.boot_state = 2;
      send(handler, "LIFT_STATUS", shown);
    }
    image_t made = image(daemon_.cycle,
                         {word(), std::abs(daemon_.frequency), daemon_.control, daemon_.set_speed});
    made.values.resize(4);
    made.num_values = 4;
    send(handler, "LIFT_IMAGE", made);
  }

 private:
  template <class Message>
  void send(const MessageHandler& handler, const std::string& channel, const Message& message) {
    std::vector<std::byte> buffer;
    handler(channel, encode(message, buffer));
  }
  void take(const command_t& command) {
    ++daemon_.commands;
    daemon_.releases += command.release;
    daemon_.time_to_live = command.time_to_live;
    sender_ = command.sender;
    for (std::size_t i = 0; i < command.signals.size(); ++i) {
      if (command.signals[i] == 3) daemon_.set_speed = command.values[i];
      if (command.signals[i] != 2) continue;
      if (command.values[i] == 7 && daemon_.control != 7) daemon_.reset_from = daemon_.control;
      daemon_.control = command.values[i];
    }
    if (command.release) daemon_.control = 5;
  }
  void advance() {
    if (daemon_.control == 7) daemon_.fault = false;
    std::int64_t aim = 0;
    if (daemon_.control == 1) aim = daemon_.set_speed;
    if (daemon_.control == 2) aim = -daemon_.set_speed;
    if (daemon_.control == 1 || daemon_.control == 2) daemon_.speeds.push_back(aim);
    if (daemon_.fault) aim = daemon_.frequency = 0;
    daemon_.frequency = std::clamp(aim, daemon_.frequency - InverterDaemon::step,
                                   daemon_.frequency + InverterDaemon::step);
  }
  std::int64_t word() const {
    if (daemon_.fault) return 4;
    if (daemon_.frequency != 0) return daemon_.frequency > 0 ? 1 : 2;
    return daemon_.control == 1 ? 1 : daemon_.control == 2 ? 2 : 3;
  }

  InverterDaemon& daemon_;
  std::string sender_;
};

}  // namespace takt::test
