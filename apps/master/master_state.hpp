#pragma once
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <takt/master.hpp>
#include <vector>

#include "apps/master/network_state.hpp"
#include "apps/master/opened_bus.hpp"
#include "apps/master/virtual_time.hpp"
#include "master/linux/bus/bus_claim.hpp"
#include "master/master_run.hpp"
#include "master/units/units.hpp"

namespace takt {

/// A running master with its bus, and the newest image. Front thread.
class Master::State {
 public:
  State(NetworkFile network, const LoadedNetwork& loaded, MasterOptions options);
  ~State() { stop(); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Opens the bus and starts the bus thread. On failure, returns a sentence.
  std::expected<void, std::string> start();

  const NetworkFile& network() const noexcept { return network_; }
  const std::string& realtime() const noexcept { return realtime_; }
  Time now() const noexcept;

  bool wait(Time longest);
  bool stop();
  void request_stop() noexcept { run_.request_stop(); }

  std::uint64_t cycle() const noexcept { return cycle_; }
  Time sync_time() const noexcept { return sync_time_; }
  double value(std::size_t signal) const;
  std::int64_t raw(std::size_t signal) const { return values_[signal]; }
  bool stale(std::size_t signal) const { return ((stale_[signal / 64] >> (signal % 64)) & 1) != 0; }

  bool set(std::size_t signal, double si);
  bool set_raw(std::size_t signal, std::int64_t value);
  void send() { run_.publish_outputs(now()); }

  NodeState node(std::uint8_t node_id) const;
  bool all_ready() const;
  std::optional<MasterEvent> take_event();
  std::optional<RequestId> submit(Request& request);
  std::optional<ServiceReply> take_reply();

 private:
  std::expected<void, std::string> start_in_real_time(const std::string& bus);
  std::expected<void, std::string> start_in_virtual_time();
  bool wait_for_image(Time until);
  bool take_image();
  bool is_output(std::size_t signal) const noexcept;

  NetworkFile network_;
  const LoadedNetwork& loaded_;  // belongs to network_
  MasterOptions options_;
  Units units_;
  std::optional<BusClaim> claim_;              // empty while observing and on simulated buses
  std::unique_ptr<OpenedBus> bus_;             // null in virtual time
  std::unique_ptr<VirtualTime> virtual_time_;  // null in real time
  MasterRun run_;
  bool started_ = false;
  std::string realtime_;
  std::uint64_t cycle_ = 0;
  Time sync_time_{};
  std::vector<std::int64_t> values_;
  std::vector<std::uint64_t> stale_;
  RequestId newest_request_ = 0;
};

}  // namespace takt
