#include "eds_parser/print/plan/plan_names.hpp"

#include <chrono>
#include <fmt/format.h>
#include <iterator>

#include "eds_parser/lcm/lcm_channel.hpp"
#include "eds_parser/lcm/typed_message.hpp"
#include "eds_parser/table/motion_axes.hpp"
#include "eds_parser/values/little_endian.hpp"
#include "eds_parser/values/name_of.hpp"

namespace takt {

using namespace std::chrono_literals;

std::string_view action_name(BootAction action) noexcept {
  static constexpr std::string_view names[]{"NMT",
                                            "await boot-up",
                                            "probe",
                                            "expect",
                                            "compare",
                                            "skip if same",
                                            "disable PDO",
                                            "write",
                                            "enable PDO",
                                            "verify",
                                            "write if differs",
                                            "await heartbeat",
                                            "await guarding",
                                            "await life",
                                            "await value",
                                            "download",
                                            "write if changed",
                                            "read serial",
                                            "read firmware",
                                            "read limit",
                                            "await OPERATIONAL",
                                            "pause"};
  return name_of(action, names);
}

std::string_view command_name(NmtCommand command) noexcept {
  switch (command) {
    case NmtCommand::start:
      return "start";
    case NmtCommand::stop:
      return "stop";
    case NmtCommand::enter_preoperational:
      return "enter pre-operational";
    case NmtCommand::reset_node:
      return "reset node";
    case NmtCommand::reset_communication:
      return "reset communication";
  }
  return "";
}

std::string value_text(const BootStep& step) {
  constexpr std::size_t longest = 64;
  const std::size_t size = step.value.size();
  if (size == 0) return {};
  if (size <= 8) return fmt::format("0x{:0{}X}", from_little_endian(step.value), 2 * size);
  if (size > longest) return fmt::format("{} bytes", size);
  std::string pairs;
  for (const std::byte byte : step.value) {
    fmt::format_to(std::back_inserter(pairs), "{:02X}", std::to_integer<unsigned>(byte));
  }
  return pairs;
}

std::string number_text(double value) { return fmt::format("{:.6g}", value); }

std::string us_text(Time time) { return fmt::format("{} us", time / 1us); }

std::string span_text(Time time) {
  if (time % 1ms == Time{}) return fmt::format("{} ms", time / 1ms);
  if (time < 10ms) return us_text(time);
  return fmt::format("{:.1f} ms", std::chrono::duration<double, std::milli>(time).count());
}

std::vector<LcmChannel> lcm_channels(const BusPlan& plan, const LcmOptions& options) {
  const auto channel = [&](std::string_view what) { return channel_name(plan.name, what); };
  std::vector<LcmChannel> channels{
      {channel("IMAGE"), "takt.image_t",
       "every cycle: all values, raw, in the order of the layout"},
      {channel("LAYOUT"), "takt.layout_t", "at start and once a second: the meaning of the values"},
      {channel("COMMAND"), "takt.command_t", "set-points from applications"},
      {channel("STATUS"), "takt.status_t", "10 Hz: nodes, boot steps, bus load, errors"},
      {channel("SYNC"), "takt.sync_status_t",
       "10 Hz: the producer of SYNC, and whether the cycle follows SYNC"},
      {channel("PDOS"), "takt.pdo_status_t", "2 Hz: age, count and faults of each PDO"},
      {channel("TIMING"), "takt.timing_t", "1 Hz: histograms of jitter and latency"},
      {channel("EVENT"), "takt.event_t", "boot reports, EMCY, state changes, faults"},
      {channel("REQUEST"), "takt.request_t", "SDO and NMT on behalf of applications"},
      {channel("REPLY"), "takt.reply_t", "answers to these requests"},
      {channel("TRANSFER"), "takt.transfer_t", "files to and from domains of devices, in parts"},
      {channel("TRANSFER_STATE"), "takt.transfer_state_t",
       "progress of these transfers, and data that were read"},
  };
  if (!plan.speed_axes.empty()) {
    channels.push_back(
        {channel("SPEED_AXES"), "takt.speed_axes_t", "with the layout: the words of inverters"});
  }
  if (!motion_axes(plan).empty()) {
    channels.push_back({channel("MOTION_COMMAND"), "takt.motion_command_t",
                        "motions that taktd runs: move, jog, stop"});
    channels.push_back({channel("MOTION_GEAR"), "takt.motion_gear_t", "axes that follow a leader"});
    channels.push_back({channel("MOTION_STREAM"), "takt.motion_stream_t",
                        "points that axes follow, sent in advance"});
    channels.push_back({channel("MOTION"), "takt.motion_t",
                        "after each image, once a motion was commanded: what the axes do"});
  }
  if (!options.typed) return channels;
  for (const TypedMessage& message : typed_messages(plan)) {
    channels.push_back({message.channel, message.package + '.' + message.name,
                        message.command
                            ? "set-points for this node alone, in SI if it has units"
                            : "every cycle: inputs of this node, in SI if it has units"});
  }
  return channels;
}

}  // namespace takt
