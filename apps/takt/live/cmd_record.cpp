#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "apps/command_line/commands.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

/// Longer than the least interval between two recordings plus the time to write the files.
constexpr std::chrono::seconds time_limit{30};

int run(const LiveOptions& options) {
  const reply_t reply = DaemonClient::find(options).demand(make_request("record"), time_limit);
  std::puts(printable_text(reply.text).c_str());
  return 0;
}

}  // namespace

void add_record(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<LiveOptions>(
      app, exit_code, "record", "makes the daemon write a recording of its last seconds", run);
  verb.footer(
      "The daemon needs --black-box, or `black_box:` in the network file. takt record prints the\n"
      "path of the recording, which is on the machine of taktd.\n\n"
      "Example:\n"
      "  takt replay $(takt record)");
  add_live_options(verb, options);
}

}  // namespace takt
