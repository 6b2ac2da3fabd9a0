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
#include "master/core/sdo_client.hpp"

namespace takt {

/// Runs the BootPlan of one node over its SDO client: a small interpreter of the steps. Uploads
/// that get no answer are repeated, downloads never. Every wait has a deadline. CiA 302-2.
class BootRunner {
 public:
  enum class State : std::uint8_t { idle, running, done, failed };
  enum class From : std::uint8_t {
    beginning,
    bootup,    ///< the node has just said boot-up: the reset at the beginning isn't needed
    silent,    ///< it may be OPERATIONAL: its error control is set up first, then `beginning`
    identity,  ///< it was another device: it is only asked who it is; the right one: `beginning`
  };

  /// `plan` must outlive the runner. The client is lent to each call, always the same one.
  explicit BootRunner(const BootPlan& plan) noexcept;

  void start(From from, Time now) noexcept;
  void stop() noexcept { state_ = State::idle; }

  /// A boot-up message: awaited, or the node has restarted and its plan runs anew.
  void on_bootup(Time now, SdoClient& client) noexcept;
  void on_heartbeat(NmtState state) noexcept;
  /// Goes as far as it can; takes the results of the client.
  void on_time(Time now, SdoClient& client) noexcept;
  /// Of its own waits; the client has its own.
  Time deadline() const noexcept;
  /// The master itself was away for so long: nothing that is awaited is late by that.
  void excuse(Time away) noexcept;

  /// NMT command that waits to be sent to the node; nmt_sent tells that it was. Besides those of
  /// the plan: PRE-OPERATIONAL before something is written, unless the node says that it is.
  std::optional<NmtCommand> nmt_to_send() const noexcept;
  void nmt_sent(Time now, SdoClient& client) noexcept;

  State state() const noexcept { return state_; }
  /// Asks whether the node is there at all: it owes no answer.
  bool probing() const noexcept {
    return step_ < plan_->steps.size() && current().action == BootAction::probe;
  }
  std::uint16_t step() const noexcept {
    return asks_ ? static_cast<std::uint16_t>(after_reset_) : step_;
  }
  Time began() const noexcept { return began_; }
  bool reset_sent() const noexcept { return reset_sent_; }
  /// NMT start was sent: PDOs may come, its mapping is verified.
  bool started() const noexcept { return started_; }
  /// The node was OPERATIONAL and is left as it is. CiA 302-2, status L.
  bool keeps_running() const noexcept { return running_; }
  /// The node was OPERATIONAL when it was told PRE-OPERATIONAL, and was not started since.
  bool took_out() const noexcept { return took_out_ && !started_; }
  /// Only the identity is asked for. Still true when this has failed.
  bool identifies() const noexcept { return identifies_; }
  /// Objects of such a node that differ from the plan, and the first of them.
  std::uint16_t left_alone() const noexcept { return left_alone_; }
  ObjectKey first_left_alone() const noexcept { return first_left_alone_; }
  std::optional<std::uint32_t> serial_number() const noexcept { return serial_number_; }
  /// As the device tells it, where the plan asks.
  std::optional<Firmware> firmware() const noexcept { return firmware_; }
  /// What this boot has read of the limits of the device.
  std::span<const LimitReading> limits() const noexcept {
    return std::span{limits_}.first(limits_read_);
  }
  /// Bytes of the program that is being downloaded; 0: none is.
  std::size_t program_size() const noexcept;
  /// The plan has come to where the node is guarded.
  bool guards() const noexcept { return guards_; }
  const BootFailure& failure() const noexcept { return failure_; }

 private:
  enum class Phase : std::uint8_t {
    enter,        // the step has not begun
    nmt,          // its command waits to be sent
    preop,        // PRE-OPERATIONAL waits to be sent; then the transfer goes on at `after_preop_`
    wait,         // for time or a message
    upload_next,  // an upload is to begin as soon as the client is idle
    upload,
    download_next,
    download,
    confirm_next,  // a write that was refused as redundant, or not answered, is read back
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
  // False: has to wait.
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
  std::size_t after_reset_;  // first step behind the reset that the plan may begin with
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
  bool asks_ = false;            // From::silent, until a sign of life
  bool identifies_ = false;      // From::identity, until the identity is right
  bool preoperational_ = false;  // it was told so or says so, and said nothing else since
  bool took_out_ = false;        // of OPERATIONAL
  bool wrote_ = false;
  std::uint16_t left_alone_ = 0;
  ObjectKey first_left_alone_;
  std::optional<std::uint32_t> serial_number_;
  std::optional<Firmware> firmware_;
  std::vector<LimitReading> limits_;  // as many as the plan reads, of which so many are there:
  std::size_t limits_read_ = 0;
  bool bootup_seen_ = false;
  bool bootup_in_step_ = false;
  bool heartbeat_in_step_ = false;
  NmtState heard_ = NmtState::unknown;
  bool heartbeat_seen_ = false;
  Time began_{};
  Time deadline_ = never;                   // of the step
  Time wait_until_ = never;                 // of the wait in it
  std::optional<ObjectKey> cob_id_object_;  // of the COB-ID entry that was read last
  std::uint32_t cob_id_ = 0;
  std::span<const std::byte> to_write_;
  std::array<std::byte, 4> cob_id_bytes_{};
  SdoResult refused_;  // why the write that is being confirmed failed
  Frame refused_sent_;
  Frame refused_received_;
  std::size_t received_ = 0;
  std::array<std::byte, request_bytes> buffer_{};
  BootFailure failure_;
};

}  // namespace takt
