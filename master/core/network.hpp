#pragma once
#include <algorithm>
#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/fixed_queue.hpp"
#include "master/core/lss_service.hpp"
#include "master/core/machine.hpp"
#include "master/core/network_start.hpp"
#include "master/core/node_session.hpp"
#include "master/core/node_status.hpp"
#include "master/core/own_dictionary.hpp"
#include "master/core/request.hpp"
#include "master/core/request_table.hpp"
#include "master/core/sdo_server.hpp"

namespace takt {

/// When an NMT command leaves that ends the PDO exchange of axes.
enum class NmtStop : std::uint8_t {
  immediate,
  after_axes,  ///< when axes_at_rest() says that the axes which it reaches were stopped
};

/// How the axes are for which an NMT command has waited.
enum class AxesAtRest : std::uint8_t {
  confirmed,    ///< each was seen at standstill and disabled, or was disabled before
  unconfirmed,  ///< some was not: the command leaves, and its answer says so
};

struct NetworkOptions {
  bool observe = false;  ///< listen only: nothing is ever sent
  NmtStop nmt_stop = NmtStop::immediate;
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
  /// Takes service frames of nodes (SDO and LSS answers, heartbeats, EMCY); others are ignored.
  /// O(1). What it makes the master say leaves with on_time, within the budget; `out` is not used.
  void on_frame(const Frame& frame, Time now, Outbox& out) noexcept;
  /// Time-outs, new SDO requests, heartbeat of the master, NMT, LSS. Pushes at most
  /// `service_frames` frames, fewer where `out` has less room.
  void on_time(Time now, Outbox& out) noexcept;
  /// When on_time is to be called; in the past while frames wait to be sent.
  Time deadline() const noexcept;

  /// False: queue full, the caller answers. Every accepted request is answered exactly once.
  bool submit(const Request& request, Time now) noexcept;
  bool take(Reply& reply) noexcept;
  /// An SDO download to this object of the node is not answered yet.
  bool writes(std::uint8_t node, ObjectKey object) const noexcept {
    return requests_.has_download(node, object);
  }
  /// Answers the requests of this id of which nothing was sent so far.
  void withdraw(std::uint64_t id) noexcept;
  bool take(Event& event) noexcept;
  std::uint64_t events_lost() const noexcept { return events_.lost(); }

  /// In the order of plan.nodes.
  std::span<const NodeStatus> nodes() const noexcept;
  /// Booted and, as far as is known, OPERATIONAL.
  bool exchanges_pdos(std::size_t node_index) const noexcept;
  /// Its boot has started it: it may be OPERATIONAL some time before it says so.
  bool starts(std::size_t node_index) const noexcept;

  /// See NodeSession::boot_refused.
  bool boot_refused(std::size_t node_index) const noexcept {
    return sessions_[node_index].boot_refused();
  }

  /// What the newest boot of this node has read of its limits.
  std::span<const LimitReading> limits_read(std::size_t node_index) const noexcept;

  /// The loss of some node stops drives.
  bool stops_drives() const noexcept { return stops_drives_; }
  /// Loss of a node demands that the drives of this node stop. LossReaction::quick_stop.
  bool demands_quick_stop(std::size_t node_index) const noexcept;
  /// A block transfer is under way: frames come without a request for each.
  bool streams() const noexcept { return streaming_ != 0; }
  /// Sub-blocks of block uploads that were asked for, frames still to be sent included.
  std::size_t awaited_sub_blocks() const noexcept;
  /// SDO answers that servers owe, to frames still to be sent included.
  std::size_t awaited_answers() const noexcept { return awaited_; }

  /// The master has left Stopped, or begins anew: the counter of its SYNC starts at 1; told once.
  /// CiA 301, 7.2.5.2.
  bool take_sync_restart() noexcept { return std::exchange(sync_restarts_, false); }

  /// The SYNC of another device is gone: NMT stop to every node but that one. SyncLoss::stop.
  void on_sync_loss() noexcept;
  /// It is back: they are started again.
  void on_sync_back() noexcept;

  /// The bus thread did not run for so long: that is no silence of a node.
  void on_absence(Time away) noexcept;

  /// NMT part of the ordered stop: pending requests are answered, nodes get their last command.
  /// With reset communication those of `keep_alive` go to pre-operational all the same.
  void begin_stop(Time now, NmtCommand last = NmtCommand::enter_preoperational) noexcept;
  /// NMT stop, or enter pre-operational, of this node (0: of all, or NMT stop of the master, which
  /// ends SYNC) waits for axes_at_rest().
  std::optional<std::uint8_t> awaits_axes() const noexcept { return awaits_axes_; }
  /// The axes of the command that waits were stopped, or their time is over: it may leave.
  void axes_at_rest(AxesAtRest how) noexcept {
    axes_at_rest_ = awaits_axes_;
    rest_ = how;
  }
  /// Every axis was stopped, for the rest of an ordered stop: no command waits any more.
  void every_axis_at_rest(AxesAtRest how) noexcept {
    axes_at_rest_ = 0;
    rest_ = how;
  }
  /// An ordered stop begins: the command that waits for its axes is answered and never leaves.
  void drop_awaiting() noexcept;
  /// An ordered stop begins: nodes that never were ready are not booted any more.
  void give_up_boots(Time now) noexcept;
  /// The master itself, as NMT has commanded it.
  NmtState own_state() const noexcept { return own_state_; }
  /// All frames of the stop have been handed out.
  bool stopped() const noexcept;
  /// Nothing is under way: keep() has all that is known.
  bool idle() const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(requests_, lss_, nmt_gate_, start_, sessions_, deadlines_, strangers_, own_state_,
          sync_restarts_, heartbeat_at_);
    state.position(turn_, std::max<std::size_t>(sessions_.size(), 1));
    for (std::size_t i = 0; i < sessions_.size(); ++i) statuses_[i] = sessions_[i].status();
  }

 private:
  static constexpr std::uint8_t no_session = 0xFF;

  NodeSession* session(std::uint32_t node) noexcept;
  void touched(std::size_t index, Time now) noexcept;
  void send_heartbeat(Time now, Outbox& out) noexcept;
  void send_commands(Time now, Outbox& out) noexcept;
  bool send_command(const NmtMessage& message, Time now, Outbox& out) noexcept;
  std::optional<std::uint8_t> axes_reached(const NmtMessage& message) const noexcept;
  bool waits_for_axes(const NmtMessage& message) const noexcept;
  void command_master(NmtCommand command) noexcept;
  void send_own_commands(Time now, Outbox& out) noexcept;
  void follow_start(Time now) noexcept;
  void begin_anew(Time now) noexcept;
  void on_loss(std::size_t index, Time now) noexcept;
  void on_mandatory_loss(Time now) noexcept;
  void halt_group(std::size_t index) noexcept;
  void meet_stranger(const Frame& frame, Time now) noexcept;
  void tell(EventKind kind, Time now, std::int64_t value, std::uint32_t detail,
            std::uint8_t node = 0) noexcept;
  NodeSession* emcy_sender(CobId id) noexcept;
  void ask_own_dictionary(const Frame& frame, Time now) noexcept;
  void serve_own_dictionary(Time now, Outbox& out) noexcept;
  void run_sessions(Time now, Outbox& out) noexcept;
  Time first_deadline() const noexcept;
  std::size_t following(std::size_t index) const noexcept;

  const BusPlan& plan_;
  bool observe_;
  NmtStop nmt_stop_;
  std::optional<std::uint8_t> awaits_axes_;   // node of the command that waits for its axes
  std::optional<std::uint8_t> axes_at_rest_;  // the same; it may leave
  AxesAtRest rest_ = AxesAtRest::confirmed;   // of axes_at_rest_
  bool stopping_ = false;
  bool stops_drives_ = false;  // some node's loss does
  EventQueue events_;
  RequestTable requests_;
  LssService lss_;
  NmtGate nmt_gate_;
  NetworkStart start_;
  FixedQueue<NmtMessage, 4> broadcasts_;  // of the master itself
  std::vector<NodeSession> sessions_;     // order of plan.nodes
  std::vector<NodeStatus> statuses_;      // copies, one block for the reader
  std::vector<bool> streams_;             // of the sessions
  std::size_t streaming_ = 0;             // how many of them
  std::vector<bool> awaits_;              // an SDO answer, of the sessions
  std::size_t awaited_ = 0;               // how many of them
  std::vector<Time> deadlines_;           // of the sessions, one block to search
  std::array<std::uint8_t, 128> index_;   // node id -> session
  std::vector<std::pair<CobId, std::uint8_t>>
      emcy_ids_;                            // other than 0x080 + id, and their session
  std::bitset<128> strangers_;              // ids that were told
  std::array<std::uint8_t, 2048> answers_;  // COB-ID of an SDO answer -> session
  OwnDictionary dictionary_;
  SdoServer server_;
  std::size_t turn_ = 0;            // session that sends first, round robin
  RequestSlot* command_ = nullptr;  // NMT request that waits to be sent
  NmtState own_state_ = NmtState::bootup;
  bool sync_restarts_ = false;
  Time heartbeat_at_ = never;
};
static_assert(Machine<Network>);

}  // namespace takt
