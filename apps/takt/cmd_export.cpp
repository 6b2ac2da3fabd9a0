#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <sstream>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/text_file.hpp"
#include "eds_parser/export/export.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/print/plan/print_plan.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string file;
  std::string folder;
  bool whole_words = false;
};

/// The files that one export writes: name and content of each.
using Exported = std::vector<std::pair<std::string, std::string>>;
using Export = Exported (*)(const LoadedNetwork& network, const ExportOptions& options);

Exported as_dbc(const LoadedNetwork& network, const ExportOptions& options) {
  return {{network.plan.name + ".dbc", to_dbc(network.plan, {.word_bits = !options.whole_words})}};
}

Exported as_header(const LoadedNetwork& network, const ExportOptions&) {
  return {{network.plan.name + ".hpp", to_cpp_header(network.plan)}};
}

Exported as_lcm(const LoadedNetwork& network, const ExportOptions&) {
  Exported files;
  for (const TypedMessage& message : typed_messages(network.plan)) {
    files.emplace_back(message.package + '_' + message.name + ".lcm",
                       to_lcm(message, network.plan));
  }
  return files;
}

Exported as_json(const LoadedNetwork& network, const ExportOptions&) {
  std::ostringstream text;
  print_plan_json(text, network.plan,
                  {.node = {}, .realtime = network.realtime, .lcm = network.lcm});
  return {{network.plan.name + ".json", std::move(text).str()}};
}

int run(const ExportOptions& options, Export make) {
  const LoadedNetwork network = load_network(options.file);
  if (print_findings(network.findings, Severity::warning)) return 2;
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error) return complain(options.folder + ": " + error.message(), 1);
  for (const auto& [name, content] : make(network, options)) {
    const auto path = fs::path{options.folder} / name;
    value_or_fail(write_whole_file(path, content), 1);
    std::cout << path.string() << '\n';
  }
  return 0;
}

CLI::App* add(CLI::App& verb, const std::shared_ptr<ExportOptions>& options, int& exit_code,
              const std::string& name, const std::string& what, Export make) {
  auto* command = verb.add_subcommand(name, what);
  command->add_option("NET", options->file, "network file")->required();
  command->add_option("-o,--output", options->folder, "folder for the files")
      ->type_name("DIR")
      ->required();
  command->callback([options, make, &exit_code] { exit_code = run(*options, make); });
  return command;
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  auto* verb = app.add_subcommand("export", "writes the plan of a network for other tools");
  verb->require_subcommand(1);
  verb->footer(
      "takt export prints the names of the files that it wrote.\n\n"
      "Example:\n  takt export dbc lift.yaml -o out");
  auto options = std::make_shared<ExportOptions>();
  add(*verb, options, exit_code, "dbc", "writes the frames of the bus as a DBC for CAN tools",
      as_dbc)
      ->add_flag("--whole-words", options->whole_words,
                 "write statuswords and controlwords as one value, not as bits");
  add(*verb, options, exit_code, "header", "writes the positions in the image as a C++ header",
      as_header);
  add(*verb, options, exit_code, "lcm",
      "writes typed LCM messages for the inputs and outputs of each node", as_lcm);
  add(*verb, options, exit_code, "json", "writes the document of `takt plan --json`", as_json);
}

}  // namespace takt
