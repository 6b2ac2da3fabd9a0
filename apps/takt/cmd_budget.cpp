#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <fstream>
#include <iostream>
#include <iterator>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/duration.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/help_text.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "eds_parser/budget/traffic.hpp"
#include "eds_parser/network_file/changed_network.hpp"
#include "eds_parser/print/print_budget.hpp"

namespace takt {
namespace {

struct BudgetArguments {
  std::string file;
  std::vector<std::string> what_if;
  std::string device_time = "30us";
  std::string errors;
  std::string svg;
  bool timeline = false;
  bool json = false;
};

/// Returns true for the finding that the budget reports itself, as BusBudget::refused.
bool is_too_full(const Finding& finding) { return finding.rule == "does-not-fit"; }

bool write_svg(const std::string& path, const BusPlan& plan, const BusBudget& budget) {
  std::ofstream file{path};
  print_budget_svg(file, plan, budget);
  file.close();
  return file.good();
}

int report(const BudgetArguments& options, const LoadedNetwork& network, const WhatIf& changes,
           const BudgetOptions& how) {
  const BusPlan& plan = network.plan;
  BusBudget budget = bus_budget(plan, how);
  std::ranges::copy(left_out_tpdos(network.findings), std::back_inserter(budget.assumptions));
  if (!options.svg.empty() && !write_svg(options.svg, plan, budget)) {
    return complain("can't write " + options.svg, exit_wrong_use);
  }
  const bool fits = budget.fits();
  std::vector<Suggestion> suggestions;
  if (!fits) {
    suggestions = cheapest_changes(plan, changes, how, [&](const WhatIf& other) {
      auto changed = load_changed_network(options.file, other);
      return has_error(changed.findings) ? std::nullopt : std::optional{std::move(changed.plan)};
    });
  }
  if (options.json) {
    print_budget_json(std::cout, plan, budget, suggestions);
  } else {
    print_budget_text(std::cout, plan, budget);
    if (!fits) print_suggestions(std::cout, suggestions);
    if (options.timeline) print_budget_timeline(std::cout, plan, budget, text_width());
  }
  return fits ? 0 : 1;
}

/// Returns the values that the key of a change accepts. Empty if there is no such key.
std::string values_of(std::string_view key) {
  if (key == "period") return "a whole number of us, ms or s from 200us to 60s";
  if (key == "bitrate") return "10, 20, 50, 100, 125, 250, 500, 800 or 1000 (kbit/s)";
  if (key == "services") return "1 to 250 frames a cycle";
  if (key == "counter") return "0 (none) or 2 to 240";
  const bool tpdo = key.find(".tpdo") != std::string_view::npos;
  if (!tpdo && key.find(".rpdo") == std::string_view::npos) return {};
  if (key.ends_with(".start")) return "0 to 240, the SYNC counter of the first transmission";
  if (key.ends_with(".inhibit"))
    return "a whole number of us or ms in steps of 100us, up to 6553ms";
  if (key.ends_with(".cob_id")) return "a COB-ID such as 0x1C0";
  if (!std::isdigit(static_cast<unsigned char>(key.back()))) return {};
  return std::string{"a transmission type, 0 to 240"} + (tpdo ? " or 252 to 255" : ", 254 or 255") +
         ", or `off`; PDO numbers are 1 to 512";
}

std::string guess_of_key(const std::string& key) {
  const std::string best = guess(key, {"period", "bitrate", "services", "counter"});
  if (!best.empty() || key.find('.') == key.npos) return best;
  const std::string last = key.substr(key.rfind('.') + 1);
  return guess(last, {"start", "inhibit", "cob_id"});
}

int wrong_change(const std::string& text) {
  const std::string key = text.substr(0, text.find('='));
  const std::string values = values_of(key);
  return complain(
      "--what-if " + text + (values.empty() ? guess_of_key(key) : std::string{}) +
          (values.empty()
               ? ": expected a change such as period=1ms, bitrate=500, services=2, counter=60, "
                 "arm.tpdo2=10 (transmission), arm.tpdo2=off, "
                 "arm.tpdo2.start=2, arm.tpdo2.inhibit=10ms, "
                 "arm.tpdo2.cob_id=0x1C0"
               : ": expected " + values),
      exit_wrong_use);
}

int run(const BudgetArguments& options) {
  WhatIf changes;
  for (const auto& text : options.what_if) {
    if (!add_change(text, changes)) return wrong_change(text);
  }
  const auto device_time = parse_duration(options.device_time);
  if (!device_time) {
    return complain("--device-time " + options.device_time + ": expected a time such as 200us",
                    exit_wrong_use);
  }
  BudgetOptions how{.device_time = *device_time};
  if (!options.errors.empty()) {
    const auto interval = parse_duration(options.errors);
    if (!interval || *interval == Time{0}) {
      return complain("--errors " + options.errors + ": expected a time such as 10ms",
                      exit_wrong_use);
    }
    how.errors = {.burst = 1, .interval = *interval};
  }
  const auto network = load_changed_network(options.file, changes);
  Findings findings = network.findings;
  std::erase_if(findings, is_too_full);
  const bool bad = print_findings(findings, Severity::warning);
  return bad ? exit_wrong_use : report(options, network, changes, how);
}

}  // namespace

void add_budget(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<BudgetArguments>(
      app, exit_code, "budget", "checks whether the frames of a network fit its bus", run);
  verb.add_option("NET", options.file, "network file")->required();
  verb.add_option("--what-if", options.what_if,
                  "compute with period=1ms, bitrate=500, arm.tpdo2=10 ... instead")
      ->delimiter(',');
  verb.add_option("--device-time", options.device_time,
                  "time from SYNC until a device has its TPDO ready for the bus")
      ->type_name("TIME")
      ->capture_default_str();
  verb.add_option("--errors", options.errors,
                  "assume one error on the wire in each interval of this length")
      ->type_name("TIME");
  verb.add_flag("--timeline", options.timeline, "also print a picture of one cycle");
  verb.add_option("--svg", options.svg, "write that picture as an SVG file")->type_name("FILE");
  verb.add_flag("--json", options.json, "print one JSON document");
  verb.footer(
      "takt assumes the worst bit stuffing and the worst order of the frames, and that each frame\n"
      "comes as often as it may.\n"
      "Exit code 1: a frame can be too late. takt then also prints the cheapest changes that\n"
      "help.\n\n"
      "Examples:\n"
      "  takt budget lift.yaml --timeline\n"
      "  takt budget lift.yaml --what-if period=1ms,bitrate=500");
}

}  // namespace takt
