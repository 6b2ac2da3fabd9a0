#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <string>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/service/lss_verbs.hpp"

namespace takt {
namespace {

std::string check_number(const std::string& text) {
  return lss_number(text) ? "" : "'" + text + "' is not a number of 32 bits (decimal, or 0x hex)";
}

std::string check_range(const std::string& text) {
  return lss_range(text) ? ""
                         : "'" + text + "' is not a number or a range A-B of numbers of 32 bits";
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
  run_as(find_verb, options, lss_find, exit_code);
  const auto scanned = std::make_shared<LssOptions>();
  run_as(add_verb(lss, "scan", "lists all devices of a product, also those with a node id",
                  Takes::ranges, scanned),
         scanned, lss_scan, exit_code);
  const auto asked = std::make_shared<LssOptions>();
  run_as(add_verb(lss, "unconfigured", "tests for a missing node id", Takes::nothing, asked), asked,
         lss_unconfigured, exit_code);
  const auto inquired = std::make_shared<LssOptions>();
  run_as(add_verb(lss, "inquire", "prints the LSS address and the node id of one device",
                  Takes::one_device, inquired),
         inquired, lss_inquire, exit_code);
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
  run_as(id_verb, id, lss_set_id, exit_code);

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
  run_as(rate_verb, rate, lss_set_bitrate, exit_code);

  const auto stored = std::make_shared<LssOptions>();
  run_as(add_verb(lss, "store", "lets one device store its settings", Takes::one_device, stored),
         stored, lss_store, exit_code);
  const auto state = std::make_shared<LssOptions>();
  auto* state_verb = add_verb(lss, "switch", "switches all devices", Takes::nothing, state);
  state_verb->add_option("STATE", state->state, "config or waiting")
      ->required()
      ->check(one_of({"config", "waiting"}));
  run_as(state_verb, state, lss_switch, exit_code);
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
