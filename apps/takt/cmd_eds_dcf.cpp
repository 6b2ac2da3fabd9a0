#include <CLI/CLI.hpp>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/text_file.hpp"
#include "apps/command_line/whole_number.hpp"
#include "eds_parser/write/dcf_writer.hpp"

namespace takt {
namespace {

struct EdsDcfOptions {
  std::string file;
  std::string out;
  unsigned node = 0;
  unsigned bitrate = 0;
  std::string name;
  std::vector<std::string> values;
};

std::optional<DcfValue> parse_value(const std::string& argument) {
  const auto equals = argument.find('=');
  if (equals == std::string::npos) return std::nullopt;
  const auto object = parse_object(std::string_view{argument}.substr(0, equals));
  if (!object) return std::nullopt;
  return DcfValue{*object, argument.substr(equals + 1)};
}

int run(const EdsDcfOptions& options) {
  DcfOptions wanted{.node = NodeId::from(options.node), .node_name = options.name};
  if (options.out != "-") wanted.out_name = options.out;
  if (options.bitrate != 0) wanted.baudrate_kbit = static_cast<std::uint16_t>(options.bitrate);
  for (const auto& argument : options.values) {
    const auto value = parse_value(argument);
    if (!value)
      return complain("--set " + argument + ": expected OBJECT=VALUE, such as 6081:00=1000", 2);
    wanted.values.push_back(*value);
  }
  const auto dcf = write_dcf(value_or_fail(read_whole_file(options.file), 1), options.file, wanted);
  if (print_findings(dcf.findings)) return 1;
  value_or_fail(write_whole_file(options.out, dcf.text), 1);
  return 0;
}

}  // namespace

void add_eds_dcf(CLI::App& eds, int& exit_code) {
  auto [command, options] =
      add_command<EdsDcfOptions>(eds, exit_code, "dcf", "writes the DCF of one device", run);
  command.add_option("FILE", options.file, "EDS or DCF to start from")->required();
  add_node_id(command, options.node, "node id of the device");
  add_number(command, "--bitrate", options.bitrate, "bit rate of the network, kbit/s")
      ->check(CLI::Range(1U, 1000U));
  command.add_option("--name", options.name, "name of the device in the network");
  command.add_option("--set", options.values,
                     "set OBJECT=VALUE; VALUE as in an EDS, for a DOMAIN @FILE");
  command.add_option("-o,--output", options.out, "output file for the DCF; - for stdout")
      ->required();
  command.footer(
      "The text of FILE stays the same byte for byte, except for the values that are set and for\n"
      "PDOs that FILE only counts (CompactPDO): the DCF lists the enabled ones. A value that the\n"
      "device would refuse is an error; takt then writes no file.\n\n"
      "Example:\n  takt eds dcf drive.eds --node 5 --set 6081:00=1000 --set 1017=100 -o axis.dcf");
}

}  // namespace takt
