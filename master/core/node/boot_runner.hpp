#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/firmware.hpp"
#include "eds_parser/table/output_limits.hpp"
#include "master/core/event.hpp"
#include "master/core/node/boot_course.hpp"
#include "master/core/node/cob_id_memory.hpp"
#include "master/core/node/known_nmt_state.hpp"
#include "master/core/node/limit_readings.hpp"
#include "master/core/request.hpp"
#include "master/core/sdo/sdo_client.hpp"

namespace takt {

/// Runs the BootPlan of one node over its SDO client, as an interpreter of the steps. Uploads
/// without an answer are repeated, downloads are not. A write that the device refuses because of
/// its state is sent a second time in PRE-OPERATIONAL. Every wait has a deadline. Bus thread only.
/// CiA 302-2.
///
/// | state              | event                          | next state       | sent            |
/// | ------------------ | ------------------------------ | ---------------- | --------------- |
/// | idle, done, failed | start()                        | entering         |                 |
/// | entering           | step that is skipped           | entering         |                 |
/// | entering           | NMT command                    | commanding       | the command     |
/// | entering           | wait                           | waiting          |                 |
/// | entering           | read, write                    | before_transfer  |                 |
/// | entering           | end of the plan                | done             |                 |
/// | commanding         | the command was sent           | entering         |                 |
/// | waiting            | sign of life, or time is over  | entering, failed |                 |
/// | waiting            | time to poll again             | before_transfer  |                 |
/// | before_transfer    | write, not PRE-OPERATIONAL     | before_preop     | PRE-OPERATIONAL |
/// | before_preop       | the command was sent           | before_transfer  |                 |
/// | before_transfer    | the client is idle             | in_transfer      | SDO requests    |
/// | in_transfer        | result, step is over           | entering         |                 |
/// | in_transfer        | result, more to transfer       | before_transfer  |                 |
/// | in_transfer        | result, not reached yet        | waiting          |                 |
/// | in_transfer        | result, wrong                  | failed           |                 |
/// | waiting, before_*  | boot-up message not waited for | entering, failed |                 |
/// | in_transfer        | boot-up message not waited for | entering, failed |                 |
/// | waiting            | the same, in a step that polls | before_transfer  |                 |
/// | in_transfer        | the same, in a step that polls | before_transfer  |                 |
/// | any                | stop()                         | idle             |                 |
///
/// BootCourse is a second state. It decides which steps this boot runs.
class BootRunner {
 public:
  /// The point at which a boot begins.
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
  /// Returns true if all steps have succeeded.
  bool done() const noexcept { return state_ == State::done; }
  /// Returns true if a step has failed; failure() says why.
  bool failed() const noexcept { return state_ == State::failed; }

  /// Handles a boot-up message. Either the current step waits for it, or the node has restarted and
  /// the plan begins again.
  void on_bootup(Time now, SdoClient& client) noexcept;
  /// Takes a heartbeat or a guarding answer.
  void on_heartbeat(NmtState state) noexcept;
  /// Takes the results of the client and runs the plan until a step has to wait.
  void on_time(Time now, SdoClient& client) noexcept;
  /// Returns the time until which the runner itself waits. The deadline of the SDO client is not
  /// part of it.
  Time deadline() const noexcept;
  /// Extends all deadlines by the time for which the master itself did not run.
  void extend_deadlines(Time away) noexcept;

  /// Returns the NMT command that waits to be sent to the node; call nmt_sent() after it was sent.
  /// Besides the commands of the plan, the runner sends PRE-OPERATIONAL before a write, unless the
  /// node is known to be in that state.
  std::optional<NmtCommand> nmt_to_send() const noexcept;
  /// Notes that the command of nmt_to_send() was sent.
  void nmt_sent(SdoClient& client) noexcept;

  /// Returns true while the runner probes whether the node exists. The node may then remain silent.
  bool probing() const noexcept {
    return step_ < plan_->steps.size() && current().action == BootAction::probe;
  }
  /// Returns the current step, as an index into BootPlan::steps.
  std::uint16_t step() const noexcept {
    return course_ == BootCourse::probing_silent_node ? static_cast<std::uint16_t>(after_reset_)
                                                      : step_;
  }
  /// Returns the time at which this boot began.
  Time began() const noexcept { return began_; }
  /// Returns the NMT state of the node and the changes that this boot has made to it. After the NMT
  /// start, PDOs may be accepted, because their mapping is verified.
  const KnownNmtState& nmt() const noexcept { return nmt_; }
  /// Returns true if the node was OPERATIONAL and the boot leaves it in that state. CiA 302-2,
  /// status L.
  bool keeps_running() const noexcept { return course_ == BootCourse::keeping_operational; }
  /// Returns true if the boot has read nothing but the identity so far (From::identity). The value
  /// stays true if the identity was wrong.
  bool identifies() const noexcept { return course_ == BootCourse::identifying; }
  /// Returns the number of objects that differ from the plan in a node that was left OPERATIONAL.
  std::uint16_t left_alone() const noexcept { return left_alone_; }
  /// Returns the first object that left_alone() counts.
  ObjectKey first_left_alone() const noexcept { return first_left_alone_; }
  /// Returns the serial number of the device, if the plan reads it.
  std::optional<std::uint32_t> serial_number() const noexcept { return serial_number_; }
  /// Returns the firmware version of the device, if the plan reads it.
  std::optional<Firmware> firmware() const noexcept { return firmware_; }
  /// Returns the limits and quick stop option codes that this boot has read.
  std::span<const LimitReading> limits() const noexcept { return limits_.all(); }
  /// Returns the size in bytes of the program that is being downloaded; 0 means no download.
  std::size_t program_size() const noexcept;
  /// Returns true if the plan has reached the step from which the node is guarded.
  bool guards() const noexcept { return guarding_ == Guarding::begun; }
  /// Returns the record of the failure, valid if failed().
  const BootFailure& failure() const noexcept { return failure_; }

 private:
  enum class State : std::uint8_t {
    idle,
    entering,         ///< The step has not begun.
    commanding,       ///< The NMT command of the step waits to be sent.
    waiting,          ///< The step waits for a time or a message.
    before_preop,     ///< PRE-OPERATIONAL waits to be sent; the transfer follows.
    before_transfer,  ///< The transfer begins as soon as the client is idle.
    in_transfer,
    done,
    failed,
  };
  /// The SDO transfer of the step, in `before_preop`, `before_transfer` and `in_transfer`.
  enum class Transfer : std::uint8_t {
    upload,
    download,
    read_back,  ///< A write that was refused as redundant, or not answered, is read back.
  };
  /// The values that were compared since the newest BootAction::skip_if_same.
  enum class Compared : std::uint8_t { same, differs };
  /// States whether this boot has written to the device, see BootAction::write_if_changed.
  enum class Device : std::uint8_t { untouched, written };
  /// States whether the guarding of the node has begun.
  enum class Guarding : std::uint8_t { not_yet, begun };
  /// The progress of the current step.
  struct Progress {
    Time entered{};
    Time deadline = never;    ///< deadline of the step
    Time wait_until = never;  ///< end of a wait within the step
    std::uint8_t uploads = 0;
    bool sign_came = false;    ///< the message for which the step waits has come
    bool preop_again = false;  ///< PRE-OPERATIONAL was sent a second time
    std::size_t received = 0;  ///< bytes of the newest upload
  };
  /// A write that is being read back.
  struct RefusedWrite {
    SdoResult result;
    SdoTrace trace;
  };
  static constexpr std::uint8_t max_restarts = 5;
  static constexpr Time default_timeout = std::chrono::seconds{1};

  bool runs() const noexcept {
    return state_ != State::idle && state_ != State::done && state_ != State::failed;
  }
  const BootStep& current() const noexcept { return plan_->steps[step_]; }
  void go_to(std::size_t step) noexcept;
  void next() noexcept { go_to(step_ + 1U); }
  void go_to_transfer(Transfer transfer) noexcept {
    state_ = State::before_transfer;
    transfer_ = transfer;
  }
  void write(std::span<const std::byte> value) noexcept {
    to_write_ = value;
    go_to_transfer(Transfer::download);
  }
  void enter(Time now) noexcept;
  void begin(const BootStep& step) noexcept;
  bool needs_preop() const noexcept;
  bool retries_in_preop(std::uint32_t abort_code) noexcept;
  // Runs one part of a step. Returns false if the runner has to wait.
  bool proceed(Time now, SdoClient& client) noexcept;
  bool begin_transfer(Time now, SdoClient& client) noexcept;
  bool end_wait(Time now, const SdoClient& client) noexcept;
  bool end_sign_of_life(bool over, Time now, const SdoClient& client) noexcept;
  void on_result(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_uploaded(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_polled(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_differs(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_downloaded(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_read_back(const SdoResult& result, Time now, const SdoClient& client) noexcept;
  void on_written() noexcept;
  void take_value() noexcept;
  void write_cob_id() noexcept;
  void fail(const SdoResult& result, Time now, const SdoClient& client) noexcept {
    fail(result, current().letter, now, client);
  }
  void fail(const SdoResult& result, char letter, Time now, const SdoClient& client) noexcept;
  bool polls() const noexcept {
    return current().action == BootAction::probe || current().action == BootAction::await_value;
  }
  std::span<const std::byte> received() const noexcept {
    return std::span{buffer_}.first(progress_.received);
  }

  const BootPlan* plan_;
  std::size_t after_reset_;  // first step after the reset with which the plan may begin
  State state_ = State::idle;
  Transfer transfer_ = Transfer::upload;
  BootCourse course_ = BootCourse::configuring;
  std::uint16_t step_ = 0;
  std::uint8_t restarts_ = 0;
  Compared compared_ = Compared::same;
  Device device_ = Device::untouched;
  Guarding guarding_ = Guarding::not_yet;
  Progress progress_;
  KnownNmtState nmt_;
  CobIdMemory cob_id_;
  Time began_{};
  std::uint16_t left_alone_ = 0;
  ObjectKey first_left_alone_;
  std::optional<std::uint32_t> serial_number_;
  std::optional<Firmware> firmware_;
  LimitReadings limits_;
  std::span<const std::byte> to_write_;
  std::array<std::byte, 4> cob_id_bytes_{};
  RefusedWrite refused_;
  std::array<std::byte, request_bytes> buffer_{};
  BootFailure failure_;
};

}  // namespace takt
