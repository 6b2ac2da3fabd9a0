#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <thread>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/duration.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/simulate/device_channel.hpp"
#include "apps/takt/simulate/fault_file.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/sim/bus/realtime_world.hpp"

namespace takt {
namespace {

struct SimArguments {
  std::string network;
  std::string bus;
  std::vector<std::string> only;
  std::string run_for;
  std::string faults;
  std::uint64_t seed = 1;
};

/// Returns all devices, or those that `--only` names. Throws a Failure if a name is unknown.
std::vector<DeviceTable> chosen(const LoadedNetwork& network, const SimArguments& arguments) {
  if (arguments.only.empty()) return network.devices;
  std::vector<DeviceTable> devices;
  for (const std::string& wanted : arguments.only) {
    const auto found = std::ranges::find_if(network.devices, [&](const DeviceTable& device) {
      return device.name == wanted || std::to_string(device.node.value()) == wanted;
    });
    if (found == network.devices.end()) {
      std::string sentence = "no node `" + wanted + "` in " + arguments.network + "; there are";
      for (const DeviceTable& device : network.devices) sentence += ' ' + device.name;
      throw Failure{sentence, 2};
    }
    devices.push_back(*found);
  }
  return devices;
}

/// Runs the devices until SIGINT, SIGTERM, the time limit or a failure of the bus.
int run_world(sim::RealtimeWorld& world, std::optional<Time> limit) {
  const Interrupt interrupt;
  world.start();
  const auto start = std::chrono::steady_clock::now();
  while (!Interrupt::asked() && !world.failed()) {
    if (limit && std::chrono::steady_clock::now() - start >= *limit) break;
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  const bool failed = world.failed();
  world.stop();
  return failed ? 3 : 0;
}

int run(const SimArguments& arguments) {
  const LoadedNetwork network = load_network(arguments.network);
  if (print_findings(network.findings)) return 2;
  const std::vector<DeviceTable> devices = chosen(network, arguments);
  if (devices.empty()) throw Failure{arguments.network + " has no nodes", 2};
  // It is not known here whether the interface follows a change of the bit rate.
  sim::WorldOptions options{
      .seed = arguments.seed, .bitrate = network.plan.bitrate, .one_bit_rate = false};
  if (!arguments.faults.empty()) {
    FaultFile file = read_fault_file(arguments.faults, network.plan);
    if (print_findings(file.findings)) return 2;
    options.faults = std::move(file.faults);
  }
  const std::string bus = arguments.bus.empty() ? network.plan.interface : arguments.bus;
  if (bus.empty()) {
    throw Failure{"the network file names no interface; give one: --bus vcan0", 2};
  }
  DeviceChannel channel{value_or_fail(takt::FrameChannel::open(bus), 3)};
  sim::RealtimeWorld world{devices, options, channel};
  std::cerr << "takt sim: " << devices.size() << " devices on " << bus << '\n';
  return run_world(world, parse_duration(arguments.run_for));
}

}  // namespace

void add_sim(CLI::App& app, int& exit_code) {
  auto [command, arguments] = add_command<SimArguments>(
      app, exit_code, "sim", "simulates devices on a CAN interface in real time", run);
  command.add_option("NET.yaml", arguments.network, "network file")->required();
  add_bus(command, arguments.bus, "vcan0, can0 or unix:PATH");
  command.add_option("--only", arguments.only, "simulate only these nodes, by name or number")
      ->delimiter(',');
  command.add_option("--for", arguments.run_for, "end after this time; default: run until SIGINT")
      ->check(duration_error);
  command.add_option("--faults", arguments.faults, "file that lists faults and their times (YAML)");
  add_number(command, "--seed", arguments.seed, "seed of the random parts")->capture_default_str();
  command.footer("Example:\n  takt sim lift.yaml --bus vcan0 --only shoulder,elbow");
}

}  // namespace takt
