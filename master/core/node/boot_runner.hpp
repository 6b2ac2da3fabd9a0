#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/firmware.hpp"
#include "eds_parser/table/output_limits.hpp"
#include "eds_parser/table/waits.hpp"
#include "master/core/event.hpp"
#include "master/core/request.hpp"
#include "master/core/sdo/sdo_client.hpp"

namespace takt {

/// Runs the BootPlan of one node over its SDO client, as an interpreter of the steps. Uploads
/// without an answer are repeated, downloads are not. A write that the device refuses because of
/// its state is sent a second time in PRE-OPERATIONAL. Every wait has a deadline. Bus thread only.
/// CiA 302-2.
class BootRunner {
 public:
  enum class State : std::uint8_t { idle, running, done, failed };
  /// Where a boot begins.
  enum class From : std::uint8_t {
    beginning,
    bootup,  ///< The node has just sent its boot-up message, so the boot skips the reset at its
             ///< beginning.
    silent,  ///< The node may be OPERATIONAL: its error control is set up first, then the boot goes
             ///< on as with `beginning`.
    identity,  ///< The last boot has found another device: only the identity is read. If it is
               ///< right, the boot goes on as with `beginning`.
  };

  /// `plan` must outlive the runner. The caller passes the SDO client to each call; it must always
  /// be the same one.
  explicit BootRunner(const BootPlan& plan) noexcept;

  /// Begins a boot.
  void start(From from, Time now) noexcept;
  /// Ends the boot; the state is idle.
  void stop() noexcept { state_ = State::idle; }

  /// Handles a boot-up message. Either the current step waits for it, or the node has restarted and
  /// the plan begins again.
  void on_bootup(Time now, SdoClient& client) noexcept;
  /// Takes a heartbeat or a guarding answer.
  void on_heartbeat(NmtState state) noexcept;
  /// Takes the results of the client and runs the plan until a step has to wait.
  void on_time(Time now, SdoClient& client) noexcept;
  /// The deadline of the waits of the runner; the client has its own deadline.
  Time deadline() const noexcept;
  /// Extends all deadlines by the time for which the master itself did not run.
  void excuse(Time away) noexcept;

  /// The NMT command that waits to be sent to the node; call nmt_sent() after it was sent. Besides
  /// the commands of the plan, the runner sends PRE-OPERATIONAL before a write, unless the node is
  /// known to be in that state.
  std::optional<NmtCommand> nmt_to_send() const noexcept;
  /// The command of nmt_to_send() was sent.
  void nmt_sent(Time now, SdoClient& client) noexcept;

  State state() const noexcept { return state_; }
  /// Returns true while the runner probes whether the node exists. The node may then remain silent.
  bool probing() const noexcept {
    return step_ < plan_->steps.size() && current().action == BootAction::probe;
  }
  /// The current step, as an index into BootPlan::steps.
  std::uint16_t step() const noexcept {
    return asks_ ? static_cast<std::uint16_t>(after_reset_) : step_;
  }
  /// When this boot began.
  Time began() const noexcept { return began_; }
  /// This boot has sent a reset to the node.
  bool reset_sent() const noexcept { return reset_sent_; }
  /// NMT start was sent. PDOs may arrive, because their mapping is verified.
  bool started() const noexcept { return started_; }
  /// The node was OPERATIONAL and the boot leaves it in that state. CiA 302-2, status L.
  bool keeps_running() const noexcept { return running_; }
  /// The node was OPERATIONAL when this boot sent it to PRE-OPERATIONAL, and was not started since.
  bool took_out() const noexcept { return took_out_ && !started_; }
  /// The boot has read nothing but the identity so far (From::identity). The value stays true if
  /// the identity was wrong.
  bool identifies() const noexcept { return identifies_; }
  /// Number of objects that differ from the plan in a node that was left OPERATIONAL.
  std::uint16_t left_alone() const noexcept { return left_alone_; }
  /// The first object that left_alone() counts.
  ObjectKey first_left_alone() const noexcept { return first_left_alone_; }
  /// Serial number of the device, if the plan reads it.
  std::optional<std::uint32_t> serial_number() const noexcept { return serial_number_; }
  /// Firmware version of the device, if the plan reads it.
  std::optional<Firmware> firmware() const noexcept { return firmware_; }
  /// The limits of the device that this boot has read.
  std::span<const LimitReading> limits() const noexcept {
    return std::span{limits_}.first(limits_read_);
  }
  /// Size in bytes of the program that is being downloaded; 0 means no download.
  std::size_t program_size() const noexcept;
  /// The plan has reached the step from which the node is guarded.
  bool guards() const noexcept { return guards_; }
  /// The record of the failure, valid in State::failed.
  const BootFailure& failure() const noexcept { return failure_; }

 private:
  enum class Phase : std::uint8_t {
    enter,  // The step has not begun.
    nmt,    // The NMT command of the step waits to be sent.
    preop,  // PRE-OPERATIONAL waits to be sent. Then the transfer continues with `after_preop_`.
    wait,   // The step waits for a time or a message.
    upload_next,  // An upload begins as soon as the client is idle.
    upload,
    download_next,
    download,
    confirm_next,  // A write that was refused as redundant, or not answered, is read back.
    confirm,
  };
  static constexpr std::uint8_t max_restarts = 5;
  static constexpr Time default_timeout = std::chrono::seconds{1};

  const BootStep& current() const noexcept { return plan_->steps[step_]; }
  void go_to(std::size_t step) noexcept;
  void next() noexcept { go_to(step_ + 1U); }
  void enter(Time now) noexcept;
  void begin(const BootStep& step) noexcept;
  bool skips(const BootStep& step) const noexcept;
  static bool asks(const BootStep& step) noexcept;
  bool needs_preop() const noexcept;
  bool retries_in_preop(std::uint32_t abort_code) noexcept;
  // Runs one part of a step. Returns false if the runner has to wait.
  bool proceed(Time now, SdoClient& client) noexcept;
  bool begin_transfer(Time now, SdoClient& client) noexcept;
  bool end_wait(Time now, const SdoClient& client) noexcept;
  void on_result(const SdoResult& result, Time now, SdoClient& client) noexcept;
  void on_uploaded(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_polled(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_differs(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  bool end_sign_of_life(bool over, Time now, const SdoClient& client) noexcept;
  void on_downloaded(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_confirmed(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_written() noexcept;
  void take_firmware() noexcept;
  void take_limit() noexcept;
  void remember_cob_id() noexcept;
  void write_cob_id() noexcept;
  void fail(const SdoResult& result, Time now, const SdoClient& client) noexcept {
    fail(result, current().letter, now, client);
  }
  void fail(const SdoResult& result, char letter, Time now, const SdoClient& client) noexcept;
  bool polls() const noexcept {
    return current().action == BootAction::probe || current().action == BootAction::await_value;
  }
  bool knows_cob_id() const noexcept { return cob_id_object_ == current().object; }
  std::span<const std::byte> received() const noexcept {
    return std::span{buffer_}.first(received_);
  }

  const BootPlan* plan_;
  std::size_t after_reset_;  // first step after the reset with which the plan may begin
  State state_ = State::idle;
  Phase phase_ = Phase::enter;
  Phase after_preop_ = Phase::enter;
  std::uint16_t step_ = 0;
  std::uint8_t attempts_ = 0;
  std::uint8_t restarts_ = 0;
  bool differs_ = false;
  bool reset_sent_ = false;
  bool started_ = false;
  bool guards_ = false;
  bool running_ = false;
  bool asks_ = false;            // From::silent, until a sign of life comes
  bool identifies_ = false;      // From::identity, until the identity is right
  bool preoperational_ = false;  // the node was commanded to or reports PRE-OPERATIONAL, and has
                                 // reported no other state since
  bool preop_again_ = false;     // PRE-OPERATIONAL was sent a second time for this step
  bool took_out_ = false;        // the boot has taken the node out of OPERATIONAL
  bool wrote_ = false;
  std::uint16_t left_alone_ = 0;
  ObjectKey first_left_alone_;
  std::optional<std::uint32_t> serial_number_;
  std::optional<Firmware> firmware_;
  // Room for all limits that the plan reads; limits_read_ of them are valid.
  std::vector<LimitReading> limits_;
  std::size_t limits_read_ = 0;
  bool bootup_seen_ = false;
  bool bootup_in_step_ = false;
  bool heartbeat_in_step_ = false;
  NmtState heard_ = NmtState::unknown;
  bool heartbeat_seen_ = false;
  Time began_{};
  Time entered_{};                          // when the step began
  Time deadline_ = never;                   // deadline of the step
  Time wait_until_ = never;                 // end of a wait within the step
  std::optional<ObjectKey> cob_id_object_;  // the COB-ID object that was read or written last
  std::uint32_t cob_id_ = 0;
  std::span<const std::byte> to_write_;
  std::array<std::byte, 4> cob_id_bytes_{};
  SdoResult refused_;  // result of the write that is being read back
  SdoTrace refused_trace_;
  std::size_t received_ = 0;
  std::array<std::byte, request_bytes> buffer_{};
  BootFailure failure_;
};

}  // namespace takt
