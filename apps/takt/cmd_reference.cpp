#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/known_words.hpp"
#include "eds_parser/network_file/key_reference.hpp"

namespace takt {

void add_reference(CLI::App& app, int& exit_code) {
  auto topic = std::make_shared<std::string>();
  auto* command =
      app.add_subcommand("reference", "prints all keys of a network file or of a device data file");
  command->add_option("TOPIC", *topic, "network-file or device-data")
      ->required()
      ->check(one_of({"network-file", "device-data"}));
  command->footer(
      "Each table, in Markdown, lists the keys of one map: the values that takt accepts, the\n"
      "default and the meaning. *takt* marks keys that a bus.yml of ros2_canopen or of Lely's\n"
      "dcfgen does not have.\n\n"
      "Example:\n"
      "  takt reference network-file | less");
  command->callback([topic, &exit_code] {
    std::cout << key_reference(*topic == "network-file" ? network_file_keys() : device_data_keys());
    exit_code = 0;
  });
}

}  // namespace takt
