#include "test/e2e/daemon_process.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <thread>
#include <utility>

#include "master/core/node_status.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/lcm/messages.hpp"
#include "master/lcm/tcpq/tcpq_broker.hpp"
#include "master/linux/clock.hpp"
#include "test/support/time_limit.hpp"

namespace takt::test {
namespace {

namespace fs = std::filesystem;

std::uint16_t free_port() { return TcpqBroker::listen(0).value()->port(); }

}  // namespace

DaemonProcess::DaemonProcess(const fs::path& network, std::vector<std::string> arguments)
    : url_{"tcpq://127.0.0.1:" + std::to_string(free_port())} {
  const char* const interface = std::getenv("TAKT_TEST_INTERFACE");
  if (interface && arguments == on_simulated_bus) {
    arguments = {"--bus", interface};
    devices_.emplace(std::vector<std::string>{TAKT, "sim", network.string(), "--bus", interface},
                     folder_ / "devices");
  }
  arguments.insert(arguments.begin(),
                   {TAKTD, network.string(), "--lcm-url", url_, "--events", event_file()});
  process_.emplace(std::move(arguments), folder_ / "log");
  lcm_ = LcmClient::open(url_, {".*"}).value();
}

DaemonProcess::~DaemonProcess() {
  if (testing::Test::HasFailure()) std::fprintf(stderr, "taktd said:\n%s\n", log().c_str());
}

void DaemonProcess::stop_for(std::chrono::milliseconds time) const {
  signal(SIGSTOP);
  std::this_thread::sleep_for(time);
  signal(SIGCONT);
}

std::optional<int> DaemonProcess::wait() {
  return process_->wait([this] { take(); });
}

/// One call of serve() takes a part of what waits. A test that was held up has to take everything,
/// so that the newest image is the newest one of the daemon.
void DaemonProcess::take() {
  std::size_t taken = 0;
  const auto message = [&](std::string_view channel, std::span<const std::byte> data) {
    ++taken;
    views_.take(channel, data);
    if (!channel.ends_with("_IMAGE")) return;
    if (const auto image = decode<image_t>(data); image && image->part == 0) {
      images_.push_back({image->cycle, Time{image->sync_mono_ns}});
    }
  };
  lcm_->serve(message, monotonic_now() + std::chrono::milliseconds{20});
  while (std::exchange(taken, 0) > 0) lcm_->serve(message, monotonic_now());
}

bool DaemonProcess::hear(const std::function<bool()>& done) {
  return work([] {}, done);
}

bool DaemonProcess::work(const std::function<void()>& work, const std::function<bool()>& done) {
  const Time until = monotonic_now() + time_limit;
  while (!done()) {
    if (monotonic_now() > until) return false;
    take();
    work();
  }
  return true;
}

const BusView& DaemonProcess::bus() {
  static const BusView none;
  return views_.buses().empty() ? none : views_.buses().begin()->second;
}

bool DaemonProcess::all_ready() {
  const auto& status = bus().status();
  if (!status || status->nodes.empty() || bus().values().empty()) return false;
  for (const node_status_t& node : status->nodes) {
    if (node.boot_state != static_cast<int>(BootState::ready) ||
        node.nmt_state != static_cast<int>(NmtState::operational)) {
      return false;
    }
  }
  return true;
}

std::size_t DaemonProcess::signal_at(const std::string& node, const std::string& name,
                                     bool output) {
  const auto& signals = bus().signals();
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const bool same = signals[i].node == node && signals[i].name == name;
    if (same && (signals[i].output != 0) == output) return i;
  }
  ADD_FAILURE() << "no signal " << node << '.' << name;
  return 0;
}

std::int64_t DaemonProcess::value(const std::string& node, const std::string& name) {
  const std::size_t at = signal_at(node, name, false);
  return at < bus().values().size() ? bus().values()[at] : 0;
}

command_t DaemonProcess::command_for(
    const std::string& sender, const std::vector<std::pair<std::string, std::int64_t>>& values) {
  command_t message{};
  message.schema = message_schema;
  message.session = bus().session();
  message.sender = sender;
  message.instance = 1 + static_cast<std::int64_t>(std::hash<std::string>{}(sender) >> 2U);
  message.cycle = bus().cycle();
  message.time_to_live = 40;
  for (const auto& [name, raw] : values) {
    const std::size_t dot = name.find('.');
    message.signals.push_back(
        static_cast<std::int32_t>(signal_at(name.substr(0, dot), name.substr(dot + 1), true)));
    message.values.push_back(raw);
  }
  message.num_values = static_cast<std::int32_t>(message.values.size());
  return message;
}

void DaemonProcess::command(const command_t& command) {
  std::vector<std::byte> buffer;
  publish(channel_name(bus().status()->bus, "COMMAND"), encode(command, buffer));
}

std::size_t DaemonProcess::images_between(Time since, std::int64_t cycle) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      images_, [&](const ImageTime& image) { return image.sync >= since && image.cycle < cycle; }));
}

std::size_t DaemonProcess::events(const std::string& kind, const std::string& part) {
  std::size_t count = 0;
  for (const event_t& event : bus().events()) {
    count += event.kind == kind && event.text.find(part) != std::string::npos;
  }
  return count;
}

std::size_t DaemonProcess::events_in_file(const std::string& kind) const {
  const std::string text = read_file(event_file());
  const std::string word = '"' + kind + '"';
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) ++count;
  return count;
}

std::string DaemonProcess::event_file() const { return folder_ / "events.jsonl"; }

fs::path slow_network(const fs::path& folder, const std::function<void(std::string&)>& edit) {
  const fs::path demo = fs::path{TAKT_SOURCE_DIR} / "share/demo/two_axes.yaml";
  std::string text = read_file(demo);
  const auto replace = [&](const std::string& what, const std::string& with) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += with.size()) {
      text.replace(at, what.size(), with);
    }
  };
  replace("../eds/", (fs::path{TAKT_SOURCE_DIR} / "share/eds/").string());
  replace("sync_period: 2000 ", "sync_period: " + std::to_string(slow_period) + " ");
  if (edit) edit(text);
  std::ofstream{folder / "network.yaml"} << text;
  return folder / "network.yaml";
}

}  // namespace takt::test
