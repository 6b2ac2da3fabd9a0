#pragma once
#include <cstddef>
#include <span>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/core/machine.hpp"
#include "master/core/node_status.hpp"
#include "master/core/request.hpp"

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
};

}  // namespace takt
