#pragma once
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "master/gateway/message/bus_view.hpp"
#include "master/lcm/link/lcm_client.hpp"
#include "master/linux/clock.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {

/// The devices are simulated in the process of taktd.
inline const std::vector<std::string> on_simulated_bus{"--bus", "sim"};

/// A taktd on its own tcpq:// port, with a folder for its files and a receiver for its messages.
/// If the variable TAKT_TEST_INTERFACE names a CAN interface, taktd and `takt sim` use it instead
/// of the simulated bus. The destructor kills both.
class DaemonProcess {
 public:
  explicit DaemonProcess(const std::filesystem::path& network,
                         std::vector<std::string> arguments = on_simulated_bus);
  ~DaemonProcess();
  DaemonProcess(const DaemonProcess&) = delete;
  DaemonProcess& operator=(const DaemonProcess&) = delete;

  void signal(int number) const { process_->signal(number); }
  /// Stops all threads of the daemon for this time.
  void stop_for(std::chrono::milliseconds time) const;
  /// Waits at most `time_limit` for the exit code. Returns std::nullopt if the daemon still runs or
  /// if a signal ended it.
  std::optional<int> wait();

  /// Receives messages until `done` returns true, at most for `time_limit`. Returns false if `done`
  /// never returned true.
  bool hear(const std::function<bool()>& done);
  /// Like hear(), but calls `work` after each round of messages.
  bool work(const std::function<void()>& work, const std::function<bool()>& done);

  const BusView& bus();
  /// Sends raw bytes.
  void publish(const std::string& channel, Bytes data) { lcm_->publish(channel, data); }
  void command(const command_t& command);
  /// Makes a command for these signals that refers to the newest image.
  command_t command_for(const std::string& sender,
                        const std::vector<std::pair<std::string, std::int64_t>>& values);
  /// Returns the position of the signal `name` of `node`; the test fails if there is none.
  std::size_t signal_at(const std::string& node, const std::string& name, bool output);
  std::int64_t value(const std::string& node, const std::string& name);

  /// Number of images received so far whose SYNC was not before `since` and whose cycle is before
  /// `cycle`.
  std::size_t images_between(Time since, std::int64_t cycle) const;
  /// Number of events of a kind received so far whose text contains `part`.
  std::size_t events(const std::string& kind, const std::string& part = {});
  /// Number of events of a kind in the --events file, which also has the events before the first
  /// received message.
  std::size_t events_in_file(const std::string& kind) const;
  bool all_ready();
  std::string event_file() const;
  std::string log() const { return process_->output(); }
  /// Waits for this text in the log. Returns false if it does not come within `time_limit`.
  bool says(const std::string& text) const { return process_->says(text); }
  const std::string& lcm_url() const noexcept { return url_; }

 private:
  /// The time of SYNC of an image.
  struct ImageTime {
    std::int64_t cycle;
    Time sync;
  };
  void take();

  Folder folder_;
  std::string url_;
  std::optional<Process> devices_;  ///< `takt sim`, if a CAN interface is used
  std::optional<Process> process_;
  std::optional<LcmClient> lcm_;
  BusViews views_;
  std::vector<ImageTime> images_;
};

/// SYNC period of slow_network(), us.
inline constexpr int slow_period = 20000;

/// Writes the demo network with a slower SYNC, for machines under load, and returns its path.
/// `edit` may change the text.
std::filesystem::path slow_network(const std::filesystem::path& folder,
                                   const std::function<void(std::string&)>& edit = {});

}  // namespace takt::test
