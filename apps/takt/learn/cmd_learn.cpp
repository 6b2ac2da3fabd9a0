#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/text_file.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/learn/network_text.hpp"
#include "apps/takt/learn/recording.hpp"
#include "eds_parser/network_file/keys/read_devices.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {
namespace learn {
namespace {

namespace fs = std::filesystem;

struct LearnArguments {
  std::string log;
  std::string out;
  std::vector<std::string> files;
  std::vector<std::string> folders;
  std::string interface;
  std::uint32_t bitrate_kbit = 1000;
  bool quiet = false;
};

std::optional<LearnedBus> listen(const LearnArguments& options) {
  if (options.log == "-") return read_recording(std::cin, "stdin", options.interface);
  std::ifstream file{options.log, std::ios::binary};
  std::error_code ignored;
  if (!file || fs::is_directory(options.log, ignored)) return {};
  return read_recording(file, options.log, options.interface);
}

int run(const LearnArguments& options) {
  DeviceFiles files;
  Findings findings;
  bool good = true;
  for (const std::string& folder : options.folders) files.add_folder(folder, findings);
  for (const std::string& file : options.files) good = files.add_argument(file, findings) && good;
  const Severity least = options.quiet ? Severity::warning : Severity::note;
  if (print_findings(findings, least) || !good) return 2;
  const auto bus = listen(options);
  if (!bus) return complain(options.log + ": can't be read", 2);
  if (bus->frames == 0 && !options.interface.empty()) {
    print_findings(bus->findings);
    return complain(options.log + ": holds no frame of interface " + options.interface, 2);
  }
  if (bus->frames == 0) {
    return complain(options.log +
                        ": holds no frame; takt reads recordings of candump, PCAN (.trc), Vector "
                        "(.asc) and python-can",
                    2);
  }

  const bool to_stdout = options.out == "-";
  const fs::path out{options.out};
  LearnOptions how{.bitrate_kbit = options.bitrate_kbit,
                   .device_data = load_device_data(device_folders(), findings)};
  if (!to_stdout) {
    how.folder = out.parent_path();
    how.stem = out.stem().string();
  }
  const LearnedNetwork network = learned_network(*bus, files, how);
  print_findings(network.findings, least);
  if (!to_stdout) {
    for (const auto& [name, content] : network.made_files) {
      value_or_fail(write_whole_file(how.folder / name, content), 1);
    }
  }
  value_or_fail(write_whole_file(options.out, network.text), 1);
  const int judged = to_stdout ? 0 : judge_written(options.out, load_network(options.out).findings);
  return has_error(network.findings) ? 1 : judged;
}

}  // namespace
}  // namespace learn

void add_learn(CLI::App& app, int& exit_code) {
  auto [command, options] = add_command<learn::LearnArguments>(
      app, exit_code, "learn", "makes a network file from a recorded boot of another master",
      learn::run);
  command
      .add_option("LOG", options.log,
                  "recording of candump (-L or plain), .trc or .asc; - for stdin")
      ->required();
  command.add_option("-o,--output", options.out, "network file to write; - for stdout")
      ->type_name("NET.yaml")
      ->required();
  command.add_option("--eds", options.files,
                     "EDS or DCF, matched by its identity; 5=FILE assigns it to node 5");
  command
      .add_option("--eds-dir", options.folders,
                  "folder with EDS and DCF files; takt searches subfolders, too")
      ->type_name("DIR");
  add_bus(command, options.interface, "use only this interface of the recording");
  add_number(command, "--bitrate", options.bitrate_kbit,
             "bit rate, kbit/s; a recording does not contain it")
      ->check(CLI::Range(10U, 1000U))
      ->capture_default_str();
  command.add_flag("--quiet", options.quiet, "leave out notes");
  command.footer(
      "Start the recording before the other master resets the devices:\n"
      "  candump -L can0 > boot.log\n"
      "The network file contains nodes, SDO writes in their order, PDOs, SYNC, heartbeats and\n"
      "guarding. Comments in it describe what a network file can't express. For a device without\n"
      "EDS takt writes an EDS from the recording, beside the network file. Exit code 1: the\n"
      "network file needs corrections, which stderr lists.\n\n"
      "Example:\n"
      "  takt learn boot.log --eds-dir vendor/ --bitrate 500 -o machine.yaml\n"
      "  takt plan machine.yaml");
}

}  // namespace takt
