#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/import/import_report.hpp"
#include "apps/takt/import/nodelist.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

struct ImportOptions {
  std::string file;
  std::string out;
  unsigned network = 1;
  bool json = false;
  bool brief = false;
};

/// Returns true if the file is a nodelist. CiA 306-3 leaves the name free, so only the extension
/// identifies it.
bool is_nodelist(const ImportOptions& options) {
  const auto ending = std::filesystem::path{options.file}.extension().string();
  return ending == ".cpj" || ending == ".CPJ";
}

void print_json(const ImportOptions& options, const ImportReport& report) {
  nlohmann::ordered_json keys = nlohmann::ordered_json::array();
  for (const ImportedKey& key : report.keys) {
    keys.push_back({{"key", key.path},
                    {"value", key.value},
                    {"line", key.pos.line},
                    {"column", key.pos.column},
                    {"fate", name(key.use)},
                    {"why", key.why}});
  }
  nlohmann::ordered_json others = nlohmann::ordered_json::array();
  for (const Finding& finding : report.others) {
    others.push_back({{"file", finding.file},
                      {"line", finding.pos.line},
                      {"column", finding.pos.column},
                      {"severity", name(finding.severity)},
                      {"rule", finding.rule},
                      {"message", finding.message}});
  }
  const nlohmann::ordered_json document{{"file", options.file},
                                        {"usable", report.usable},
                                        {"keys", std::move(keys)},
                                        {"unasked", report.unasked},
                                        {"findings", std::move(others)}};
  fmt::print("{}\n", json_text(document, 2));
}

struct Imported {
  ImportReport report;
  bool written = false;  ///< the network file of a nodelist was written
};

/// Returns the last line of the report: the result for a nodelist.
std::string last_line(const ImportOptions& options, const Imported& imported) {
  if (!imported.report.usable) {
    return imported.written ? options.out +
                                  " was written, but taktd does not accept it: correct the errors "
                                  "above."
                            : "takt can't make a network file of it: correct the errors above.";
  }
  return imported.written ? options.out + " was written; `takt plan` shows what taktd does with it."
                          : "`-o NET.yaml` writes the network file.";
}

void print_text(const ImportOptions& options, const Imported& imported) {
  const ImportReport& report = imported.report;
  fmt::print("{}: {} keys: {} used, {} ignored, {} suspicious, {} wrong\n", options.file,
             report.keys.size(), report.count(KeyUse::used), report.count(KeyUse::ignored),
             report.count(KeyUse::suspicious), report.count(KeyUse::wrong));
  for (const ImportedKey& key : report.keys) {
    if (options.brief && key.use == KeyUse::used) continue;
    const std::string what = key.value.empty() ? key.path : key.path + ": " + key.value;
    const std::string place = fmt::format("{}:{}", key.pos.line, key.pos.column);
    fmt::print("{:>7}  {:<10}  {:<52}  {}\n", place, name(key.use), printable_text(what),
               printable_text(key.why));
  }
  if (!report.unasked.empty())
    fmt::print("taktd also sets these values, which the file does not mention:\n");
  for (const std::string& line : report.unasked) fmt::print("  {}\n", line);
  for (const Finding& finding : report.others) {
    fmt::print("{}\n", finding_text(finding));
  }
  if (is_nodelist(options)) {
    fmt::print("{}\n", last_line(options, imported));
    return;
  }
  fmt::print("{}\n", report.usable
                         ? "taktd runs this file as it is; `takt plan` shows what taktd does."
                         : "taktd does not accept this file: correct the errors above.");
}

/// Imports a nodelist and, if requested, writes the network file. The report then includes the
/// findings about the network file.
Imported import_project(const ImportOptions& options) {
  const std::filesystem::path out{options.out};
  auto imported = import_nodelist(
      options.file, options.network,
      options.out.empty() ? std::filesystem::path{options.file}.parent_path() : out.parent_path());
  if (options.out.empty() || !imported.report.usable) return {std::move(imported.report)};
  std::ofstream file{out};
  file << imported.yaml;
  file.close();
  const bool written = file.good();
  Findings findings;
  if (written) {
    findings = load_network(out).findings;
  } else {
    findings.push_back({options.out, {}, Severity::error, "no-file", "can't be written"});
  }
  imported.report.usable = !has_error(findings);
  std::ranges::move(findings, std::back_inserter(imported.report.others));
  return {std::move(imported.report), written};
}

int run(const ImportOptions& options) {
  if (!is_nodelist(options) && !options.out.empty()) {
    return complain("-o is for a nodelist.cpj: taktd runs a bus.yml as it is", 2);
  }
  const Imported imported =
      is_nodelist(options) ? import_project(options) : Imported{import_report(options.file)};
  if (options.json) {
    print_json(options, imported.report);
  } else {
    print_text(options, imported);
  }
  if (imported.report.usable) return 0;
  return imported.report.keys.empty() ? 2 : 1;  // no keys means that the file could not be read
}

}  // namespace

void add_import(CLI::App& app, int& exit_code) {
  auto [command, options] = add_command<ImportOptions>(
      app, exit_code, "import", "shows how takt reads a bus.yml; converts a nodelist.cpj", run);
  command
      .add_option("FILE", options.file,
                  "bus.yml of dcfgen or ros2_canopen, or nodelist.cpj of CiA 306-3")
      ->required();
  command.add_option("-o,--output", options.out, "network file to write from a nodelist.cpj");
  add_number(command, "--network", options.network, "network of a nodelist.cpj: 2 for [Topology2]")
      ->check(CLI::Range(1U, 99U))
      ->capture_default_str();
  command.add_flag("--json", options.json, "print one JSON document");
  command.add_flag("--brief", options.brief, "leave out keys that takt uses unchanged");
  command.footer(
      "A bus.yml needs no conversion: taktd and all commands read it as it is. A nodelist.cpj\n"
      "with its DCFs becomes a network file (-o): nodes, names, device files, bit rate. takt\n"
      "reports each key as used, ignored (with the reason), suspicious (used, but hardly what\n"
      "was meant) or wrong (taktd can't run the file; exit code 1). If the file can't be read,\n"
      "the exit code is 2.\n\n"
      "Examples:\n"
      "  takt import bus.yml --brief\n"
      "  takt import nodelist.cpj -o lift.yaml");
}

}  // namespace takt
