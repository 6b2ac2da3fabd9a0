#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <thread>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/service/lss_selection.hpp"
#include "master/linux/bus/frame_witness.hpp"
#include "master/linux/can/interface_bitrate.hpp"
#include "master/wire/lss.hpp"

namespace takt {
namespace {

std::string check_number(const std::string& text) {
  return lss_number(text) ? "" : "'" + text + "' is not a number of 32 bits (decimal, or 0x hex)";
}

std::string check_range(const std::string& text) {
  return lss_range(text) ? ""
                         : "'" + text + "' is not a number or a range A-B of numbers of 32 bits";
}

int failed(const LiveError& error) { return complain(error.sentence, error.code); }

void put(const nlohmann::json& json) { std::puts(json_text(json, 1).c_str()); }

int print_devices(const LssOptions& options, const std::vector<LssAddress>& devices) {
  nlohmann::json list = nlohmann::json::array();
  for (const LssAddress& device : devices) {
    list.push_back(device_json(device));
    if (!options.access.live.json) std::puts(device_text(device).c_str());
  }
  if (options.access.live.json) put({{"devices", list}});
  return devices.empty() ? 1 : 0;
}

/// Returns true if each number is the lowest possible one: every question of the scan was answered.
bool all_answered(const LssOptions& options, const LssAddress& found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] != lss_number(options.parts[i]).value_or(0)) return false;
  }
  return true;
}

/// Some devices also answer a scan in configuration state, and they answer every question.
constexpr const char* answers_everything =
    "the device that was found answers every further question, but only devices in waiting state "
    "should. There may be more devices: give this one a node id (takt lss set-id), then search "
    "again";

/// Finds devices without node-ID with Fastscan, one after the other. A found device stays in
/// configuration state until the end, so that it does not answer the next scan. Devices that were
/// left in configuration state before are first switched back to waiting state.
int find(const LssOptions& options) {
  auto access = LssAccess::open(options.access);
  if (!access) return failed(access.error());
  std::vector<LssAddress> devices;
  std::string trouble;
  while (trouble.empty() && devices.size() < 127) {
    const std::array<LssCommand, 2> scan{LssCommand{.op = LssOp::switch_global},
                                         fast_scan(options)};
    const auto results = access->run(std::span{scan}.subspan(devices.empty() ? 0 : 1));
    if (!results) return failed(results.error());
    const LssResult& result = results->back();
    if (result.outcome != LssOutcome::done) {
      if (devices.empty() || result.outcome == LssOutcome::lost) trouble = lss_failure_text(result);
      break;
    }
    if (std::ranges::find(devices, result.numbers) != devices.end()) break;
    if (!devices.empty() && all_answered(options, result.numbers)) {
      std::fprintf(stderr, "takt: note: %s\n", answers_everything);
      break;
    }
    devices.push_back(result.numbers);
    if (options.first) break;
  }
  const LssCommand leave{.op = LssOp::switch_global};
  if (const auto left = access->run({&leave, 1}); !left) return failed(left.error());
  const int code = print_devices(options, devices);
  return trouble.empty() ? code : complain(trouble, 1);
}

LssCommand slow_scan(std::uint32_t vendor, std::uint32_t product, LssRange revisions,
                     LssRange serials) {
  return {.op = LssOp::slow_scan,
          .numbers = {vendor, product, revisions.from, revisions.to, serials.from, serials.to}};
}

/// Finds all devices of a product. After each found device, it scans the higher serial numbers of
/// the same revision, then the higher revisions.
int scan(const LssOptions& options) {
  const auto revisions = lss_range(options.parts[2]);
  const auto serials = lss_range(options.parts[3]);
  const auto vendor = lss_number(options.parts[0]);
  const auto product = lss_number(options.parts[1]);
  if (!vendor || !product || !revisions || !serials) return complain("a number is missing", 2);
  auto access = LssAccess::open(options.access);
  if (!access) return failed(access.error());
  std::vector<LssAddress> devices;
  std::vector<std::pair<LssRange, LssRange>> ranges{{*revisions, *serials}};
  while (!ranges.empty() && devices.size() < 127) {
    const auto [in_revisions, in_serials] = ranges.back();
    ranges.pop_back();
    const LssCommand command = slow_scan(*vendor, *product, in_revisions, in_serials);
    const auto results = access->run({&command, 1});
    if (!results) return failed(results.error());
    const LssResult& result = results->back();
    if (result.outcome == LssOutcome::nobody) continue;
    if (result.outcome != LssOutcome::done) return complain(lss_failure_text(result), 1);
    devices.push_back(result.numbers);
    const auto [own_vendor, own_product, revision, serial] = result.numbers;
    if (revision < in_revisions.to) ranges.push_back({{revision + 1, in_revisions.to}, *serials});
    if (serial < in_serials.to) {
      ranges.push_back({{revision, revision}, {serial + 1, in_serials.to}});
    }
  }
  const int code = print_devices(options, devices);
  return code == 0
             ? 0
             : complain(lss_failure_text({.op = LssOp::slow_scan, .outcome = LssOutcome::nobody}),
                        1);
}

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

int set_id(const LssOptions& options) {
  auto access = LssAccess::open(options.access);
  if (!access) return failed(access.error());
  std::vector<LssCommand> commands{
      {.op = LssOp::configure_node_id, .a = static_cast<std::uint8_t>(options.node_id)}};
  if (options.store) commands.push_back({.op = LssOp::store});
  const auto results = configure(options, *access, commands);
  if (!results) return failed(results.error());
  const auto device = device_of(options, results->front());
  if (options.access.live.json) {
    put({{"node_id", options.node_id},
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

/// Activates the new bit rate in the devices and then on the interface. The interface goes down
/// only after the command has been sent, because going down discards its transmit queue.
int activate(const LssOptions& options, LssAccess& access) {
  using std::chrono::milliseconds;
  auto witness = FrameWitness::open(options.access.bus);
  if (!witness) return complain(witness.error().message, 3);
  const std::array<LssCommand, 2> commands{
      LssCommand{.op = LssOp::switch_global, .a = 1},
      LssCommand{.op = LssOp::activate_bit_timing,
                 .numbers = {static_cast<std::uint32_t>(options.delay_ms)}}};
  const auto results = access.run(commands);
  if (!results) return failed(results.error());
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
  if (!again) return failed(again.error());
  const LssCommand leave{.op = LssOp::switch_global};
  if (const auto left = again->run({&leave, 1}); !left) return failed(left.error());
  std::printf("the bus runs at %d kbit/s\n", options.kbit);
  return 0;
}

int set_bitrate(const LssOptions& options) {
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
  if (!access) return failed(access.error());
  std::vector<LssCommand> commands{{.op = LssOp::configure_bit_timing, .a = 0, .b = *entry}};
  if (options.store) commands.push_back({.op = LssOp::store});
  const auto results = configure(options, *access, commands);
  if (!results) return failed(results.error());
  const auto device = device_of(options, results->front());
  if (options.access.live.json) {
    put({{"kbit", options.kbit},
         {"stored", options.store},
         {"device", device ? device_json(*device) : nlohmann::json{}}});
  } else {
    if (device) std::puts(device_text(*device).c_str());
    std::printf("%d kbit/s configured%s%s\n", options.kbit, options.store ? ", stored" : "",
                options.delay_ms != 0 ? "" : "; in use from the next power-on or activation");
  }
  return options.delay_ms != 0 ? activate(options, *access) : 0;
}

int store(const LssOptions& options) {
  auto access = LssAccess::open(options.access);
  if (!access) return failed(access.error());
  const auto results = configure(options, *access, {{.op = LssOp::store}});
  return results ? 0 : failed(results.error());
}

int inquire(const LssOptions& options) {
  auto access = LssAccess::open(options.access);
  if (!access) return failed(access.error());
  const auto results = configure(options, *access,
                                 {{.op = LssOp::inquire_vendor},
                                  {.op = LssOp::inquire_product},
                                  {.op = LssOp::inquire_revision},
                                  {.op = LssOp::inquire_serial},
                                  {.op = LssOp::inquire_node_id}});
  if (!results) return failed(results.error());
  LssAddress address{};
  for (std::size_t i = 0; i < 4; ++i) address[i] = (*results)[1 + i].numbers[0];
  const std::uint32_t id = (*results)[5].numbers[0];
  if (options.access.live.json) {
    nlohmann::json json = device_json(address);
    json["node_id"] = id == lss::no_node_id ? nlohmann::json{} : nlohmann::json(id);
    put(json);
  } else {
    std::printf("%s  node id %s\n", device_text(address).c_str(),
                id == lss::no_node_id ? "none" : std::to_string(id).c_str());
  }
  return 0;
}

/// Runs one service that only succeeds or fails.
int run_one(const LssOptions& options, const LssCommand& command) {
  auto access = LssAccess::open(options.access);
  if (!access) return failed(access.error());
  const auto results = access->run({&command, 1});
  if (!results) return failed(results.error());
  const LssResult& result = results->back();
  return result.outcome == LssOutcome::done ? 0 : complain(lss_failure_text(result), 1);
}

int switch_state(const LssOptions& options) {
  return run_one(options, {.op = LssOp::switch_global,
                           .a = static_cast<std::uint8_t>(options.state == "config" ? 1 : 0)});
}

int unconfigured(const LssOptions& options) {
  const int code = run_one(options, {.op = LssOp::identify_unconfigured});
  if (code == 0) std::puts("yes: at least one device has no node id");
  return code;
}

enum class Takes : std::uint8_t { nothing, numbers, one_device, ranges };

using Run = int (*)(const LssOptions&);

void add_identity(CLI::App& verb, LssOptions& options, Takes takes) {
  const auto check = [takes](std::size_t part) {
    return takes == Takes::ranges && part >= 2 ? check_range : check_number;
  };
  constexpr std::array<const char*, 4> flags{"--vendor", "--product", "--revision", "--serial"};
  for (std::size_t i = 0; i < flags.size(); ++i) {
    const bool has_range = takes == Takes::ranges && i >= 2;
    auto* option = verb.add_option(flags[i], options.parts[i],
                                   has_range ? "one, or a range A-B" : "of the LSS address (1018)");
    option->check(check(i))->type_name(has_range ? "N|A-B" : "N");
    if (takes == Takes::ranges && i < 2) option->required();
  }
  if (takes != Takes::one_device) return;
  verb.add_flag("--alone", options.alone, "the only device on the bus, whatever its address");
}

CLI::App* add_verb(CLI::App& lss, const char* name, const char* text, Takes takes,
                   const std::shared_ptr<LssOptions>& options) {
  auto* verb = lss.add_subcommand(name, text);
  if (takes != Takes::nothing) add_identity(*verb, *options, takes);
  add_bus(*verb, options->access.bus, "use can0 or unix:PATH directly, not a daemon")
      ->type_name("IFACE");
  add_number(*verb, "--timeout", options->access.timeout_ms,
             "wait per answer, ms; default 100 in scans, 5000 to store, else 1000")
      ->check(CLI::Range(1, 60000))
      ->type_name("MS");
  add_live_options(*verb, options->access.live);
  return verb;
}

void run_as(CLI::App* verb, const std::shared_ptr<LssOptions>& options, Run run, int& exit_code) {
  verb->callback([options, run, &exit_code] { exit_code = run(*options); });
}

void add_searches(CLI::App& lss, int& exit_code) {
  const auto options = std::make_shared<LssOptions>();
  auto* find_verb = add_verb(lss, "find", "lists the devices without node id (fastscan)",
                             Takes::numbers, options);
  find_verb->add_flag("--first", options->first, "end after the first device");
  run_as(find_verb, options, find, exit_code);
  const auto scanned = std::make_shared<LssOptions>();
  run_as(add_verb(lss, "scan", "lists all devices of a product, also those with a node id",
                  Takes::ranges, scanned),
         scanned, scan, exit_code);
  const auto asked = std::make_shared<LssOptions>();
  run_as(add_verb(lss, "unconfigured", "tests for a missing node id", Takes::nothing, asked), asked,
         unconfigured, exit_code);
  const auto inquired = std::make_shared<LssOptions>();
  run_as(add_verb(lss, "inquire", "prints the LSS address and the node id of one device",
                  Takes::one_device, inquired),
         inquired, inquire, exit_code);
}

void add_settings(CLI::App& lss, int& exit_code) {
  const auto id = std::make_shared<LssOptions>();
  auto* id_verb = add_verb(lss, "set-id", "gives one device a node id", Takes::one_device, id);
  add_number(*id_verb, "ID", id->node_id, "1..127; 255 removes the node id")
      ->required()
      ->check([](const std::string& text) {
        const auto value = lss_number(text);
        const bool good = value && ((*value >= 1 && *value <= 127) || *value == 255);
        return good ? "" : "'" + text + "' is not a node id 1..127, or 255 for none";
      });
  id_verb->add_flag("--store", id->store, "let the device store the node id");
  run_as(id_verb, id, set_id, exit_code);

  const auto rate = std::make_shared<LssOptions>();
  auto* rate_verb =
      add_verb(lss, "set-bitrate", "configures another bit rate", Takes::one_device, rate);
  add_number(*rate_verb, "KBIT", rate->kbit, "1000, 800, 500, 250, 125, 50, 20, 10")->required();
  rate_verb->add_flag("--all", rate->all, "configure every device of the bus");
  rate_verb->add_flag("--store", rate->store, "let the devices store the bit rate");
  add_number(*rate_verb, "--activate", rate->delay_ms,
             "switch bus and interface now; the bus is silent for twice this, ms")
      ->check(CLI::Range(100, 60000))
      ->type_name("MS");
  run_as(rate_verb, rate, set_bitrate, exit_code);

  const auto stored = std::make_shared<LssOptions>();
  run_as(add_verb(lss, "store", "lets one device store its settings", Takes::one_device, stored),
         stored, store, exit_code);
  const auto state = std::make_shared<LssOptions>();
  auto* state_verb = add_verb(lss, "switch", "switches all devices", Takes::nothing, state);
  state_verb->add_option("STATE", state->state, "config or waiting")
      ->required()
      ->check(one_of({"config", "waiting"}));
  run_as(state_verb, state, switch_state, exit_code);
}

}  // namespace

void add_lss(CLI::App& app, int& exit_code) {
  auto* lss = app.add_subcommand("lss", "sets node ids and bit rates over the bus (CiA 305)");
  lss->require_subcommand(1);
  lss->footer(
      "takt addresses the device with all four numbers of the LSS address (1018:1-4), or the only\n"
      "device without node id that has the given numbers, or with --alone the only device.\n"
      "Devices with a node id should be in Stopped or pre-operational (takt nmt stop).\n"
      "Examples:\n  takt lss find --bus can0\n  takt lss set-id 5 --store\n"
      "  takt lss set-id 6 --vendor 0x15A --product 2 --revision 3 --serial 17 --store\n"
      "  takt lss set-bitrate 500 --all --store --activate 1000 --bus can0");
  add_searches(*lss, exit_code);
  add_settings(*lss, exit_code);
}

}  // namespace takt
