#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/machine.hpp"
#include "master/core/node_session.hpp"
#include "master/core/node_status.hpp"
#include "master/core/request.hpp"
#include "master/core/request_table.hpp"

namespace takt {

struct NetworkOptions {
  bool observe = false;  ///< listen only: nothing is ever sent
};

/// The NMT master: owns the machines of all nodes, routes service frames to them and shares the
/// frame budget between them. Bus thread only; nothing allocates after construction. `plan` must
/// outlive it.
class Network {
 public:
  explicit Network(const BusPlan& plan, NetworkOptions options = {});
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// Begins to boot all nodes (not when observing).
  void start(Time now) noexcept;
  /// Takes service frames of nodes (SDO answers, heartbeats, EMCY); others are ignored. O(1). What
  /// it makes the master say leaves with on_time, within the budget; `out` is not used.
  void on_frame(const Frame& frame, Time now, Outbox& out) noexcept;
  /// Time-outs, new SDO requests, heartbeat of the master, NMT. Pushes at most `service_frames`
  /// frames, fewer where `out` has less room.
  void on_time(Time now, Outbox& out) noexcept;
  /// When on_time is to be called; in the past while frames wait to be sent.
  Time deadline() const noexcept;

  /// False: queue full, the caller answers. Every accepted request is answered exactly once.
  bool submit(const Request& request, Time now) noexcept;
  bool take(Reply& reply) noexcept;
  bool take(Event& event) noexcept;

  /// In the order of plan.nodes.
  std::span<const NodeStatus> nodes() const noexcept;
  /// Booted and, as far as is known, OPERATIONAL.
  bool exchanges_pdos(std::size_t node_index) const noexcept;

  /// NMT part of the ordered stop: pending requests are answered, nodes go to pre-operational.
  void begin_stop(Time now) noexcept;
  /// All frames of the stop have been handed out.
  bool stopped() const noexcept;

 private:
  static constexpr std::uint8_t no_session = 0xFF;

  NodeSession* session(std::uint32_t node) noexcept;
  void touched(std::size_t index) noexcept;
  void send_heartbeat(Time now, Outbox& out) noexcept;
  void send_commands(Time now, Outbox& out) noexcept;
  void run_sessions(Time now, Outbox& out) noexcept;
  Time first_deadline() const noexcept;
  std::size_t following(std::size_t index) const noexcept;

  const BusPlan& plan_;
  bool observe_;
  bool stopping_ = false;
  EventQueue events_;
  RequestTable requests_;
  std::vector<NodeSession> sessions_;    // order of plan.nodes
  std::vector<NodeStatus> statuses_;     // copies, one block for the reader
  std::vector<Time> deadlines_;          // of the sessions, one block to search
  std::array<std::uint8_t, 128> index_;  // node id -> session
  std::size_t turn_ = 0;                 // session that sends first, round robin
  RequestSlot* command_ = nullptr;       // NMT request that waits to be sent
  NmtState own_state_ = NmtState::bootup;
  Time heartbeat_at_ = never;
};
static_assert(Machine<Network>);

}  // namespace takt
