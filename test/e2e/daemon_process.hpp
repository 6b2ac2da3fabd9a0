#pragma once
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "master/gateway/bus_view.hpp"
#include "master/gateway/lcm_client.hpp"
#include "master/linux/clock.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {

/// A taktd of its own on a tcpq:// port of its own, with a folder for its files, and an ear on its
/// messages. Killed when the test ends.
class DaemonProcess {
 public:
  explicit DaemonProcess(const std::filesystem::path& network,
                         std::vector<std::string> arguments = {"--bus", "sim"});
  ~DaemonProcess();
  DaemonProcess(const DaemonProcess&) = delete;
  DaemonProcess& operator=(const DaemonProcess&) = delete;

  void signal(int number) const { process_->signal(number); }
  /// Lets none of its threads run for so long.
  void stop_for(std::chrono::milliseconds time) const;
  /// Exit code within a generous time; none: it still runs, or a signal ended it.
  std::optional<int> wait();

  /// Takes messages until `done`, at most for a generous time. False: it never was.
  bool hear(const std::function<bool()>& done);
  /// The same, with `work` after each round of messages.
  bool work(const std::function<void()>& work, const std::function<bool()>& done);

  const BusView& bus();
  /// Sends bytes as they are.
  void publish(const std::string& channel, Bytes data) { lcm_->publish(channel, data); }
  void command(const command_t& command);
  /// A command for these signals, computed from the newest image.
  command_t command_for(const std::string& sender,
                        const std::vector<std::pair<std::string, std::int64_t>>& values);
  /// Position of `node.signal`; fails the test where there is none.
  std::size_t signal_at(const std::string& node, const std::string& name, bool output);
  std::int64_t value(const std::string& node, const std::string& name);

  /// Images heard so far that are younger than `since` and older than this cycle.
  std::size_t images_between(Time since, std::int64_t cycle) const;
  /// Events heard so far of a kind whose text holds `part`.
  std::size_t events(const std::string& kind, const std::string& part = {});
  /// Events of a kind that its --events file holds: those before the first message was heard too.
  std::size_t events_in_file(const std::string& kind) const;
  bool all_ready();
  std::string event_file() const;
  std::string log() const { return process_->output(); }
  /// Waits for this text in the log. False: it never came.
  bool says(const std::string& text) const { return process_->says(text); }
  const std::string& lcm_url() const noexcept { return url_; }

 private:
  /// SYNC of an image.
  struct ImageTime {
    std::int64_t cycle;
    Time sync;
  };
  void take();

  Folder folder_;
  std::string url_;
  std::optional<Process> process_;
  std::optional<LcmClient> lcm_;
  BusViews views_;
  std::vector<ImageTime> images_;
};

/// The demo network with a slower SYNC, for machines under load. `edit` may change its text.
std::filesystem::path slow_network(const std::filesystem::path& folder,
                                   const std::function<void(std::string&)>& edit = {});

}  // namespace takt::test
