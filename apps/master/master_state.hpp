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

/// A running master with its bus, and the newest image. Used only by the front thread.
class Master::State {
 public:
  State(NetworkFile file, const LoadedNetwork& loaded_file, MasterOptions master_options);
  ~State() { stop(); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Opens the bus and starts the bus thread. On failure, returns a sentence.
  std::expected<void, std::string> start();
  bool wait(Time longest);
  bool stop();
  Time now() const noexcept;
  std::optional<RequestId> submit(Request& request);
  bool is_output(std::size_t signal) const noexcept;

  NetworkFile network;
  const LoadedNetwork& loaded;  // belongs to `network`
  MasterOptions options;
  Units units;
  std::optional<BusClaim> claim;              // empty while observing and on simulated buses
  std::unique_ptr<OpenedBus> bus;             // null in virtual time
  std::unique_ptr<VirtualTime> virtual_time;  // null in real time
  MasterRun run;
  bool started = false;
  std::string realtime;
  std::uint64_t cycle = 0;
  Time sync_time{};
  std::vector<std::int64_t> values;
  std::vector<std::uint64_t> stale;
  RequestId newest_request = 0;

 private:
  std::expected<void, std::string> start_in_real_time(const std::string& name);
  std::expected<void, std::string> start_in_virtual_time();
  bool wait_for_image(Time until);
  bool take_image();
};

}  // namespace takt
