#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/network.hpp"
#include "master/core/ordered_stop.hpp"
#include "master/core/pdo_exchange.hpp"
#include "master/core/pdo_requests.hpp"
#include "master/rt/arrival_prediction.hpp"
#include "master/rt/beat_clock.hpp"
#include "master/rt/controller.hpp"
#include "master/rt/exchange.hpp"
#include "master/rt/port.hpp"
#include "master/rt/port_watch.hpp"
#include "master/rt/service_queue.hpp"
#include "master/rt/sync_gate.hpp"
#include "master/rt/sync_hold.hpp"
#include "master/rt/wire_time.hpp"

namespace takt {

struct BusLoopOptions {
  bool observe = false;              ///< listen only: nothing at all is sent
  Controller* controller = nullptr;  ///< called in each cycle; outlives the loop
};

/// The bus thread: one SYNC cycle after another. A complete cycle makes six system calls (sleep,
/// SYNC, sleep, receive, sleep, outputs), one with a missing PDO eight; service frames add theirs.
/// Nothing allocates, locks or throws after construction. `N` is the machine of the services:
/// boot, SDO, NMT.
template <Port P, class N = Network>
class BusLoop {
 public:
  /// Keeps references to all three.
  BusLoop(const BusPlan& plan, P& port, Exchange& exchange, BusLoopOptions options = {});
  BusLoop(const BusLoop&) = delete;
  BusLoop& operator=(const BusLoop&) = delete;

  /// The first SYNC comes one period from now.
  void start() noexcept;
  /// One whole cycle: returns after its outputs were sent.
  void cycle() noexcept;
  void request_stop() noexcept { exchange_.stop_requested.store(true, std::memory_order_relaxed); }
  /// The ordered stop is over; no cycle may follow.
  bool done() const noexcept { return done_; }

 private:
  static constexpr std::size_t batch = 256;              ///< frames taken by one receive
  static constexpr unsigned patience_with_services = 2;  ///< cycles without room for them
  static constexpr Time status_interval = std::chrono::milliseconds{10};

  void follow_nodes() noexcept;
  void wait_for_beat() noexcept;
  void look_at_wire() noexcept;
  void send_sync() noexcept;
  void relieve_services() noexcept;
  void receive() noexcept;
  void drain() noexcept;
  void learn(bool in_time) noexcept;
  void publish() noexcept;
  void run_controller(const ImageStamp& stamp) noexcept;
  void predict_next_publish() noexcept;
  void serve() noexcept;
  bool send_services(std::size_t& budget) noexcept;
  void take_requests() noexcept;
  bool submit(const Request& request) noexcept;
  void give_replies() noexcept;
  void stop_drives_after_loss() noexcept;
  void send_outputs() noexcept;
  void step_stop() noexcept;
  void give_events() noexcept;
  void write_status() noexcept;
  std::size_t send(std::span<const Frame> frames) noexcept;
  void tell(EventKind kind, Time now, std::int64_t value = 0, std::uint32_t detail = 0) noexcept;

  const BusPlan& plan_;
  P& port_;
  Exchange& exchange_;
  BusLoopOptions options_;

  EventQueue events_;
  PdoExchange pdos_;
  N network_;
  PdoRequests pdo_requests_;
  OrderedStop stop_;
  PortWatch port_watch_;
  ServiceQueue services_;
  BeatClock clock_;
  SyncCounter counter_;
  SyncHold hold_;
  SyncGate gate_;
  ArrivalPrediction prediction_;
  WireTime wire_;
  std::vector<StampedFrame> received_;
  std::array<bool, 128> exchanging_{};
  std::vector<std::uint8_t> quick_stopped_;  ///< per axis of stop_: after the loss of a node
  bool hearing_ = false;                     ///< PDOs of some node are taken
  BusStatus status_;
  Reply reply_;
  Request request_;
  bool reply_waits_ = false;
  bool done_ = false;
  bool gate_open_ = true;   ///< frames may be sent in this cycle
  unsigned starved_ = 0;    ///< cycles in which service frames found no room
  std::uint64_t held_ = 0;  ///< cycles since it was open
  Time sync_sent_{};        ///< of this cycle
  Time sync_time_{};        ///< the same, by its echo where there is one
  Time last_status_{};
};

}  // namespace takt

#include "master/rt/bus_loop_impl.hpp"
