#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <sstream>
#include <utility>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/whole_number.hpp"
#include "eds_parser/check/check.hpp"
#include "eds_parser/check/rule_list.hpp"
#include "eds_parser/print/findings_json.hpp"
#include "eds_parser/print/print_dictionary.hpp"
#include "eds_parser/read/eds.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

struct ShowOptions {
  std::string file;
  unsigned node = 0;
  bool json = false;
};

struct CheckOptions {
  std::vector<std::string> files;
  unsigned node = 0;
  bool quiet = false;
  bool json = false;
  bool rules = false;
};

/// Reads and checks one file. The findings of the reader and of the checks are sorted by position.
EdsFile read_and_check(const std::string& path, unsigned node) {
  auto file = read_eds_file(path, NodeId::from(node));
  if (!file.readable) return file;
  auto judged = check(file.dictionary);
  std::ranges::move(judged, std::back_inserter(file.findings));
  std::ranges::stable_sort(file.findings, {}, &Finding::pos);
  return file;
}

int show(const ShowOptions& options) {
  const auto file = read_and_check(options.file, options.node);
  if (!file.readable) {
    print_findings(file.findings);
    return 1;
  }
  if (options.json) {
    print_json(std::cout, file.dictionary, file.findings);
  } else {
    std::ostringstream text;
    print_text(text, file.dictionary);
    std::cout << printable_lines(text.str());
  }
  return 0;
}

int print_rules() {
  for (const auto& rule : eds_rules()) {
    std::cout << rule.name << " (" << name(rule.severity) << ")\n    " << rule.meaning << '\n';
    if (!rule.example.empty()) std::cout << "    e.g. " << rule.example << '\n';
  }
  return 0;
}

int check_files(const CheckOptions& options) {
  if (options.rules) return print_rules();
  if (options.files.empty()) throw CLI::RequiredError{"FILE"};
  bool any_error = false;
  std::vector<JudgedFile> judged;
  for (const auto& path : options.files) {
    auto file = read_and_check(path, options.node);
    any_error = any_error || has_error(file.findings);
    if (options.quiet) {
      std::erase_if(file.findings,
                    [](const Finding& finding) { return finding.severity == Severity::note; });
    }
    if (options.json) {
      judged.push_back({path, file.readable, std::move(file.findings)});
    } else {
      for (const auto& finding : file.findings) std::cout << finding_text(finding) << '\n';
    }
  }
  if (options.json) print_findings_json(std::cout, judged);
  return any_error ? 1 : 0;
}

void add_show(CLI::App& eds, int& exit_code) {
  auto [command, options] = add_command<ShowOptions>(
      eds, exit_code, "show", "prints the object dictionary and the PDOs of a file", show);
  command.add_option("FILE", options.file, "EDS or DCF")->required();
  add_node_id(command, options.node, "node id that replaces $NODEID");
  command.add_flag("--json", options.json, "print one JSON document");
  command.footer("Example:\n  takt eds show --node 5 share/eds/takt_drive402.eds");
}

void add_check(CLI::App& eds, int& exit_code) {
  auto [command, options] = add_command<CheckOptions>(eds, exit_code, "check",
                                                      "lists the mistakes in files", check_files);
  auto* rules = command.add_flag("--rules", options.rules, "list the rules, with examples");
  command.add_option("FILE", options.files, "EDS or DCF")->excludes(rules);
  add_node_id(command, options.node, "node id that replaces $NODEID");
  command.add_flag("--quiet", options.quiet, "leave out notes");
  command.add_flag("--json", options.json, "print one JSON document")->excludes(rules);
  command.footer(
      "Findings are written as file:line:column: severity: message [rule].\n"
      "  error    the device would refuse it, or takt would not do what the author meant\n"
      "  warning  the file deviates from the standard, but can be read in only one way\n"
      "  note     a matter of style\n"
      "The exit code is 1 if there is an error.\n\n"
      "Example:\n"
      "  takt eds check share/eds/*.eds");
}

}  // namespace

void add_eds(CLI::App& app, int& exit_code) {
  auto* eds = app.add_subcommand("eds", "shows, checks, corrects and writes EDS and DCF files");
  eds->require_subcommand(1);
  eds->footer("Example:\n  takt eds check drive.eds\n  takt eds show --node 5 drive.eds");
  add_show(*eds, exit_code);
  add_check(*eds, exit_code);
  add_eds_dcf(*eds, exit_code);
  add_eds_cdcf(*eds, exit_code);
  add_eds_fix(*eds, exit_code);
}

}  // namespace takt
