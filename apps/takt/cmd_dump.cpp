#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <unistd.h>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/whole_number.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/explain/frame/error_frame_text.hpp"
#include "master/explain/frame/frame_text.hpp"
#include "master/explain/frame/frame_value_text.hpp"
#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/clock.hpp"
#include "master/trace/candump_line.hpp"
#include "master/trace/recorded_lines.hpp"
#include "master/trace/trace_line.hpp"

namespace takt {
namespace {

constexpr const char* example = R"(Examples:
  takt dump --bus can0                 prints the frames that are on the bus now
  takt dump lift.yaml --bus can0       adds names, values and units of the network file
  takt dump lift.yaml trace.log        reads a recording of `candump -L` or `candump`, .trc or .asc
  candump -L can0 | takt dump          reads frames from a pipe
  takt dump lift.yaml trace.log --node shoulder --only SDO,EMCY
Services: NMT, SYNC, TIME, EMCY, TPDO, RPDO, SDO, BOOTUP, HEARTBEAT, GUARD, LSS, MASTER, GFC, ERROR
and ? for all other frames.)";

constexpr std::array<std::string_view, 15> services{
    "NMT",       "SYNC",  "TIME", "EMCY",   "TPDO", "RPDO",  "SDO", "BOOTUP",
    "HEARTBEAT", "GUARD", "LSS",  "MASTER", "GFC",  "ERROR", "?"};

struct DumpOptions {
  std::vector<std::string> files;
  std::string bus;
  std::uint64_t count = 0;  // 0 means no limit
  bool json = false;
  std::vector<std::string> only;  // services; empty means all
  std::string node;               // node-ID or name; empty means all
};

std::string in_capitals(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// Returns an error text, or an empty string if the service exists.
std::string service_error(const std::string& text) {
  if (std::ranges::find(services, text) != services.end()) return {};
  return fmt::format("no service '{}'; there are {}", text, fmt::join(services, ", "));
}

/// Returns the node-ID that `text` gives as a number, or as the name of a node of the network.
/// Returns std::nullopt if there is no such node.
std::optional<unsigned> node_of(const std::string& text, const LoadedNetwork* network) {
  if (const auto id = parse_node_id(text)) return id->value();
  if (network == nullptr) return std::nullopt;
  for (const NodePlan& node : network->plan.nodes) {
    if (node.name == text) return node.id.value();
  }
  return std::nullopt;
}

bool is_network(const std::string& file) {
  return file.ends_with(".yaml") || file.ends_with(".yml");
}

/// Prints the frames that the options select, until it has printed as many as --count permits.
class Printer {
 public:
  /// A `node` of 0 means all nodes.
  Printer(const DumpOptions& options, unsigned node, const LoadedNetwork* network)
      : options_{options},
        node_{node},
        reader_{network == nullptr ? std::make_unique<FrameText>()
                                   : std::make_unique<FrameText>(network->plan, network->devices)} {
  }

  /// Returns false if this was the last frame to print.
  bool print(const CandumpLine& line) {
    const FrameMeaning meaning =
        line.error_frame
            ? FrameMeaning{.service = "ERROR",
                           .text = error_frame_text(line.frame.id.id(), line.frame.payload())}
            : reader_->meaning(line.frame);
    if (!wanted(meaning)) return true;
    if (options_.json) {
      print_json(line, meaning);
    } else {
      const std::string text =
          fmt::format("{:<62}  {:<9} {}", to_string(line), meaning.service, meaning.text);
      fmt::print("{}\n", printable_text(text));
    }
    return ++printed_ != options_.count;
  }

 private:
  /// Returns true if the frame is selected. An NMT command to all nodes counts for each node.
  bool wanted(const FrameMeaning& meaning) const {
    const bool to_all = meaning.service == "NMT" && meaning.node == 0;
    if (node_ != 0 && meaning.node != node_ && !to_all) return false;
    return options_.only.empty() ||
           std::ranges::find(options_.only, meaning.service) != options_.only.end();
  }

  static void print_json(const CandumpLine& line, const FrameMeaning& meaning) {
    nlohmann::ordered_json out;
    if (!line.stamp.empty()) out["time"] = line.stamp;
    out["bus"] = line.interface;
    out["id"] = line.frame.id.id();
    out["extended"] = line.frame.id.is_extended() && !line.error_frame;
    out["rtr"] = line.frame.rtr;
    out["data"] =
        bytes_text(line.frame.rtr ? std::span<const std::uint8_t>{} : line.frame.payload());
    out["service"] = meaning.service;
    if (meaning.node != 0) out["node"] = meaning.node;
    out["text"] = meaning.text;
    fmt::print("{}\n", json_text(out));
  }

  const DumpOptions& options_;
  unsigned node_;
  std::unique_ptr<FrameText> reader_;
  std::uint64_t printed_ = 0;
};

void dump_log(std::istream& in, const std::string& name, Printer& printer) {
  std::string text;
  std::uint64_t line_number = 0;
  std::uint64_t frames = 0;
  std::uint64_t strange = 0;
  RecordedLines lines;
  while (std::getline(in, text)) {
    ++line_number;
    if (const auto line = lines.parse(text)) {
      ++frames;
      if (!printer.print(*line)) break;
    } else if (!is_remark(text) && ++strange <= 3) {
      fmt::print(stderr,
                 "{}:{}: not a frame of candump, .trc or .asc, or a CAN FD frame; line left out\n",
                 name, line_number);
    }
  }
  if (strange > 3) fmt::print(stderr, "{}: {} lines were left out\n", name, strange);
  if (frames == 0 && strange != 0) {
    throw Failure{
        name + ": holds no frame; `candump -L can0 > FILE` makes a recording that takt reads",
        exit_wrong_use};
  }
}

void dump_file(const std::string& name, Printer& printer) {
  if (name == "-") return dump_log(std::cin, "stdin", printer);
  std::ifstream file{name};
  if (!file || std::filesystem::is_directory(name)) {
    throw Failure{name + ": cannot be read: " + std::strerror(file ? EISDIR : errno),
                  exit_wrong_use};
  }
  dump_log(file, name, printer);
}

std::string stamp_text(Time monotonic) {
  const Time real = monotonic + realtime_offset();
  const auto micros = std::chrono::duration_cast<std::chrono::microseconds>(real).count();
  return fmt::format("{}.{:06}", micros / 1'000'000, micros % 1'000'000);
}

/// Reports state changes and lost frames of the interface on stderr.
class InterfaceChanges {
 public:
  explicit InterfaceChanges(const std::string& bus) : bus_{bus} {}

  void announce(const PortCondition& now) {
    if (now.interface_down != last_.interface_down) {
      fmt::print(stderr, "takt dump: {} is {}\n", bus_, now.interface_down ? "down" : "up again");
    }
    if (now.bus_off != last_.bus_off || now.error_passive != last_.error_passive) {
      const char* state = now.error_passive ? "error-passive" : "error-active";
      fmt::print(stderr,
                 "takt dump: the controller of {} is {}, error counters: transmit {}, receive {}\n",
                 bus_, now.bus_off ? "BUS-OFF" : state, now.tx_error_counter, now.rx_error_counter);
    }
    if (now.receive_overruns != last_.receive_overruns) {
      fmt::print(stderr, "takt dump: {} frames were lost\n",
                 now.receive_overruns - last_.receive_overruns);
    }
    last_ = now;
  }

 private:
  const std::string& bus_;
  PortCondition last_;
};

void dump_bus(const std::string& bus, Printer& printer) {
  FrameChannel channel = value_or_fail(FrameChannel::open(bus, BusMember::guest), 3);
  const Interrupt interrupt;
  StampedFrame got;
  InterfaceChanges changes{bus};
  while (!Interrupt::asked()) {
    const bool received = channel.receive(got, std::chrono::milliseconds{100});
    changes.announce(channel.condition());
    if (!received) {
      std::fflush(stdout);
      continue;
    }
    const CandumpLine line{.stamp = stamp_text(got.when), .interface = bus, .frame = got.frame};
    if (!printer.print(line)) break;
    if (isatty(STDOUT_FILENO) != 0) std::fflush(stdout);
  }
}

int run(const DumpOptions& options) {
  std::optional<LoadedNetwork> network;
  std::optional<std::string> log;
  for (const std::string& file : options.files) {
    if (is_network(file) && !network) {
      network = load_network(file);
      if (print_findings(network->findings, Severity::error)) return exit_wrong_use;
    } else if (!log) {
      log = file;
    } else {
      throw Failure{"give at most one network file and one recording", exit_wrong_use};
    }
  }
  if (log && !options.bus.empty()) {
    throw Failure{"give either --bus or a recording, not both", exit_wrong_use};
  }
  const LoadedNetwork* const names = network ? &*network : nullptr;
  const auto node = options.node.empty() ? std::optional{0U} : node_of(options.node, names);
  if (!node) {
    throw Failure{"'" + options.node + "' is not a node id 1..127" +
                      (names == nullptr ? "; a name needs a network file"
                                        : " and not a node of the network file"),
                  exit_wrong_use};
  }
  Printer printer{options, *node, names};
  if (log) {
    dump_file(*log, printer);
  } else if (!options.bus.empty()) {
    dump_bus(options.bus, printer);
  } else if (isatty(STDIN_FILENO) == 0) {
    dump_file("-", printer);
  } else if (network && !network->plan.interface.empty()) {
    dump_bus(network->plan.interface, printer);
  } else {
    throw Failure{"no bus is given; use --bus can0, --bus unix:PATH, or a recording",
                  exit_wrong_use};
  }
  return 0;
}

}  // namespace

void add_dump(CLI::App& app, int& exit_code) {
  auto [dump, options] = add_command<DumpOptions>(
      app, exit_code, "dump", "prints CAN frames with their CANopen meaning", run);
  dump.add_option("files", options.files,
                  "network file (.yaml), recording (.log, .trc, .asc; - for stdin)")
      ->type_name("[NET.yaml] [FILE]");
  add_bus(dump, options.bus, "can0, vcan0, unix:PATH")->type_name("BUS");
  add_number(dump, "-n,--count", options.count, "end after this number of frames");
  dump.add_flag("--json", options.json, "print one JSON object per frame");
  dump.add_option("--only", options.only, "print only these services, for example SDO,EMCY")
      ->delimiter(',')
      ->transform([](std::string text) { return in_capitals(std::move(text)); })
      ->check(service_error)
      ->type_name("SERVICE,...");
  dump.add_option("--node", options.node, "print only frames of this node, by id or name")
      ->type_name("NODE");
  dump.footer(example);
}

}  // namespace takt
