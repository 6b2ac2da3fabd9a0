// Verbs of `takt lss` that read or change the settings of devices.
#include <array>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "apps/command_line/json_text.hpp"
#include "apps/takt/service/lss/lss_verbs.hpp"
#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/can/interface_bitrate.hpp"
#include "master/wire/lss.hpp"

namespace takt {
namespace {

/// Selects the devices, runs `commands` and switches back to waiting state. Returns the results of
/// all these services.
std::vector<LssResult> configure(const LssOptions& options, LssAccess& access,
                                 std::vector<LssCommand> commands) {
  commands.insert(commands.begin(), selection(options));
  for (LssCommand& command : commands) command.several = options.all;
  commands.push_back({.op = LssOp::switch_global});
  std::vector<LssResult> results = access.run(commands);
  if (results.empty()) throw Failure{"the daemon ran no LSS service", 1};
  require_done(results.back());
  return results;
}

/// Configures a setting, and lets the devices store it if the user has requested that. Returns the
/// address of the device. Returns std::nullopt if the address is not known.
std::optional<LssAddress> set(const LssOptions& options, LssAccess& access, LssCommand setting) {
  std::vector<LssCommand> commands{setting};
  if (options.store) commands.push_back({.op = LssOp::store});
  return device_of(options, configure(options, access, commands).front());
}

/// Prints a setting with the device that has it: as JSON with this key, or as text.
void print_setting(const LssOptions& options, const std::optional<LssAddress>& device,
                   const char* key, int value, const std::string& text) {
  if (options.access.live.json) {
    return lss_print({{key, value},
                      {"stored", options.store},
                      {"device", device ? device_json(*device) : nlohmann::json{}}});
  }
  if (device) std::puts(device_text(*device).c_str());
  std::puts(text.c_str());
}

/// Activates the new bit rate in the devices and then on the interface. The interface goes down
/// only after the command has been sent, because going down discards its transmit queue.
void activate(const LssOptions& options, LssAccess& access) {
  using std::chrono::milliseconds;
  FrameChannel listener =
      value_or_fail(FrameChannel::open(options.access.bus, BusMember::guest), 3);
  const std::array<LssCommand, 2> commands{
      LssCommand{.op = LssOp::switch_global, .a = 1},
      LssCommand{.op = LssOp::activate_bit_timing,
                 .numbers = {static_cast<std::uint32_t>(options.delay_ms)}}};
  require_done(access.run(commands).back());
  const auto activation = static_cast<std::uint8_t>(lss::Service::activate_bit_timing);
  if (!listener.sees(lss::request_cob_id, activation, milliseconds{options.delay_ms})) {
    throw Failure{"the activation command was not sent: does any node acknowledge frames on " +
                  options.access.bus + "? The interface keeps its bit rate"};
  }
  const std::string trouble = set_interface_bitrate(options.access.bus, options.kbit * 1000);
  std::this_thread::sleep_for(milliseconds{2 * options.delay_ms});
  if (!trouble.empty()) throw Failure{trouble};
  LssAccess{options.access}.run({.op = LssOp::switch_global});  // the interface was down
  std::printf("the bus runs at %d kbit/s\n", options.kbit);
}

}  // namespace

void require_done(const LssResult& result) {
  if (result.outcome != LssOutcome::done) throw Failure{lss_failure_text(result), 1};
}

void lss_print(const nlohmann::json& json) { std::puts(json_text(json, 1).c_str()); }

int lss_set_id(const LssOptions& options) {
  LssAccess access{options.access};
  const auto device =
      set(options, access,
          {.op = LssOp::configure_node_id, .a = static_cast<std::uint8_t>(options.node_id)});
  print_setting(options, device, "node_id", options.node_id,
                fmt::format("node id {}{}. A device without node id boots with this id now; a "
                            "device that had another "
                            "id takes the new one at its next reset (takt nmt reset-comm)",
                            options.node_id, options.store ? ", stored" : ", not stored"));
  return 0;
}

int lss_set_bitrate(const LssOptions& options) {
  const auto entry = lss::bit_rate_index(static_cast<unsigned>(options.kbit));
  if (!entry) {
    return complain("CiA 305 has no bit rate of " + std::to_string(options.kbit) +
                        " kbit/s; there are 1000, 800, 500, 250, 125, 50, 20, 10",
                    2);
  }
  const bool activates = options.delay_ms != 0;
  if (activates && (!options.all || options.access.bus.empty())) {
    return complain("--activate changes the whole bus: stop taktd, and give --all and --bus, too",
                    2);
  }
  if (activates) {
    const std::string trouble = interface_bitrate_error(options.access.bus);
    if (!trouble.empty()) return complain(trouble, 3);
  }
  LssAccess access{options.access};
  const auto device =
      set(options, access, {.op = LssOp::configure_bit_timing, .a = 0, .b = *entry});
  print_setting(
      options, device, "kbit", options.kbit,
      fmt::format("{} kbit/s configured{}{}", options.kbit, options.store ? ", stored" : "",
                  activates ? "" : "; in use from the next power-on or activation"));
  if (activates) activate(options, access);
  return 0;
}

int lss_store(const LssOptions& options) {
  LssAccess access{options.access};
  configure(options, access, {{.op = LssOp::store}});
  return 0;
}

int lss_inquire(const LssOptions& options) {
  LssAccess access{options.access};
  const std::vector<LssResult> results = configure(options, access,
                                                   {{.op = LssOp::inquire_vendor},
                                                    {.op = LssOp::inquire_product},
                                                    {.op = LssOp::inquire_revision},
                                                    {.op = LssOp::inquire_serial},
                                                    {.op = LssOp::inquire_node_id}});
  LssAddress address{};
  for (std::size_t i = 0; i < 4; ++i) address[i] = results[1 + i].numbers[0];
  const std::uint32_t id = results[5].numbers[0];
  if (options.access.live.json) {
    nlohmann::json json = device_json(address);
    json["node_id"] = id == lss::no_node_id ? nlohmann::json{} : nlohmann::json(id);
    lss_print(json);
  } else {
    std::printf("%s  node id %s\n", device_text(address).c_str(),
                id == lss::no_node_id ? "none" : std::to_string(id).c_str());
  }
  return 0;
}

int lss_switch(const LssOptions& options) {
  const bool configures = options.state == "config";
  require_done(LssAccess{options.access}.run(
      {.op = LssOp::switch_global, .a = static_cast<std::uint8_t>(configures ? 1 : 0)}));
  return 0;
}

int lss_unconfigured(const LssOptions& options) {
  require_done(LssAccess{options.access}.run({.op = LssOp::identify_unconfigured}));
  std::puts("yes: at least one device has no node id");
  return 0;
}

}  // namespace takt
