#pragma once
#include <cstdint>
#include <optional>
#include <utility>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/machine.hpp"
#include "master/core/node/boot_retries.hpp"
#include "master/core/node/boot_runner.hpp"
#include "master/core/node/duplicate_node_watch.hpp"
#include "master/core/node/node_guard.hpp"
#include "master/core/node/node_requests.hpp"
#include "master/core/node/node_watch.hpp"
#include "master/core/node_status.hpp"
#include "master/core/request_table.hpp"
#include "master/core/sdo/sdo_client.hpp"

namespace takt {

/// Keeps the inhibit time between NMT commands. 0x102A, CiA 302-2.
class NmtGate {
 public:
  explicit NmtGate(Time inhibit) noexcept : inhibit_{inhibit} {}
  /// Returns true if the inhibit time is over, and a command may be sent.
  bool open(Time now) const noexcept { return now >= next_; }
  void sent(Time now) noexcept { next_ = now + inhibit_; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(next_);
  }

 private:
  Time inhibit_;
  Time next_{};
};

/// States whether the master manages a node.
enum class Managed : std::uint8_t {
  no,   ///< The node is only watched; the master sends it nothing by itself.
  yes,  ///< The master boots and starts the node, and boots it again when it comes back.
};

/// All work of the master for one node: it boots the node, watches it, boots it again after a loss
/// or a restart, and serves the requests of applications in between. Bus thread only.
///
/// NodeStatus::boot is the state of the boot. "application" is the state of Command, see below:
///
/// | boot                | event                             | next boot | sent                 |
/// | ------------------- | --------------------------------- | --------- | -------------------- |
/// | idle                | start()                           | booting   | boot                 |
/// | booting             | all steps have succeeded          | ready     | NMT start, if needed |
/// | booting             | a step has failed                 | failed    |                      |
/// | ready               | silence, not OPERATIONAL          | lost      |                      |
/// | ready               | boots up again and again          | lost      |                      |
/// | ready               | boot-up message, not application  | booting   | boot                 |
/// | ready               | boot-up message, application      | lost      |                      |
/// | failed, lost        | end of the pause, sign of life    | booting   | boot                 |
/// | ready, failed, lost | reset by an application           | lost      |                      |
/// | booting             | halt(), await_command()           | lost      |                      |
/// | booting             | give_up_boot(), was ready before  | lost      |                      |
/// | booting             | give_up_boot(), was never ready   | failed    |                      |
/// | any                 | begin_stop()                      | idle      |                      |
///
/// Command states who may start the node:
///
/// | command         | event                                | next command | sent                 |
/// | --------------- | ------------------------------------ | ------------ | -------------------- |
/// | network         | pause(), node OPERATIONAL            | paused       | NMT stop             |
/// | paused          | resume()                             | network      | NMT start            |
/// | network, paused | halt()                               | application  | NMT stop             |
/// | network, paused | await_command(), give_up_boot()      | application  |                      |
/// | application     | NMT start or reset by an application | network      |                      |
/// | any             | begin_stop()                         | stopping     | the last NMT command |
class NodeSession {
 public:
  /// Objects that all sessions share; the network owns them.
  struct Shared {
    EventQueue& events;
    RequestTable& requests;
    NmtGate& nmt_gate;
    std::uint8_t sub_block_segments;  ///< size of a sub-block of block uploads, in segments
  };

  NodeSession(const NodePlan& plan, Managed managed, Shared shared) noexcept;

  void start(Time now) noexcept;
  /// Takes a frame of the SDO server of the node.
  void on_sdo_answer(const Frame& frame, Time now) noexcept;
  /// Takes a heartbeat, guarding answer or boot-up message.
  void on_heartbeat(const Heartbeat& sign, Time now) noexcept;
  /// Takes an EMCY of any length.
  void on_emcy(const Frame& frame, Time now) noexcept;
  /// Notes that a request for this node has been accepted.
  void on_request(Time now) noexcept { advance(now); }
  /// Cancels and answers the active request if it has this id and nothing of it was sent so far.
  /// Returns false if there is no such request.
  bool withdraw(std::uint64_t id) noexcept { return requests_.withdraw(id, client_, status_); }
  /// Notes that an NMT command that covers this node has been sent for an application.
  void on_commanded(NmtCommand command, Time now) noexcept;
  /// Handles time-outs and sends frames. Returns false if nothing was sent, because there was
  /// nothing to send or `out` has no room.
  bool on_time(Time now, Outbox& out) noexcept;
  Time deadline() const noexcept;
  /// Extends all time-outs of answers and heartbeats by the time for which the master itself did
  /// not run.
  void extend_deadlines(Time away) noexcept;

  /// Returns the limits and quick stop option codes that the newest boot has read.
  std::span<const LimitReading> limits_read() const noexcept { return runner_.limits(); }
  /// Returns true if the boot has sent NMT start and waits for the confirmation.
  bool starts() const noexcept { return booting() && runner_.nmt().started(); }
  /// Notes that the network is started. Nodes that boot later are started as soon as they are
  /// ready.
  void on_network_start() noexcept { network_ = NetworkPhase::started; }
  /// Notes that the network starts up again. No node is started until the network is complete.
  void on_network_reset() noexcept {
    network_ = NetworkPhase::starting;
    status_.boot_tried = false;
  }
  /// Returns true once if the node was ready and has become silent.
  bool take_loss() noexcept { return std::exchange(loss_to_report_, false); }
  /// Sends NMT stop; the node is not booted until an application resets or starts it.
  void halt() noexcept;
  /// Keeps the node from being booted until an application resets or starts it, as halt() does.
  /// Sends no command, because a broadcast has already stopped the node.
  void await_command() noexcept;

  /// Ends the boot because an ordered stop has begun. The node is not booted any more, not even
  /// when it comes back. The SDO client is then free for the stop, which reads the state of the
  /// axes.
  void give_up_boot() noexcept;

  /// Sends NMT stop to an OPERATIONAL node, until resume() starts it again.
  void pause() noexcept;
  void resume() noexcept;

  /// Ends all running work and sends this last command to the node. A node with `keep_alive` goes
  /// to PRE-OPERATIONAL in any case.
  void begin_stop(NmtCommand last) noexcept;
  /// Returns true if begin_stop() was called, and the last command and all aborts were sent.
  bool stopped() const noexcept { return stopping() && !own_command_ && client_.idle(); }

  /// Returns true if a block transfer is running.
  bool streams() const noexcept { return client_.streams(); }
  /// Returns true if the node was requested to send a sub-block of a block upload, or is sending
  /// one.
  bool awaits_sub_block() const noexcept { return client_.awaits_sub_block(); }
  /// Returns true if an answer of the SDO server is outstanding. Probes do not count, because the
  /// node may not exist.
  bool awaits_answer() const noexcept {
    return client_.awaits_answer() && !(booting() && runner_.probing());
  }
  /// Returns true if no boot has succeeded so far, and the newest one has failed because the device
  /// refused the SDO transfer of NodeStatus::boot_step.
  bool boot_refused() const noexcept {
    const BootFailure& failure = retries_.last_failure();
    return status_.boot == BootState::failed && status_.boot_count == 0 &&
           failure.fault == SdoFault::aborted_by_device && failure.step == status_.boot_step;
  }
  const NodePlan& plan() const noexcept { return *plan_; }
  NodeStatus status() const noexcept;
  /// Returns true if the node is OPERATIONAL, and is booted or only watched. After an NMT command
  /// that ends the exchange of PDOs, two heartbeats in a row must show OPERATIONAL: the node may
  /// have sent the first one before it received the command.
  bool exchanges_pdos() const noexcept;
  /// Returns true if no boot and no transfer is running, and no command waits to be sent.
  bool idle() const noexcept {
    return !booting() && !requests_.active() && !own_command_ && client_.idle() && !stopping() &&
           !loss_to_report_;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(status_, client_, watch_, guard_, duplicates_, retries_, command_, network_);
    state(wanted_, heartbeats_out_, heartbeats_against_, state_at_boot_, emcys_at_boot_,
          serial_number_, progress_reported_);
  }

 private:
  enum class Command : std::uint8_t {
    network,      ///< The master boots and starts the node as the network file says.
    paused,       ///< SYNC of another device is lost; the node is started when it is back.
    application,  ///< The node was halted and waits for a command of an application.
    stopping,     ///< begin_stop() was called.
  };

  /// The phase of the start-up of the whole network, as the network has last reported it.
  enum class NetworkPhase : std::uint8_t { starting, started };

  // The boot, and its consequences (node_boot.cpp).
  void boot(BootRunner::From from, Time now) noexcept;
  void follow_boot(Time now) noexcept;
  void on_boot_failed(Time now) noexcept;
  void on_boot_done(Time now) noexcept;
  void boot_later(BootState state, BootRunner::From from, Time now) noexcept;
  bool was_absent() const noexcept;
  void report_boot_done(Time now) noexcept;
  void report_progress(Time now) noexcept;
  void report_replaced(Time now) noexcept;
  void report_firmware(Time now) noexcept;
  // NMT commands and their consequences (node_nmt.cpp).
  void follow_command(NmtCommand command, Time now) noexcept;
  void assume(NmtState state, Time now) noexcept;
  void want(NmtState state, Time now) noexcept;
  void on_node_reset() noexcept;
  void disarm() noexcept;
  bool push_nmt(NmtCommand command, Time now, Outbox& out) noexcept;
  void send_own_command(Time now, Outbox& out) noexcept;
  void send_boot_command(Time now, Outbox& out) noexcept;
  // Takes what the node reports.
  void advance(Time now) noexcept;
  void on_bootup(Time now) noexcept;
  bool take_guarding_answer(const Heartbeat& sign, Time now) noexcept;
  void look_for_silence(Time now) noexcept;
  void on_silence(EventKind kind, Time silence, Time now) noexcept;
  bool ends_exchange() const noexcept {
    return wanted_ == NmtState::stopped || wanted_ == NmtState::preoperational;
  }
  void look_for_fall(NmtState state, Time now) noexcept;
  void report_duplicate(std::optional<DuplicateSign> sign, Time now) noexcept;
  void announce(EventKind kind, Time now, std::int64_t value = 0,
                std::uint32_t detail = 0) noexcept;

  bool booting() const noexcept { return status_.boot == BootState::booting; }
  bool stopping() const noexcept { return command_ == Command::stopping; }
  bool waits_to_boot() const noexcept {
    return managed_ == Managed::yes && !stopping() && command_ != Command::application &&
           (status_.boot == BootState::failed || status_.boot == BootState::lost);
  }

  const NodePlan* plan_;
  Managed managed_;
  Shared shared_;
  NodeStatus status_;
  Command command_ = Command::network;
  SdoClient client_;
  BootRunner runner_;
  BootRetries retries_;
  NodeRequests requests_;
  NodeWatch watch_;
  NodeGuard guard_;
  DuplicateNodeWatch duplicates_;
  // A command that waits to be sent and does not belong to the boot plan.
  std::optional<NmtCommand> own_command_;
  NmtState wanted_ = NmtState::unknown;  // the state that the newest NMT command demands
  // Heartbeats in a row in which a ready node is not OPERATIONAL although it should be.
  int heartbeats_out_ = 0;
  // Heartbeats in a row with OPERATIONAL although the newest NMT command demands another state.
  int heartbeats_against_ = 0;
  NmtState state_at_boot_ = NmtState::unknown;
  std::uint32_t emcys_at_boot_ = 0;
  std::optional<std::uint32_t> serial_number_;  // serial number of the device that was booted last
  std::uint32_t progress_reported_ = 0;         // tenths of the program that were reported
  bool loss_to_report_ = false;                 // a loss that take_loss() has not returned yet
  NetworkPhase network_ = NetworkPhase::starting;
};

}  // namespace takt
