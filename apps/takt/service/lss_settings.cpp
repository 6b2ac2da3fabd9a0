// Verbs of `takt lss` that read or change the settings of devices.
#include <array>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/command_line/json_text.hpp"
#include "apps/takt/service/lss_verbs.hpp"
#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/can/interface_bitrate.hpp"
#include "master/wire/lss.hpp"

namespace takt {
namespace {

/// Selects the devices, runs `commands` and switches back to waiting state. Returns the results of
/// all these services.
std::expected<std::vector<LssResult>, LiveError> configure(const LssOptions& options,
                                                           LssAccess& access,
                                                           std::vector<LssCommand> commands) {
  commands.insert(commands.begin(), selection(options));
  for (LssCommand& command : commands) command.several = options.all;
  commands.push_back({.op = LssOp::switch_global});
  auto results = access.run(commands);
  if (!results) return results;
  if (results->empty() || results->back().outcome != LssOutcome::done) {
    const std::string why =
        results->empty() ? "the daemon ran no LSS service" : lss_failure_text(results->back());
    return std::unexpected{LiveError{why, 1}};
  }
  return results;
}

/// Activates the new bit rate in the devices and then on the interface. The interface goes down
/// only after the command has been sent, because going down discards its transmit queue.
int activate(const LssOptions& options, LssAccess& access) {
  using std::chrono::milliseconds;
  auto witness = FrameChannel::open(options.access.bus, BusMember::guest);
  if (!witness) return complain(witness.error().message, 3);
  const std::array<LssCommand, 2> commands{
      LssCommand{.op = LssOp::switch_global, .a = 1},
      LssCommand{.op = LssOp::activate_bit_timing,
                 .numbers = {static_cast<std::uint32_t>(options.delay_ms)}}};
  const auto results = access.run(commands);
  if (!results) return lss_failed(results.error());
  if (results->back().outcome != LssOutcome::done) {
    return complain(lss_failure_text(results->back()), 1);
  }
  const auto activation = static_cast<std::uint8_t>(lss::Service::activate_bit_timing);
  if (!witness->sees(lss::request_cob_id, activation, milliseconds{options.delay_ms})) {
    return complain("the activation command was not sent: does any node acknowledge frames on " +
                        options.access.bus + "? The interface keeps its bit rate",
                    3);
  }
  const std::string trouble = set_interface_bitrate(options.access.bus, options.kbit * 1000);
  std::this_thread::sleep_for(milliseconds{2 * options.delay_ms});
  if (!trouble.empty()) return complain(trouble, 3);
  auto again = LssAccess::open(options.access);  // needed because the interface was down
  if (!again) return lss_failed(again.error());
  const LssCommand leave{.op = LssOp::switch_global};
  if (const auto left = again->run({&leave, 1}); !left) return lss_failed(left.error());
  std::printf("the bus runs at %d kbit/s\n", options.kbit);
  return 0;
}

/// Runs one service that only succeeds or fails.
int run_one(const LssOptions& options, const LssCommand& command) {
  auto access = LssAccess::open(options.access);
  if (!access) return lss_failed(access.error());
  const auto results = access->run({&command, 1});
  if (!results) return lss_failed(results.error());
  const LssResult& result = results->back();
  return result.outcome == LssOutcome::done ? 0 : complain(lss_failure_text(result), 1);
}

}  // namespace

int lss_failed(const LiveError& error) { return complain(error.sentence, error.code); }

void lss_print(const nlohmann::json& json) { std::puts(json_text(json, 1).c_str()); }

int lss_set_id(const LssOptions& options) {
  auto access = LssAccess::open(options.access);
  if (!access) return lss_failed(access.error());
  std::vector<LssCommand> commands{
      {.op = LssOp::configure_node_id, .a = static_cast<std::uint8_t>(options.node_id)}};
  if (options.store) commands.push_back({.op = LssOp::store});
  const auto results = configure(options, *access, commands);
  if (!results) return lss_failed(results.error());
  const auto device = device_of(options, results->front());
  if (options.access.live.json) {
    lss_print({{"node_id", options.node_id},
               {"stored", options.store},
               {"device", device ? device_json(*device) : nlohmann::json{}}});
    return 0;
  }
  if (device) std::puts(device_text(*device).c_str());
  std::printf(
      "node id %d%s. A device without node id boots with this id now; a device that had another "
      "id takes the new one at its next reset (takt nmt reset-comm)\n",
      options.node_id, options.store ? ", stored" : ", not stored");
  return 0;
}

int lss_set_bitrate(const LssOptions& options) {
  const auto entry = lss::bit_rate_index(static_cast<unsigned>(options.kbit));
  if (!entry) {
    return complain("CiA 305 has no bit rate of " + std::to_string(options.kbit) +
                        " kbit/s; there are 1000, 800, 500, 250, 125, 50, 20, 10",
                    2);
  }
  if (options.delay_ms != 0 && (!options.all || options.access.bus.empty())) {
    return complain("--activate changes the whole bus: stop taktd, and give --all and --bus, too",
                    2);
  }
  if (options.delay_ms != 0) {
    const std::string trouble = interface_bitrate_trouble(options.access.bus);
    if (!trouble.empty()) return complain(trouble, 3);
  }
  auto access = LssAccess::open(options.access);
  if (!access) return lss_failed(access.error());
  std::vector<LssCommand> commands{{.op = LssOp::configure_bit_timing, .a = 0, .b = *entry}};
  if (options.store) commands.push_back({.op = LssOp::store});
  const auto results = configure(options, *access, commands);
  if (!results) return lss_failed(results.error());
  const auto device = device_of(options, results->front());
  if (options.access.live.json) {
    lss_print({{"kbit", options.kbit},
               {"stored", options.store},
               {"device", device ? device_json(*device) : nlohmann::json{}}});
  } else {
    if (device) std::puts(device_text(*device).c_str());
    std::printf("%d kbit/s configured%s%s\n", options.kbit, options.store ? ", stored" : "",
                options.delay_ms != 0 ? "" : "; in use from the next power-on or activation");
  }
  return options.delay_ms != 0 ? activate(options, *access) : 0;
}

int lss_store(const LssOptions& options) {
  auto access = LssAccess::open(options.access);
  if (!access) return lss_failed(access.error());
  const auto results = configure(options, *access, {{.op = LssOp::store}});
  return results ? 0 : lss_failed(results.error());
}

int lss_inquire(const LssOptions& options) {
  auto access = LssAccess::open(options.access);
  if (!access) return lss_failed(access.error());
  const auto results = configure(options, *access,
                                 {{.op = LssOp::inquire_vendor},
                                  {.op = LssOp::inquire_product},
                                  {.op = LssOp::inquire_revision},
                                  {.op = LssOp::inquire_serial},
                                  {.op = LssOp::inquire_node_id}});
  if (!results) return lss_failed(results.error());
  LssAddress address{};
  for (std::size_t i = 0; i < 4; ++i) address[i] = (*results)[1 + i].numbers[0];
  const std::uint32_t id = (*results)[5].numbers[0];
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
  return run_one(options, {.op = LssOp::switch_global,
                           .a = static_cast<std::uint8_t>(options.state == "config" ? 1 : 0)});
}

int lss_unconfigured(const LssOptions& options) {
  const int code = run_one(options, {.op = LssOp::identify_unconfigured});
  if (code == 0) std::puts("yes: at least one device has no node id");
  return code;
}

}  // namespace takt
