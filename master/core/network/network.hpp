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
#include "master/core/lss/lss_service.hpp"
#include "master/core/machine.hpp"
#include "master/core/network/network_start.hpp"
#include "master/core/node/node_session.hpp"
#include "master/core/node_status.hpp"
#include "master/core/request.hpp"
#include "master/core/request_table.hpp"
#include "master/core/sdo/own_dictionary.hpp"
#include "master/core/sdo/sdo_server.hpp"

namespace takt {

/// The time at which the master sends an NMT command that ends the PDO exchange of axes.
enum class NmtStop : std::uint8_t {
  /// The command is sent at once.
  immediate,
  after_axes,  ///< The command is sent when axes_at_rest() reports that the axes which it reaches
               ///< were stopped.
};

/// The state of the axes for which an NMT command has waited.
enum class AxesAtRest : std::uint8_t {
  confirmed,    ///< Each axis was seen at standstill and disabled, or was disabled before.
  unconfirmed,  ///< At least one axis was not seen at standstill and disabled. The command is sent
                ///< nevertheless, and its answer states this.
};

/// Options of a Network.
struct NetworkOptions {
  bool observe = false;  ///< The master only listens and sends nothing.
  NmtStop nmt_stop = NmtStop::immediate;
};

/// The NMT master. It owns the machines of all nodes, passes service frames to them, and divides
/// the frame budget among them. Bus thread only. No function allocates memory after the
/// construction. `plan` must outlive the network.
class Network {
 public:
  explicit Network(const BusPlan& plan, NetworkOptions options = {});
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// Begins to boot all nodes, unless the master only observes.
  void start(Time now) noexcept;
  /// Takes service frames of nodes (SDO and LSS answers, heartbeats, EMCY) and ignores all others.
  /// The function takes constant time. The reactions of the master are sent by on_time() within its
  /// budget; `out` is not used.
  void on_frame(const Frame& frame, Time now, Outbox& out) noexcept;
  /// Handles time-outs, new SDO requests, the heartbeat of the master, NMT and LSS. Adds at most
  /// `service_frames` frames, or fewer if `out` has less room.
  void on_time(Time now, Outbox& out) noexcept;
  /// Returns the time at which on_time() has to be called. It is in the past while frames wait to
  /// be sent.
  Time deadline() const noexcept;

  /// Accepts a request. Returns false if the queue is full; then the caller answers the request.
  /// Every accepted request is answered exactly once.
  bool submit(const Request& request, Time now) noexcept;
  /// Takes the next reply. Returns false if there is none.
  bool take(Reply& reply) noexcept { return requests_.take(reply); }
  /// Returns true if an SDO download to this object of the node is not answered yet.
  bool writes(std::uint8_t node, ObjectKey object) const noexcept {
    return requests_.has_download(node, object);
  }
  /// Cancels and answers the requests with this id of which nothing was sent so far.
  void withdraw(std::uint64_t id) noexcept;
  /// Takes the next event. Returns false if there is none.
  bool take(Event& event) noexcept { return events_.pop(event); }
  /// Returns the number of events that were lost because the queue was full.
  std::uint64_t events_lost() const noexcept { return events_.lost(); }

  /// Returns the status of all nodes, in the order of plan.nodes.
  std::span<const NodeStatus> nodes() const noexcept { return statuses_; }
  /// Returns true if the node is booted and, as far as is known, OPERATIONAL.
  bool exchanges_pdos(std::size_t node_index) const noexcept {
    return node_index < statuses_.size() && statuses_[node_index].exchanging;
  }
  /// Returns true if the boot of the node has sent NMT start. The node may be OPERATIONAL some time
  /// before it reports that state.
  bool starts(std::size_t node_index) const noexcept {
    return node_index < sessions_.size() && sessions_[node_index].starts();
  }

  /// Returns true if no boot of the node has succeeded so far, and the newest one has failed
  /// because the device refused an SDO transfer.
  bool boot_refused(std::size_t node_index) const noexcept {
    return sessions_[node_index].boot_refused();
  }

  /// Returns the limits and quick stop option codes that the newest boot of this node has read.
  std::span<const LimitReading> limits_read(std::size_t node_index) const noexcept;

  /// Returns true if the loss of some node of the plan stops drives.
  bool stops_drives() const noexcept { return stops_drives_; }
  /// Returns true if a node is lost, and its loss demands a quick stop of the drives of this node.
  /// LossReaction::quick_stop.
  bool demands_quick_stop(std::size_t node_index) const noexcept;
  /// Returns true if a block transfer is running, so that a device may send several frames after
  /// one request.
  bool streams() const noexcept { return streaming_ != 0; }
  /// Returns the number of sub-blocks of block uploads that were requested, including requests that
  /// are still to be sent.
  std::size_t awaited_sub_blocks() const noexcept;
  /// Returns the number of SDO answers that are outstanding, including answers to frames that are
  /// still to be sent.
  std::size_t awaited_answers() const noexcept { return awaited_; }

  /// Returns true once if the master has left the NMT state STOPPED or was reset, so that the
  /// counter of its SYNC starts at 1. CiA 301, 7.2.5.2.
  bool take_sync_restart() noexcept { return std::exchange(sync_restarts_, false); }

  /// Handles the loss of the SYNC of another device by an NMT stop of every other node, see
  /// SyncLoss::stop.
  void on_sync_loss() noexcept;
  /// Handles the return of the SYNC of another device: starts the nodes again.
  void on_sync_back() noexcept;

  /// Notes that the bus thread did not run for this time. The time does not count as silence of a
  /// node.
  void on_absence(Time away) noexcept;

  /// Begins the NMT part of the ordered stop: answers all pending requests and sends the last
  /// command to the nodes. Nodes with `keep_alive` go to PRE-OPERATIONAL in any case.
  void begin_stop(Time now, NmtCommand last = NmtCommand::enter_preoperational) noexcept;
  /// Returns the node whose NMT stop or enter pre-operational command waits for axes_at_rest(). 0
  /// stands for a command to all nodes, or for an NMT stop of the master itself, which ends SYNC.
  /// std::nullopt means that no command waits.
  std::optional<std::uint8_t> awaits_axes() const noexcept { return awaits_axes_; }
  /// Permits the waiting command, because its axes were stopped or their time is over.
  void axes_at_rest(AxesAtRest how) noexcept {
    axes_at_rest_ = awaits_axes_;
    rest_ = how;
  }
  /// Notes that every axis was stopped by an ordered stop; until its end, no command waits for
  /// axes.
  void every_axis_at_rest(AxesAtRest how) noexcept {
    axes_at_rest_ = 0;
    rest_ = how;
  }
  /// Answers and drops the NMT commands that are not sent yet, because an ordered stop begins.
  void drop_awaiting() noexcept;
  /// Gives up all boots, because an ordered stop begins. From now on, the master resets, boots and
  /// starts no node by itself, and takes no NMT command by its dictionary.
  void give_up_boots(Time now) noexcept;
  /// Returns the NMT state of the master itself.
  NmtState own_state() const noexcept { return own_state_; }
  /// Returns true if all frames of the stop have been passed to the outbox.
  bool stopped() const noexcept;
  /// Returns true if no boot, transfer or request is running, so that keep() covers the whole
  /// state.
  bool idle() const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(requests_, lss_, nmt_gate_, start_, sessions_, deadlines_, unlisted_nodes_, own_state_,
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
  template <class Change>
  void change_all(Change change) noexcept;
  void on_unlisted_node(const Frame& frame, Time now) noexcept;
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
  std::optional<std::uint8_t> axes_at_rest_;  // node of the command that may be sent
  AxesAtRest rest_ = AxesAtRest::confirmed;   // the state of the axes of that command
  bool stopping_ = false;
  bool boots_given_up_ = false;
  bool stops_drives_ = false;  // the loss of some node stops drives
  EventQueue events_;
  RequestTable requests_;
  LssService lss_;
  NmtGate nmt_gate_;
  NetworkStart start_;
  FixedQueue<NmtMessage, 4> broadcasts_;  // broadcasts of the master itself
  std::vector<NodeSession> sessions_;     // sessions in the order of plan.nodes
  // Copies of the statuses of the sessions, contiguous for the reader.
  std::vector<NodeStatus> statuses_;
  std::vector<bool> streams_;            // by session: a block transfer is running
  std::size_t streaming_ = 0;            // number of true entries in streams_
  std::vector<bool> awaits_;             // by session: an SDO answer is outstanding
  std::size_t awaited_ = 0;              // number of true entries in awaits_
  std::vector<Time> deadlines_;          // by session, contiguous for the search
  std::array<std::uint8_t, 128> index_;  // node-ID -> session
  // COB-IDs of EMCYs other than 0x080 + node-ID, and their sessions.
  std::vector<std::pair<CobId, std::uint8_t>> emcy_ids_;
  std::bitset<128> unlisted_nodes_;         // unlisted node-IDs that were reported
  std::array<std::uint8_t, 2048> answers_;  // COB-ID of an SDO answer -> session
  OwnDictionary dictionary_;
  SdoServer server_;
  std::size_t turn_ = 0;            // session that may send first (round robin)
  RequestSlot* command_ = nullptr;  // NMT request that waits to be sent
  NmtState own_state_ = NmtState::bootup;
  bool sync_restarts_ = false;
  Time heartbeat_at_ = never;
};
static_assert(Machine<Network>);

}  // namespace takt
