#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/duration.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/smooth/image_record.hpp"
#include "apps/takt/smooth/make_record.hpp"
#include "apps/takt/smooth/smooth_report.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/black_box/recorded_network.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace smooth {
namespace {

namespace fs = std::filesystem;

constexpr const char* help =
    R"(FILE is a recording of candump (-L), PCAN (.trc), Vector (.asc) or python-can, or of the black box.
It may come from any master. takt learns which PDOs carry set-points from the SDO transfers of the
boot, if the recording has them, otherwise from --network, --eds or --pdo. A recording of the black
box names its network file.

`live` listens to the running daemon over LCM and judges the values; `live --bus can0` listens to
the bus and judges the times of the frames as well. Let the axes move while takt listens.

Exit codes: 0 no error was found, 1 an axis is rough, 2 the recording has no set-points that takt
understands, 3 bus trouble.

Examples:
  candump -L can0 > trace.log          before the master boots the drives; then move the axes
  takt smooth trace.log
  takt smooth trace.log --pdo 0x205=6040,607A --pdo 0x185=6041,6064
  takt smooth live --for 20s)";

struct SmoothArguments {
  std::string file;
  std::string network;
  std::vector<std::string> eds;
  std::vector<std::string> folders;
  std::vector<std::string> pdos;
  std::string bus;
  std::string listen_for = "10s";
  std::uint32_t bitrate_kbit = 0;
  LiveOptions live;
};

bool is_live(const SmoothArguments& options) { return options.file == "live"; }

Trace read_file(const SmoothArguments& options) {
  if (options.file == "-") return read_trace(std::cin, "stdin", options.bus);
  const std::string log = log_of_recording(options.file);
  std::ifstream file{log, std::ios::binary};
  std::error_code ignored;
  if (!file || fs::is_directory(log, ignored))
    throw Failure{log + ": can't be read", exit_wrong_use};
  return read_trace(file, log, options.bus);
}

std::string stamp_of(Time when) {
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(when).count();
  return fmt::format("{}.{:06}", us / 1'000'000, us % 1'000'000);
}

Trace listen_to_bus(const SmoothArguments& options, Time until) {
  FrameChannel channel = value_or_fail(FrameChannel::open(options.bus, BusMember::guest), 3);
  const Interrupt interrupt;
  TraceBuilder builder{options.bus, options.bus};
  StampedFrame got;
  while (!Interrupt::asked() && monotonic_now() < until) {
    if (!channel.receive(got, std::chrono::milliseconds{100})) continue;
    builder.add(to_string(
        CandumpLine{.stamp = stamp_of(got.when), .interface = options.bus, .frame = got.frame}));
  }
  if (channel.condition().receive_overruns != 0) {
    complain("frames were lost; causes that need every frame may be wrong", 0);
  }
  return builder.take();
}

/// Collects the images of a daemon. The layout comes once a second.
class ImageListener {
 public:
  explicit ImageListener(const LiveOptions& options)
      : bus_{DaemonClient::find(options).status().bus},
        lcm_{open_live(options, {"LAYOUT", "IMAGE"})} {}

  BusRecord listen(Time duration) {
    const Interrupt interrupt;
    Time until = monotonic_now() + std::chrono::seconds{5};
    while (!Interrupt::asked() && monotonic_now() < until) {
      const bool before = record_.has_value();
      lcm_.serve([this](std::string_view from, Bytes data) { take(from, data); },
                 std::min(until, monotonic_now() + std::chrono::milliseconds{100}));
      if (!before && record_) until = monotonic_now() + duration;
    }
    if (!record_) throw Failure{"the daemon of bus '" + bus_ + "' sends no layout"};
    return record_->finish();
  }

 private:
  void take(std::string_view channel, Bytes data) {
    view_.take(channel, data);
    if (channel == channel_name(bus_, "LAYOUT") && !record_) {
      const auto layout = decode<layout_t>(data);
      const auto found = view_.buses().find(channel.substr(0, channel.rfind('_')));
      if (!layout || found == view_.buses().end() || found->second.signals().empty()) return;
      record_.emplace("bus '" + bus_ + "'", found->second.signals(), Time{layout->period_ns});
    } else if (channel == channel_name(bus_, "IMAGE") && record_) {
      if (const auto image = decode<image_t>(data)) record_->take(*image);
    }
  }

  std::string bus_;
  LcmClient lcm_;
  BusViews view_;
  std::optional<ImageRecord> record_;
};

PdoMap find_map(const SmoothArguments& options, const Trace& trace) {
  PdoMap map;
  std::string network = options.network;
  if (network.empty() && !is_live(options))
    network = network_of_recording(log_of_recording(options.file));
  if (!network.empty()) {
    const LoadedNetwork loaded = load_network(network);
    if (print_findings(loaded.findings, Severity::error)) {
      throw Failure{network + ": the network file has errors", exit_wrong_use};
    }
    add_plan(map, loaded.plan);
  }
  learn::DeviceFiles files;
  takt::Findings findings;
  bool good = true;
  for (const std::string& folder : options.folders) files.add_folder(folder, findings);
  for (const std::string& file : options.eds) good = files.add_argument(file, findings) && good;
  if (print_findings(findings, Severity::warning) || !good) {
    throw Failure{"a device file can't be used", exit_wrong_use};
  }
  add_learned(map, trace.bus, files);
  for (const std::string& pdo : options.pdos) value_or_fail(add_pdo(map, pdo), exit_wrong_use);
  if (options.bitrate_kbit != 0) map.bitrate = options.bitrate_kbit * 1000;
  return map;
}

BusRecord record_of(const SmoothArguments& options, const Trace& trace) {
  print_findings(trace.bus.findings, Severity::warning);
  if (trace.frames.empty()) throw Failure{options.file + ": holds no frame", exit_wrong_use};
  if (!trace.with_times) {
    throw Failure{options.file + ": frames without time stamps; record with `candump -L`",
                  exit_wrong_use};
  }
  BusRecord record = make_record(trace, find_map(options, trace));
  if (trace.cut) {
    record.remarks.push_back(
        fmt::format("Only the first {} frames are judged.", TraceBuilder::most_frames));
  }
  return record;
}

BusRecord listen(const SmoothArguments& options) {
  const Time duration = parse_duration(options.listen_for).value_or(Time{});
  if (options.bus.empty()) return ImageListener{options.live}.listen(duration);
  return record_of(options, listen_to_bus(options, monotonic_now() + duration));
}

int run(const SmoothArguments& options) {
  const BusRecord record =
      is_live(options) ? listen(options) : record_of(options, read_file(options));
  if (record.axes.empty()) {
    throw Failure{
        record.source +
            ": takt does not know which PDO carries set-points (607A, 60C1, 60FF): record the boot "
            "of the drives as well, or give --network, --eds 5=FILE or --pdo 0x205=6040,607A",
        exit_wrong_use};
  }
  const Verdict verdict = judge(record);
  if (options.live.json) {
    std::puts(json_text(verdict_json(verdict), 1).c_str());
  } else {
    std::fputs(printable_lines(verdict_text(verdict)).c_str(), stdout);
  }
  return verdict.rough() ? 1 : 0;
}

}  // namespace
}  // namespace smooth

void add_smooth(CLI::App& app, int& exit_code) {
  auto [command, options] = add_command<smooth::SmoothArguments>(
      app, exit_code, "smooth", "finds what makes axes rough, in a recording or on the running bus",
      smooth::run);
  command.add_option("FILE", options.file, "recording, - for stdin, or `live`")
      ->type_name("FILE|live")
      ->required();
  command.add_option("--network", options.network, "network file with the PDOs of the drives")
      ->type_name("NET.yaml");
  command.add_option("--eds", options.eds,
                     "EDS or DCF, matched by its identity; 5=FILE assigns it to node 5");
  command
      .add_option("--eds-dir", options.folders,
                  "folder with EDS and DCF files; takt searches subfolders, too")
      ->type_name("DIR");
  command.add_option("--pdo", options.pdos, "objects of a PDO: 0x205=6040,607A")
      ->type_name("COB-ID=OBJ,...");
  add_bus(command, options.bus, "interface of the recording; with `live`, the bus to listen to");
  command.add_option("--for", options.listen_for, "with `live`: how long to listen")
      ->check(duration_error)
      ->capture_default_str();
  add_number(command, "--bitrate", options.bitrate_kbit, "bit rate, kbit/s")
      ->check(CLI::Range(10U, 1000U));
  add_live_options(command, options.live);
  command.footer(smooth::help);
}

}  // namespace takt
