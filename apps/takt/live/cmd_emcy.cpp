#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/takt/live/acknowledged.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "master/explain/emcy_text.hpp"
#include "master/gateway/notice/emcy_log.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/lcm/messages.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

struct EmcyOptions {
  LiveOptions live;
  std::string node;
  bool follow = false;
  bool all = false;
  bool acknowledge = false;
};

struct Reported {
  std::int16_t node = 0;
  std::string name;
  EmcyRecord record;
  std::string words;
  bool acknowledged = false;
};

/// Returns the local time, for example "14:03:07.123".
std::string clock_text(std::int64_t utime) {
  const auto seconds = static_cast<std::time_t>(utime / 1'000'000);
  return fmt::format("{:%H:%M:%S}.{:03}", fmt::localtime(seconds), utime / 1000 % 1000);
}

std::string bytes_text(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes)
    text += fmt::format("{}{:02X}", text.empty() ? "" : " ", byte);
  return text;
}

nlohmann::json to_json(const Reported& reported) {
  const EmcyRecord& record = reported.record;
  return {{"utime", record.utime},
          {"node_id", reported.node},
          {"node", reported.name},
          {"code", record.code()},
          {"text", reported.words},
          {"error_register", record.error_register()},
          {"error_register_text", error_register_text(record.error_register())},
          {"manufacturer", std::vector<int>{record.bytes.begin() + 3, record.bytes.end()}},
          {"acknowledged", reported.acknowledged}};
}

void print(const Reported& reported) {
  const EmcyRecord& record = reported.record;
  std::printf("%s\n",
              fmt::format("{}  node {} {:<12} 0x{:04X}  {} (register: {}; vendor bytes {})",
                          clock_text(record.utime), reported.node, printable_text(reported.name),
                          record.code(), printable_text(reported.words),
                          error_register_text(record.error_register()),
                          bytes_text(std::span{record.bytes}.subspan(3)))
                  .c_str());
}

/// Returns the EMCY history of all nodes, or of node `only` if it is not 0, in the order of time.
std::vector<Reported> history(DaemonClient& daemon, std::int16_t only) {
  std::vector<Reported> all;
  for (const node_status_t& node : daemon.status().nodes) {
    if ((only != 0 && node.node_id != only) || node.emcy_count == 0) continue;
    const reply_t reply =
        daemon.demand(make_request("emcy_history", node.node_id), std::chrono::seconds{3});
    const auto own = unpack_texts(reply.text);
    for (const EmcyRecord& record : unpack_emcys(reply.data)) {
      const auto found = own.find(record.code());
      all.push_back({node.node_id, node.name, record,
                     found == own.end() ? std::string{emcy_text(record.code())} : found->second});
    }
  }
  std::ranges::stable_sort(all, {}, [](const Reported& reported) { return reported.record.utime; });
  return all;
}

/// Prints the EMCYs that the daemon reports from now on.
int follow(const EmcyOptions& options, const std::string& bus, std::int16_t only) {
  const Interrupt interrupt;
  const std::string events = channel_name(bus, "EVENT");
  LcmClient lcm = open_live(options.live, {"EVENT"});
  while (!Interrupt::asked()) {
    lcm.serve(
        [&](std::string_view channel, std::span<const std::byte> data) {
          if (channel != events) return;
          const auto event = decode<event_t>(data);
          if (!event || event->kind != "emcy" || (only != 0 && event->node_id != only)) return;
          if (options.live.json) {
            const nlohmann::json line{{"utime", event->utime},
                                      {"node_id", event->node_id},
                                      {"node", event->node},
                                      {"text", event->text}};
            std::puts(json_text(line).c_str());
          } else {
            std::printf("%s  %s\n", clock_text(event->utime).c_str(),
                        printable_lines(event->text).c_str());
          }
          std::fflush(stdout);
        },
        monotonic_now() + std::chrono::milliseconds{200});
  }
  return 0;
}

void print_json(const std::string& bus, const std::vector<Reported>& reported) {
  nlohmann::json all = nlohmann::json::array();
  for (const Reported& one : reported) all.push_back(to_json(one));
  const nlohmann::json document{{"bus", bus}, {"emcys", std::move(all)}};
  std::puts(json_text(document, 1).c_str());
}

/// Prints the EMCYs that are not acknowledged, or all.
void print(const std::vector<Reported>& reported, bool all) {
  std::size_t left_out = 0;
  for (const Reported& one : reported) {
    if (one.acknowledged && !all) {
      ++left_out;
    } else {
      print(one);
    }
  }
  if (left_out == 0) return;
  std::fflush(stdout);
  std::fprintf(stderr, "takt: %zu acknowledged EMCYs are left out; --all shows them\n", left_out);
}

int run(const EmcyOptions& options) {
  DaemonClient daemon = DaemonClient::find(options.live);
  const std::string& bus = daemon.status().bus;
  const std::int16_t only = options.node.empty() ? std::int16_t{0} : daemon.node(options.node);
  const std::optional<std::filesystem::path> file = Acknowledged::file();
  if (options.acknowledge && !file) {
    throw Failure{
        "neither XDG_STATE_HOME nor HOME is set, so there is no place for the list of acknowledged "
        "EMCYs: set one of them",
        exit_wrong_use};
  }
  Acknowledged acknowledged = file ? Acknowledged::load(*file) : Acknowledged{};
  std::vector<Reported> reported = history(daemon, only);
  for (Reported& one : reported) {
    one.acknowledged = acknowledged.contains(bus, one.node, one.record.utime);
  }
  if (options.live.json && !options.follow) {
    print_json(bus, reported);
  } else if (!options.live.json) {
    print(reported, options.all);
  }
  std::fflush(stdout);
  if (options.acknowledge) {
    for (const Reported& one : reported) acknowledged.add(bus, one.node, one.record.utime);
    acknowledged.save(*file);
  }
  return options.follow ? follow(options, bus, only) : 0;
}

}  // namespace

void add_emcy(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<EmcyOptions>(
      app, exit_code, "emcy", "prints the EMCYs that nodes have sent, with their meaning", run);
  verb.footer(
      "--acknowledge writes to ~/.local/state/takt/acknowledged (or in XDG_STATE_HOME) which\n"
      "EMCYs were printed. Later calls of takt emcy leave these EMCYs out. The daemon does not\n"
      "know this file: other users still see the EMCYs, and no error of a device is reset.\n"
      "Examples:\n  takt emcy                 the newest 32 EMCYs of each node\n"
      "  takt emcy --acknowledge   the same, and not again\n"
      "  takt emcy shoulder --json\n  takt emcy --follow        also those that arrive later");
  verb.add_option("NODE", options.node, "node id or name; default: all nodes");
  verb.add_flag("-f,--follow", options.follow,
                "continue with the EMCYs that arrive, until interrupted");
  verb.add_flag("--acknowledge", options.acknowledge, "leave these EMCYs out from now on");
  verb.add_flag("--all", options.all, "print acknowledged EMCYs, too");
  add_live_options(verb, options.live);
}

}  // namespace takt
