#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_t.hpp>
#include <utility>
#include <vector>

#include "master/lcm/messages.hpp"
#include "test/unit/apps/axis/fake_lcm.hpp"
#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt::test {

/// Imitates a taktd of two simple drives, and replaces LCM. Each time that the application looks
/// for messages, a cycle passes. Its motions go `step` further in each cycle.
struct MotionDaemon {
  static constexpr double step = 0.5;

  struct Drive {
    std::int64_t statusword = 0x0250;
    std::int64_t controlword = 0;
    double position = 0.0;
    double target = 0.0;
    double velocity = 0.0;  // of a jog; 0 means a move
    axis_motion_t motion{};
  };

  std::array<Drive, 2> drives;
  std::int64_t cycle = 0;
  std::int64_t session = test::session;  ///< changes when taktd restarts
  bool has_motions = true;
  bool active = false;
  std::string refuses;  ///< the reason, if it refuses each motion
  std::string holder;   ///< another program that holds both nodes
  std::string sender;   ///< of the newest command
  std::int32_t last_emcy = 0;
  std::function<void(MotionDaemon&)> each_cycle;
  std::vector<motion_command_t> commands;  ///< without signs of life
  std::vector<motion_gear_t> gears;
  int signs_of_life = 0;
  int releases = 0;
  bool cyclic = true;     ///< false: no further image comes
  int ignored_stops = 0;  ///< number of stops that are lost on their way
};

class MotionDaemonTransport final : public Transport {
 public:
  explicit MotionDaemonTransport(MotionDaemon& daemon) : daemon_{daemon} {}

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    if (channel == "LIFT_COMMAND") take(*decode<command_t>(data));
    if (channel == "LIFT_MOTION_GEAR") take(*decode<motion_gear_t>(data));
    if (channel != "LIFT_MOTION_COMMAND") return true;
    if (daemon_.has_motions) {
      take(*decode<motion_command_t>(data));
    } else {
      say("motion_refused", "taktd runs no motions: it was started with --no-motions");
    }
    return true;
  }
  void subscribe(const std::string&) override {}
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return "test"; }

  void serve(const MessageHandler& handler) override {
    if (!daemon_.cyclic) return;
    ++daemon_.cycle;
    if (daemon_.session != laid_out_ || daemon_.cycle % 100 == 0) {
      laid_out_ = daemon_.session;
      layout_t layout = two_axes();
      layout.session = daemon_.session;
      return send(handler, "LIFT_LAYOUT", layout);
    }
    if (daemon_.each_cycle) daemon_.each_cycle(daemon_);
    for (MotionDaemon::Drive& drive : daemon_.drives) advance(drive);
    for (const event_t& event : std::exchange(events_, {})) send(handler, "LIFT_EVENT", event);
    if (daemon_.cycle % 10 == 0) send(handler, "LIFT_STATUS", shown_status());
    send(handler, "LIFT_IMAGE", shown_image());
    if (daemon_.active) send(handler, "LIFT_MOTION", shown_motion());
  }

 private:
  template <class Message>
  void send(const MessageHandler& handler, const std::string& channel, const Message& message) {
    std::vector<std::byte> buffer;
    handler(channel, encode(message, buffer));
  }

  void take(const command_t& command) {
    daemon_.sender = command.sender;
    daemon_.releases += command.release;
    if (!daemon_.holder.empty()) return;
    for (std::size_t i = 0; i < command.signals.size(); ++i) {
      if (command.signals[i] == 4) daemon_.drives[0].controlword = command.values[i];
      if (command.signals[i] == 5) daemon_.drives[1].controlword = command.values[i];
    }
  }

  void take(const motion_command_t& command) {
    daemon_.active = true;
    if (command.kind == "alive") {
      daemon_.signs_of_life += command.goals.empty() ? 0 : 1;  // without goals it renews no jog
      return;
    }
    daemon_.commands.push_back(command);
    if (command.kind == "stop" && daemon_.ignored_stops-- > 0) return;
    for (const motion_goal_t& goal : command.goals) {
      MotionDaemon::Drive& drive = daemon_.drives[goal.node == "shoulder" ? 0 : 1];
      if (command.kind == "stop") {
        end(drive, 2);
        continue;
      }
      if (!daemon_.refuses.empty()) {
        drive.motion.ended_id = command.id;
        drive.motion.outcome = 4;
        say("motion_refused", "motion " + std::to_string(command.id) + " of '" + command.sender +
                                  "' refused: " + daemon_.refuses);
        continue;
      }
      end(drive, 3);
      drive.motion.id = command.id;
      drive.target = goal.position + (command.kind == "move_by" ? drive.position : 0.0);
      drive.velocity = goal.velocity;
    }
  }

  /// This daemon treats a gear as a jog whose axes are locked at once.
  void take(const motion_gear_t& gear) {
    daemon_.gears.push_back(gear);
    motion_command_t command{};
    command.kind = "gear";
    command.id = gear.id;
    command.sender = gear.sender;
    command.goals = gear.goals;
    for (motion_goal_t& goal : command.goals) goal.velocity = 1.0;
    take(command);
  }

  void say(const std::string& kind, const std::string& text) {
    event_t event{};
    event.schema = message_schema;
    event.kind = kind;
    event.severity = 1;
    event.text = text;
    events_.push_back(event);
  }

  void end(MotionDaemon::Drive& drive, std::int8_t outcome) {
    if (drive.motion.id == 0) return;
    drive.motion.ended_id = std::exchange(drive.motion.id, 0);
    drive.motion.outcome = outcome;
  }

  void advance(MotionDaemon::Drive& drive) {
    constexpr std::array<std::array<std::int64_t, 3>, 7> next{{{0x0250, 0x06, 0x0231},
                                                               {0x0231, 0x07, 0x0233},
                                                               {0x0233, 0x0F, 0x0237},
                                                               {0x0237, 0x07, 0x0233},
                                                               {0x0233, 0x06, 0x0231},
                                                               {0x0231, 0x00, 0x0250},
                                                               {0x0218, 0x80, 0x0250}}};
    for (const auto& [from, word, to] : next) {
      if (drive.statusword != from || drive.controlword != word) continue;
      drive.statusword = to;
      break;
    }
    const bool enabled = drive.statusword == 0x0237;
    if (!enabled && drive.motion.id != 0) {
      say("motion_stopped", "motion " + std::to_string(drive.motion.id) +
                                " has stopped because of shoulder: the drive is in fault");
      end(drive, 2);
    }
    if (drive.motion.id != 0) {
      const double left = drive.target - drive.position;
      const double way = std::copysign(std::min(std::abs(left), MotionDaemon::step), left);
      drive.position += drive.velocity != 0.0 ? std::copysign(0.001, drive.velocity) : way;
      if (drive.velocity == 0.0 && drive.position == drive.target) end(drive, 1);
    }
    const bool follows = !daemon_.gears.empty() && daemon_.gears.back().id == drive.motion.id;
    drive.motion.gear = follows && drive.motion.id != 0 ? 2 : 0;
    drive.motion.state = !enabled ? 0 : drive.motion.id != 0 ? 2 : 1;
    drive.motion.position = drive.position;
  }

  image_t shown_image() const {
    const auto& [shoulder, elbow] = daemon_.drives;
    image_t made =
        image(daemon_.cycle,
              {shoulder.statusword, elbow.statusword, std::llround(shoulder.position * 1000.0),
               std::llround(elbow.position * 1000.0), shoulder.controlword, elbow.controlword});
    made.session = daemon_.session;
    return made;
  }
  motion_t shown_motion() const {
    motion_t made{};
    made.schema = message_schema;
    made.parts = 1;
    made.session = daemon_.session;
    made.cycle = daemon_.cycle;
    for (std::size_t i = 0; i < 2; ++i) {
      axis_motion_t axis = daemon_.drives[i].motion;
      axis.node_id = static_cast<std::int16_t>(5 + i);
      axis.axis = 1;
      made.axes.push_back(axis);
    }
    made.num_axes = 2;
    return made;
  }
  status_t shown_status() const {
    const std::string& holder = daemon_.holder.empty() ? daemon_.sender : daemon_.holder;
    status_t made = status(holder, holder);
    for (node_status_t& node : made.nodes) {
      node.boot_state = 2;
      if (daemon_.last_emcy == 0) continue;
      node.emcys = {daemon_.last_emcy};
      node.num_emcys = 1;
    }
    return made;
  }

  MotionDaemon& daemon_;
  std::vector<event_t> events_;
  std::int64_t laid_out_ = 0;  // session of the newest layout
};

}  // namespace takt::test
