#pragma once
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "apps/takt/live/text/line.hpp"
#include "master/gateway/message/bus_view.hpp"

namespace takt::test {

/// A bus whose messages have come: give it nodes and signals, then call view().
struct ShownBus {
  static constexpr std::int64_t session = 7;
  static constexpr std::int64_t hash = 9;

  status_t status{};
  layout_t layout{};
  std::vector<std::int64_t> values;
  std::vector<std::int32_t> stale;
  std::vector<speed_axis_t> speed_axes;
  std::vector<axis_motion_t> motions;
  std::vector<event_t> events;

  ShownBus() {
    status.schema = 2;
    status.parts = 1;
    status.session = session;
    status.bus = "plant";
    status.interface = "can0";
    status.bitrate = 1'000'000;
    status.realtime = "SCHED_FIFO 80, memory locked";
    status.cycle = 123'456;
    status.period_ns = 2'000'000;
    status.bus_load = 0.42F;
  }

  /// Adds a node that has booted.
  node_status_t& node(std::int16_t id, std::string name) {
    node_status_t made{};
    made.node_id = id;
    made.name = std::move(name);
    made.nmt_state = 5;
    made.boot_state = 2;
    made.heartbeat_age_ms = 99;
    status.nodes.push_back(std::move(made));
    return status.nodes.back();
  }

  void signal(std::int16_t id, const std::string& name, std::int32_t index, bool output,
              std::int16_t bits, std::int64_t value, const std::string& unit = "",
              double scale = 1.0) {
    signal_t made{};
    for (const node_status_t& each : status.nodes) {
      if (each.node_id == id) made.node = each.name;
    }
    made.node_id = id;
    made.name = name;
    made.index = index;
    made.output = output ? 1 : 0;
    made.bits = bits;
    made.data_type = bits == 8 ? 5 : bits == 16 ? 6 : 4;
    made.unit = unit;
    made.scale = scale;
    layout.signals.push_back(std::move(made));
    values.push_back(value);
  }

  /// Adds a drive of CiA 402 in cyclic synchronous position mode.
  void drive(std::int16_t id, const std::string& name, std::int64_t statusword,
             const std::string& unit = "rad") {
    node(id, name);
    const std::string velocity = unit.empty() ? "" : unit + "/s";
    signal(id, "statusword", 0x6041, false, 16, statusword);
    signal(id, "modes_of_operation_display", 0x6061, false, 8, 8);
    signal(id, "position_actual_value", 0x6064, false, 32, 12'345, unit, 1e-4);
    signal(id, "velocity_actual_value", 0x606C, false, 32, -2'500, velocity, 1e-3);
    signal(id, "controlword", 0x6040, true, 16, 0x000F);
    signal(id, "target_position", 0x607A, true, 32, 12'347, unit, 1e-4);
  }

  BusView view() {
    BusView bus;
    status.num_nodes = static_cast<std::int32_t>(status.nodes.size());
    bus.take(status);
    if (!speed_axes.empty()) {
      speed_axes_t message{};
      message.session = session;
      message.layout_hash = hash;
      message.parts = 1;
      message.axes = speed_axes;
      bus.take(message);
    }
    layout.session = session;
    layout.hash = hash;
    layout.total_signals = layout.num_signals = static_cast<std::int32_t>(layout.signals.size());
    bus.take(layout);
    image_t image{};
    image.session = session;
    image.layout_hash = hash;
    image.parts = 1;
    image.cycle = status.cycle;
    image.values = values;
    image.stale = stale;
    if (!values.empty()) bus.take(image);
    if (!motions.empty()) {
      motion_t message{};
      message.session = session;
      message.parts = 1;
      message.cycle = status.cycle;
      message.axes = motions;
      bus.take(message);
    }
    for (event_t& event : events) {
      event.session = session;
      bus.take(event);
    }
    return bus;
  }
};

inline speed_pattern_t bits(std::int32_t mask, std::vector<std::int32_t> values) {
  speed_pattern_t made{};
  made.mask = mask;
  made.num_values = static_cast<std::int32_t>(values.size());
  made.values = std::move(values);
  return made;
}

/// A machine of two drives, an inverter and an I/O node.
inline ShownBus machine() {
  ShownBus bus;
  bus.drive(1, "shoulder", 0x1637);
  bus.drive(2, "an_elbow_with_a_very_long_name_1", 0x0218, "mm");
  node_status_t& elbow = bus.status.nodes.back();
  elbow.error_register = 1;
  elbow.last_emcy = 0x3210;
  elbow.emcy_count = 12;
  bus.node(4, "pump");
  const auto first = static_cast<std::int32_t>(bus.layout.signals.size());
  bus.signal(4, "status_word", 0x2001, false, 16, 2);
  bus.signal(4, "frequency", 0x2001, false, 16, 2'000);
  bus.signal(4, "control_word", 0x2101, true, 16, 1);
  bus.signal(4, "set_frequency", 0x2101, true, 16, 2'000);
  speed_axis_t pump{};
  pump.node = "pump";
  pump.node_id = 4;
  pump.status = first;
  pump.actual_speed = first + 1;
  pump.control = first + 2;
  pump.set_speed = first + 3;
  pump.ready = bits(0xFF, {1, 2, 3});
  pump.running = bits(0xFF, {1, 2});
  pump.reverse = bits(0xFF, {2});
  pump.standstill = bits(0xFF, {3});
  pump.fault = bits(0xFF, {4});
  pump.run = 1;
  pump.run_reverse = 2;
  pump.unit = "Hz";
  pump.set_scale = pump.actual_scale = 0.01;
  bus.speed_axes.push_back(pump);
  bus.node(10, "io");
  bus.signal(10, "read_input_8_bit", 0x6000, false, 8, 0x2D);
  bus.signal(10, "write_output_8_bit", 0x6200, true, 8, 0x81);
  return bus;
}

inline std::string text_of(const std::vector<Line>& lines) {
  std::string text;
  for (const Line& line : lines) text += line.render(10'000, false) + '\n';
  return text;
}

}  // namespace takt::test
