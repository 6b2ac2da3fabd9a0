#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/boot_runner.hpp"
#include "master/core/event.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/machine.hpp"
#include "master/core/node_guard.hpp"
#include "master/core/node_status.hpp"
#include "master/core/node_watch.hpp"
#include "master/core/request_table.hpp"
#include "master/core/sdo_client.hpp"
#include "master/core/twin_watch.hpp"

namespace takt {

/// Keeps NMT commands apart. 0x102A, CiA 302-2.
class NmtGate {
 public:
  explicit NmtGate(Time inhibit) noexcept : inhibit_{inhibit} {}
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

enum class Managed : std::uint8_t {
  no,   ///< only watched: the master sends nothing by itself
  yes,  ///< booted, started, booted again when it comes back
};

/// All that the master has to do with one node: boots it, watches it, boots it again when it was
/// lost or has restarted, and works off the requests of applications between that.
class NodeSession {
 public:
  /// What all sessions share, owned by the network.
  struct Shared {
    EventQueue& events;
    RequestTable& requests;
    NmtGate& nmt_gate;
    std::uint8_t sub_block_segments;  ///< of a block upload
  };

  NodeSession(const NodePlan& plan, Managed managed, Shared shared) noexcept;

  void start(Time now) noexcept;
  void on_sdo_answer(const Frame& frame, Time now) noexcept;
  /// Heartbeat, guarding answer or boot-up message.
  void on_heartbeat(const Heartbeat& sign, Time now) noexcept;
  void on_emcy(const Frame& frame, Time now) noexcept;
  /// A request for this node has been accepted.
  void on_request(Time now) noexcept;
  /// Answers the request of this id that has its turn but was not sent so far; false: there is
  /// none.
  bool withdraw(std::uint64_t id) noexcept;
  /// An NMT command that covers this node has been sent for an application.
  void on_commanded(NmtCommand command, Time now) noexcept;
  /// False: it had nothing to send, or `out` has no room.
  bool on_time(Time now, Outbox& out) noexcept;
  Time deadline() const noexcept;
  /// The master itself was away for so long: no time-out of an answer or a heartbeat counts it.
  void excuse(Time away) noexcept;

  std::span<const LimitReading> limits_read() const noexcept { return runner_.limits(); }
  /// The boot has started the node and waits for a sign of that.
  bool starts() const noexcept { return booting() && runner_.started(); }
  /// The network is started: nodes that come later are started as soon as they are ready.
  void on_network_start() noexcept { network_started_ = true; }
  /// The network begins anew: nobody is started until it is complete.
  void on_network_reset() noexcept { network_started_ = status_.boot_tried = false; }
  /// A node that was ready has fallen silent; told once.
  bool take_loss() noexcept { return std::exchange(loss_, false); }
  /// NMT stop, and no boot until an application resets or starts the node.
  void halt() noexcept;
  /// The same without the command: it went to all nodes.
  void await_command() noexcept;

  /// An ordered stop has begun: a node that never was ready is not booted any more, so that its
  /// axes can be asked.
  void give_up_boot() noexcept;

  /// NMT stop to a node that is operational, until resume() starts it again.
  void pause() noexcept;
  void resume() noexcept;

  /// Gives up what is running and leaves the node with this command. A node that is kept alive goes
  /// to pre-operational instead of a reset.
  void begin_stop(NmtCommand last) noexcept;
  bool stopped() const noexcept;

  /// A block transfer is under way.
  bool streams() const noexcept { return client_.streams(); }
  /// The node sends a sub-block of a block upload, or was asked to.
  bool awaits_sub_block() const noexcept { return client_.awaits_sub_block(); }
  /// Its SDO server owes an answer. A node that is probed may not be there at all.
  bool awaits_answer() const noexcept {
    return client_.awaits_answer() && !(booting() && runner_.probing());
  }
  /// No boot has succeeded so far, and the newest one has failed because the device refused the SDO
  /// transfer of NodeStatus::boot_step.
  bool boot_refused() const noexcept {
    return status_.boot == BootState::failed && status_.boot_count == 0 &&
           last_failure_.fault == SdoFault::aborted_by_device &&
           last_failure_.step == status_.boot_step;
  }
  const NodeStatus& status() const noexcept { return status_; }
  /// No boot, no transfer and no command is under way.
  bool idle() const noexcept {
    return !booting() && active_ == nullptr && !own_command_ && client_.idle() && !stopping_ &&
           !loss_;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(status_, client_, watch_, guard_, twins_);
    state(retry_at_, retry_from_, wanted_, heartbeats_out_, state_at_boot_, emcys_at_boot_);
    state(same_failures_, failed_boots_, counter_excused_, serial_number_, progress_told_,
          bootups_);
    state(bootups_since_, silent_, halted_, paused_, network_started_);
    BootFailure& last = last_failure_;  // what the next one is compared with
    state(last.step, last.fault, last.abort_code, last.value, last.node_state, last.restarts);
  }

 private:
  void boot(BootRunner::From from, Time now) noexcept;
  void advance(Time now) noexcept;
  void follow_boot(Time now) noexcept;
  void follow_request(Time now) noexcept;
  void follow_transfer(Time now) noexcept;
  void answer_request(const SdoResult& result) noexcept;
  bool next_request() noexcept;
  void begin_request(Time now) noexcept;
  void on_boot_failed(Time now) noexcept;
  void on_boot_done(Time now) noexcept;
  void tell_progress(Time now) noexcept;
  void tell_replaced(Time now) noexcept;
  void tell_firmware(Time now) noexcept;
  bool restless(Time now) noexcept;
  void tell_twin(std::optional<DuplicateSign> sign, Time now) noexcept;
  void on_bootup(Time now) noexcept;
  bool take_guarding_answer(const Heartbeat& sign, Time now) noexcept;
  void look_for_silence(Time now) noexcept;
  void on_silence(EventKind kind, Time silence, Time now) noexcept;
  void look_for_fall(NmtState state, Time now) noexcept;
  void retry_later(BootState state, BootRunner::From from, Time now) noexcept;
  Time pause_before_retry() const noexcept;
  bool was_absent() const noexcept;
  void node_was_reset() noexcept;
  void disarm() noexcept;
  void assume(NmtState state, Time now) noexcept;
  void want(NmtState state, Time now) noexcept;
  void send_nmt(Time now, Outbox& out) noexcept;
  void send_guarding(Time now, Outbox& out) noexcept;
  void tell(EventKind kind, Time now, std::int64_t value = 0, std::uint32_t detail = 0) noexcept;
  bool booting() const noexcept { return status_.boot == BootState::booting; }
  bool waits_to_boot() const noexcept {
    return managed_ == Managed::yes && !stopping_ && !halted_ &&
           (status_.boot == BootState::failed || status_.boot == BootState::lost);
  }

  const NodePlan* plan_;
  Managed managed_;
  Shared shared_;
  NodeStatus status_;
  SdoClient client_;
  BootRunner runner_;
  NodeWatch watch_;
  NodeGuard guard_;
  RequestSlot* active_ = nullptr;
  Time next_look_ = never;  // at a transfer, whether it is still wanted
  Time retry_at_ = never;
  BootRunner::From retry_from_ = BootRunner::From::beginning;
  NmtState wanted_ = NmtState::unknown;  // by the newest NMT command
  int heartbeats_out_ = 0;               // in a row, of a ready node that should be operational
  NmtState state_at_boot_ = NmtState::unknown;
  std::uint32_t emcys_at_boot_ = 0;
  std::uint32_t same_failures_ = 0;  // in a row
  std::uint8_t failed_boots_ = 0;    // in a row, since a boot-up message or a command
  bool counter_excused_ = false;     // it was booted again for a SYNC that came too early
  BootFailure last_failure_;
  TwinWatch twins_;
  std::optional<std::uint32_t> serial_number_;  // of the device that was booted last
  std::uint32_t progress_told_ = 0;             // tenths of the program
  std::uint32_t bootups_ = 0;                   // since bootups_since_
  Time bootups_since_{};
  std::optional<NmtCommand> own_command_;  // not of the boot plan, waits to be sent
  bool silent_ = false;                    // heartbeat lost and not back
  bool stopping_ = false;
  bool halted_ = false;
  bool paused_ = false;
  bool loss_ = false;
  bool network_started_ = false;
};

}  // namespace takt
