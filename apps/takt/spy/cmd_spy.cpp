#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/duration_option.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/live/screen.hpp"
#include "apps/takt/log/logged_signal.hpp"
#include "apps/takt/spy/channel_table.hpp"
#include "apps/takt/spy/message_values.hpp"
#include "apps/takt/spy/typed_types.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/gateway/message/bus_view.hpp"
#include "master/lcm/big_endian.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/lcm/link/lcm_client.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace spy {
namespace {

using namespace std::chrono_literals;

constexpr const char* help =
    R"(Without CHANNEL, takt lists all channels from which messages come, with type, rate, age and size.
With CHANNEL, it prints the values of the messages; an image has the names and units of its signals.
On a terminal, the view follows the messages until q or Ctrl-C; arrow keys scroll. In a pipe, takt
prints the table once, after --for (2 s), and each message of CHANNEL as one line. takt spy sends
nothing.

Examples:
  takt spy
  takt spy DEMO_STATUS
  takt spy DEMO_EVENT | tee events.txt
  takt spy DEMO_IMAGE -n 1
  takt spy DEMO_SHOULDER_STATE --network demo.yaml)";

constexpr Time frame_period = 100ms;
constexpr Time table_time = 2s;
/// The layout, which has the names of the values of an image, comes at least once a second.
constexpr Time layout_limit = 1500ms;

struct SpyOptions {
  std::string channel;
  std::string lcm_url;
  std::string network;
  std::optional<Time> length;
  std::uint64_t count = 0;  // 0 means no limit
};

bool has_terminal() { return ::isatty(STDOUT_FILENO) != 0 && ::isatty(STDIN_FILENO) != 0; }

/// Determines when the command ends: at the time of --for, or on a signal.
class End {
 public:
  explicit End(std::optional<Time> length) {
    if (length) until_ = monotonic_now() + *length;
  }
  bool is_now() const { return Interrupt::asked() || monotonic_now() >= until_; }

 private:
  const Interrupt interrupt_;
  Time until_ = Time::max();
};

/// A view on the whole terminal. Its first line stays while the others scroll.
class View {
 public:
  /// Handles the pressed keys. Returns true if one of them ends the view.
  bool key_ends() {
    while (const int key = Screen::key()) {
      if (key == 'q' || key == 'Q') return true;
      if (key == Screen::key_down || key == 'j') ++first_;
      if ((key == Screen::key_up || key == 'k') && first_ > 0) --first_;
    }
    return false;
  }

  void show(std::vector<Line> lines) {
    const std::size_t rows = Screen::size().rows;
    first_ = std::min(first_, lines.size() > rows ? lines.size() - rows : 0);
    const auto second = lines.begin() + (lines.empty() ? 0 : 1);
    lines.erase(second, second + static_cast<std::ptrdiff_t>(first_));
    screen_.show(lines);
  }

 private:
  const Screen screen_;
  std::size_t first_ = 0;
};

LcmClient open(const SpyOptions& options, const std::vector<std::string>& patterns) {
  return value_or_fail(LcmClient::open(options.lcm_url, patterns), 3);
}

void listen(LcmClient& lcm, ChannelTable& table, Time until) {
  lcm.serve(
      [&](std::string_view channel, Bytes data) { table.take(channel, data, monotonic_now()); },
      until);
  table.tick(monotonic_now());
}

void spy_all(const SpyOptions& options) {
  LcmClient lcm = open(options, {".*"});
  ChannelTable table{monotonic_now()};
  if (has_terminal()) {
    const End end{options.length};
    View view;
    while (!end.is_now() && !view.key_ends()) {
      const Time next_frame = monotonic_now() + frame_period;
      while (monotonic_now() < next_frame && !end.is_now()) listen(lcm, table, next_frame);
      std::vector<Line> lines = table.lines(monotonic_now());
      if (table.channels().empty()) {
        lines = {Line{}.add("no message on " + lcm.where() + " (q quits)", Paint::dim)};
      }
      view.show(std::move(lines));
    }
    return;
  }
  const End end{options.length.value_or(table_time)};
  while (!end.is_now()) listen(lcm, table, monotonic_now() + frame_period);
  if (table.channels().empty()) {
    throw Failure{"no message has come on " + lcm.where() +
                  ". Is taktd running? At its start taktd prints the LCM_DEFAULT_URL to set"};
  }
  print_lines(table.lines(monotonic_now()), 80);
}

/// Turns the messages of one channel into values.
class ChannelReader {
 public:
  explicit ChannelReader(const SpyOptions& options)
      : channel_{options.channel},
        image_bus_{bus_of_channel(options.channel, "IMAGE")},
        types_{own_types()} {
    if (options.network.empty()) return;
    const LoadedNetwork network = load_network(options.network);
    if (print_findings(network.findings, Severity::error)) {
      throw Failure{options.network + ": the network file has errors", exit_wrong_use};
    }
    typed_ = add_typed(types_, network.plan);
  }

  /// Returns the values of the message if it came on the channel.
  std::optional<std::vector<Value>> take(std::string_view channel, Bytes data) {
    if (!image_bus_.empty()) views_.take(channel, data);
    if (channel != channel_ || awaits_layout()) return {};
    const auto fingerprint = load_be<std::uint64_t>(data);
    std::string type{own_type(fingerprint)};
    const auto typed = typed_.find(channel);
    if (typed != typed_.end() && typed->second.fingerprint == fingerprint) {
      type = typed->second.type;
    }
    if (type.empty()) return std::vector{unknown(fingerprint, data.size())};
    auto values = decode_values(types_, type, data);
    if (!values) return std::vector{Value{"malformed " + type, values.error(), {}}};
    name_signals(*values);
    return std::move(*values);
  }

 private:
  bool awaits_layout() const {
    if (image_bus_.empty() || monotonic_now() >= begin_ + layout_limit) return false;
    const auto found = views_.buses().find(image_bus_);
    return found == views_.buses().end() || found->second.values().empty();
  }

  Value unknown(std::uint64_t fingerprint, std::size_t bytes) const {
    const bool is_typed = channel_.ends_with("_STATE") || channel_.ends_with("_COMMAND");
    return {
        "unknown type",
        fmt::format("{}, {} bytes{}", hex64(fingerprint), bytes,
                    is_typed ? "; --network NET.yaml gives the types of `takt export lcm`" : ""),
        {}};
  }

  /// Replaces the raw values of an image by its signals when the layout has come.
  void name_signals(std::vector<Value>& values) const {
    const auto found = views_.buses().find(image_bus_);
    if (found == views_.buses().end() || found->second.values().empty()) return;
    const BusView& view = found->second;
    const auto raw = std::ranges::find(values, "values", &Value::name);
    if (raw == values.end()) return;
    values.erase(raw);
    for (std::size_t i = 0; i < view.signals().size(); ++i) {
      const signal_t& signal = view.signals()[i];
      std::string text;
      if (!logging::append_value(text, view.units().format(i), view.values()[i])) text = "nan";
      if (!signal.unit.empty()) text += ' ' + signal.unit;
      values.push_back({signal.node + '.' + signal.name, text, view.stale(i) ? "stale" : ""});
    }
  }

  std::string channel_;
  std::string image_bus_;  // bus of the image; empty if the channel is not that of an image
  MessageTypes types_;
  TypedChannels typed_;
  BusViews views_;
  Time begin_ = monotonic_now();
};

std::vector<Line> value_lines(const std::string& channel, const std::vector<Value>& values,
                              std::uint64_t messages) {
  std::size_t width = 0;
  for (const Value& value : values) width = std::max(width, value.name.size());
  width = std::min<std::size_t>(width, 40);
  std::vector<Line> lines{
      Line{}.add(fmt::format("{}  message {}", channel, messages), Paint::title)};
  for (const Value& value : values) {
    lines.push_back(Line{}
                        .add(left(value.name, width) + "  " + value.text)
                        .add(value.comment.empty() ? "" : "  " + value.comment, Paint::dim));
  }
  return lines;
}

void print_line(const std::string& channel, const std::vector<Value>& values) {
  std::string line = channel;
  for (const Value& value : values) line += ' ' + value.name + '=' + value.text;
  std::puts(printable_text(line).c_str());
  std::fflush(stdout);
}

/// Returns the error that no message of the channel has come. Names a similar channel on which
/// messages have come.
Failure no_message(const std::string& channel, const ChannelTable& table,
                   const std::string& where) {
  std::vector<std::string> names;
  for (const auto& [name, state] : table.channels()) names.push_back(name);
  if (names.empty()) return Failure{"no message has come on " + where + ". Is taktd running?"};
  return Failure{"no message has come on the channel '" + channel + "'" + guess(channel, names) +
                     "; `takt spy` lists the channels",
                 1};
}

void spy_one(const SpyOptions& options) {
  ChannelReader reader{options};
  LcmClient lcm = open(options, {".*"});
  ChannelTable table{monotonic_now()};
  std::uint64_t messages = 0;
  const bool live = has_terminal() && options.count == 0;
  const End end{options.length};
  std::optional<View> view;
  if (live) view.emplace();
  std::vector<Value> newest;
  Time patience = monotonic_now() + 3s;
  while (!end.is_now() && (options.count == 0 || messages < options.count)) {
    lcm.serve(
        [&](std::string_view channel, Bytes data) {
          if (messages == 0) table.take(channel, data, monotonic_now());
          auto values = reader.take(channel, data);
          if (!values || (options.count != 0 && messages == options.count)) return;
          ++messages;
          if (live) {
            newest = std::move(*values);
          } else if (has_terminal()) {
            print_lines(value_lines(options.channel, *values, messages));
          } else {
            print_line(options.channel, *values);
          }
        },
        monotonic_now() + frame_period);
    if (view && messages != 0) view->show(value_lines(options.channel, newest, messages));
    if (view && view->key_ends()) return;
    if (messages == 0 && !view && monotonic_now() > patience) {
      patience = Time::max();
      complain(std::string{no_message(options.channel, table, lcm.where()).what()} + "; waiting",
               0);
    }
  }
  view.reset();
  if (messages == 0) throw no_message(options.channel, table, lcm.where());
}

int run(const SpyOptions& options) {
  options.channel.empty() ? spy_all(options) : spy_one(options);
  std::fflush(stdout);
  return 0;
}

}  // namespace
}  // namespace spy

void add_spy(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<spy::SpyOptions>(
      app, exit_code, "spy", "lists the LCM channels, or prints the messages of one", spy::run);
  verb.add_option("CHANNEL", options.channel, "for example DEMO_STATUS; default: the table of all")
      ->type_name("NAME");
  add_number(verb, "-n,--count", options.count, "end after this number of messages of CHANNEL");
  add_duration(verb, "--for", options.length, "end after this time");
  verb.add_option("--network", options.network,
                  "network file, for the channels of single nodes (`takt export lcm`)")
      ->type_name("NET.yaml");
  verb.add_option("--lcm-url", options.lcm_url, "LCM URL; default: LCM_DEFAULT_URL")
      ->type_name("URL");
  verb.footer(spy::help);
}

}  // namespace takt
