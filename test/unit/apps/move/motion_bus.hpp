#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <takt/event_t.hpp>
#include <takt/motion_command_t.hpp>
#include <utility>
#include <vector>

#include "test/unit/apps/axis/motion_daemon.hpp"

namespace takt::test {

/// What happens between an application and a MotionDaemon.
struct MotionBus {
  enum class Moves : std::uint8_t { arrive, late, lost };

  MotionDaemon daemon;
  Moves moves = Moves::arrive;
  bool reports = true;            ///< false: no motion_t arrives any more
  std::vector<event_t> events;    ///< that arrive with the next image
  std::vector<std::string> sent;  ///< kinds of all commands for motions
  std::vector<motion_command_t> on_the_way;

  /// Stops both axes as taktd does. Without a cause it does not say why.
  void stop_axes(const std::string& cause) {
    for (MotionDaemon::Drive& drive : daemon.drives) {
      if (drive.motion.id == 0) continue;
      if (!cause.empty()) {
        event_t event{};
        event.schema = message_schema;
        event.kind = "motion_stopped";
        event.severity = 1;
        event.text = "elbow: motion " + std::to_string(drive.motion.id) +
                     " has stopped because of shoulder: " + cause;
        events.push_back(event);
      }
      drive.motion.ended_id = std::exchange(drive.motion.id, 0);
      drive.motion.outcome = 2;
    }
  }
};

class MotionBusTransport final : public Transport {
 public:
  explicit MotionBusTransport(MotionBus& bus) : bus_{bus}, daemon_{bus.daemon} {}

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    if (channel == "LIFT_MOTION_COMMAND") {
      const auto command = decode<motion_command_t>(data);
      bus_.sent.push_back(command->kind);
      if (command->kind == "move" && bus_.moves != MotionBus::Moves::arrive) {
        bus_.on_the_way.push_back(*command);
        return true;
      }
    }
    return daemon_.publish(channel, data);
  }
  void subscribe(const std::string&) override {}
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return "test"; }

  void serve(const MessageHandler& handler) override {
    if (bus_.moves == MotionBus::Moves::late && ++images_ % images_late == 0) deliver();
    std::vector<std::byte> buffer;
    daemon_.serve([&](std::string_view channel, std::span<const std::byte> data) {
      if (channel == "LIFT_LAYOUT") return handler(channel, encode(with_modes(data), buffer));
      if (channel != "LIFT_MOTION" || bus_.reports) handler(channel, data);
    });
    for (const event_t& event : std::exchange(bus_.events, {})) {
      handler("LIFT_EVENT", encode(event, buffer));
    }
  }

 private:
  static constexpr int images_late = 4;

  /// Returns this layout with 0x6060 of both axes in an RPDO, for programs that look at the mode.
  static layout_t with_modes(std::span<const std::byte> data) {
    layout_t layout = *decode<layout_t>(data);
    layout.signals.push_back(signal(5, 0x6060, true, 8));
    layout.signals.push_back(signal(6, 0x6060, true, 8));
    layout.num_signals = layout.total_signals = 10;
    return layout;
  }

  void deliver() {
    std::vector<std::byte> buffer;
    for (const motion_command_t& command : std::exchange(bus_.on_the_way, {})) {
      daemon_.publish("LIFT_MOTION_COMMAND", encode(command, buffer));
    }
  }

  MotionBus& bus_;
  MotionDaemonTransport daemon_;
  int images_ = 0;
};

}  // namespace takt::test
