#include <CLI/CLI.hpp>
#include <iostream>
#include <string>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/takt/key_schema.hpp"
#include "eds_parser/network_file/keys/key_reference.hpp"

namespace takt {

namespace {

struct ReferenceOptions {
  std::string topic;
  bool schema = false;
};

int print_reference(const ReferenceOptions& options) {
  const bool network = options.topic == "network-file";
  if (options.schema && !network) throw Failure{"only network-file has a schema", 2};
  std::cout << (options.schema ? network_schema()
                               : key_reference(network ? network_file_keys() : device_data_keys()));
  return 0;
}

}  // namespace

void add_reference(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<ReferenceOptions>(
      app, exit_code, "reference", "prints all keys of a network file or of a device data file",
      print_reference);
  verb.add_option("TOPIC", options.topic, "network-file or device-data")
      ->required()
      ->check(one_of({"network-file", "device-data"}));
  verb.add_flag("--json-schema", options.schema,
                "print the JSON schema of a network file, for editors");
  verb.footer(
      "Each table, in Markdown, lists the keys of one map: the values that takt accepts, the\n"
      "default and the meaning. *takt* marks keys that a bus.yml of ros2_canopen or of Lely's\n"
      "dcfgen does not have.\n\n"
      "Examples:\n"
      "  takt reference network-file | less\n"
      "  takt reference network-file --json-schema > network.schema.json");
}

}  // namespace takt
