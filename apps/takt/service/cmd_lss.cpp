#include <CLI/CLI.hpp>
#include <array>
#include <string>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/service/lss/lss_verbs.hpp"

namespace takt {
namespace {

std::string check_number(const std::string& text) {
  return parse_unsigned(text) ? ""
                              : "'" + text + "' is not a number of 32 bits (decimal, or 0x hex)";
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

/// Adds the verbs of `takt lss`.
class Verbs {
 public:
  Verbs(CLI::App& lss, int& exit_code) : lss_{lss}, exit_code_{exit_code} {}

  AddedCommand<LssOptions> add(const char* name, const char* text, Takes takes, Run run) {
    const auto added = add_command<LssOptions>(lss_, exit_code_, name, text, run);
    auto& [verb, options] = added;
    if (takes != Takes::nothing) add_identity(verb, options, takes);
    add_bus(verb, options.access.bus, "use can0 or unix:PATH directly, not a daemon")
        ->type_name("IFACE");
    add_number(verb, "--timeout", options.access.timeout_ms,
               "wait per answer, ms; default 100 in scans, 5000 to store, else 1000")
        ->check(CLI::Range(1, 60000))
        ->type_name("MS");
    add_live_options(verb, options.access.live);
    return added;
  }

 private:
  CLI::App& lss_;
  int& exit_code_;
};

void add_searches(Verbs& verbs) {
  const auto [find, options] =
      verbs.add("find", "lists the devices without node id (fastscan)", Takes::numbers, lss_find);
  find.add_flag("--first", options.first, "end after the first device");
  verbs.add("scan", "lists all devices of a product, also those with a node id", Takes::ranges,
            lss_scan);
  verbs.add("unconfigured", "tests whether a device has no node id", Takes::nothing,
            lss_unconfigured);
  verbs.add("inquire", "prints the LSS address and the node id of one device", Takes::one_device,
            lss_inquire);
}

void add_settings(Verbs& verbs) {
  const auto [id_verb, id] =
      verbs.add("set-id", "gives one device a node id", Takes::one_device, lss_set_id);
  add_number(id_verb, "ID", id.node_id, "1..127; 255 removes the node id")
      ->required()
      ->check([](const std::string& text) {
        const auto value = parse_unsigned(text);
        const bool good = value && ((*value >= 1 && *value <= 127) || *value == 255);
        return good ? "" : "'" + text + "' is not a node id 1..127, or 255 for none";
      });
  id_verb.add_flag("--store", id.store, "let the device store the node id");

  const auto [rate_verb, rate] =
      verbs.add("set-bitrate", "configures another bit rate", Takes::one_device, lss_set_bitrate);
  add_number(rate_verb, "KBIT", rate.kbit, "1000, 800, 500, 250, 125, 50, 20, 10")->required();
  rate_verb.add_flag("--all", rate.all, "configure every device of the bus");
  rate_verb.add_flag("--store", rate.store, "let the devices store the bit rate");
  add_number(rate_verb, "--activate", rate.delay_ms,
             "switch bus and interface now; the bus is silent for twice this, ms")
      ->check(CLI::Range(100, 60000))
      ->type_name("MS");

  verbs.add("store", "lets one device store its settings", Takes::one_device, lss_store);
  const auto [switch_verb, options] =
      verbs.add("switch", "switches all devices", Takes::nothing, lss_switch);
  switch_verb.add_option("STATE", options.state, "config or waiting")
      ->required()
      ->check(one_of({"config", "waiting"}));
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
  Verbs verbs{*lss, exit_code};
  add_searches(verbs);
  add_settings(verbs);
}

}  // namespace takt
