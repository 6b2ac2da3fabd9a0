#include <algorithm>
#include <utility>

#include "master/core/node/boot_runner.hpp"
#include "master/core/node/boot_value.hpp"

// SDO transfers of the boot steps, and the evaluation of their results.

namespace takt {
namespace {

constexpr std::uint32_t pdo_invalid = 0x8000'0000;  // CiA 301, 7.5.2.35, bit 31
constexpr std::uint32_t no_rtr = 0x4000'0000;       // bit 30: no RTR allowed

/// The object holds a COB-ID that may change only while its bit 31 is set.
bool is_cob_id(ObjectKey object) noexcept {
  if (object == ObjectKey{0x1014, 0}) return true;
  return object.sub == 1 && ((object.index >= 0x1400 && object.index <= 0x15FF) ||
                             (object.index >= 0x1800 && object.index <= 0x19FF));
}

}  // namespace

bool BootRunner::begin_transfer(Time now, SdoClient& client) noexcept {
  if (!client.idle()) return false;
  if (needs_preop()) {
    after_preop_ = std::exchange(phase_, Phase::preop);
    return false;
  }
  const BootStep& step = current();
  Time timeout = step.timeout > Time{} ? step.timeout : default_timeout;
  if (polls()) {
    timeout = std::max(Time{1}, std::min(waits::probe_try, deadline_ - now));
  }
  if (phase_ == Phase::download_next) {
    client.download(step.object, to_write_, timeout);
    phase_ = Phase::download;
    return true;
  }
  if (attempts_ < 255) ++attempts_;
  client.upload(step.object, buffer_, timeout);
  phase_ = phase_ == Phase::upload_next ? Phase::upload : Phase::confirm;
  return true;
}

/// Parameters are written in PRE-OPERATIONAL. A device that starts by itself leaves this state
/// unasked, and a device in STOPPED answers no SDO at all. A node that stays OPERATIONAL is not
/// written to.
bool BootRunner::needs_preop() const noexcept {
  if (preoperational_ || running_ || asks_) return false;
  return phase_ == Phase::download_next || heard_ == NmtState::stopped;
}

/// A device may start itself after the command PRE-OPERATIONAL, and then refuse a write because of
/// its state. A write that was refused may be repeated: it is sent once more, after a second
/// command.
bool BootRunner::retries_in_preop(std::uint32_t abort_code) noexcept {
  if (current().action == BootAction::download_program || preop_again_) return false;
  if (abort_code != abort_code::device_state || !preoperational_) return false;
  preop_again_ = true;
  preoperational_ = false;
  phase_ = Phase::download_next;
  return true;
}

void BootRunner::on_result(const SdoResult& result, Time now, SdoClient& client) noexcept {
  if (phase_ == Phase::download) return on_downloaded(result, now, client);
  received_ = result.fault == SdoFault::none ? result.size : 0;
  if (phase_ == Phase::confirm) return on_confirmed(result, now, client);
  if (polls()) return on_polled(result, now, client);
  on_uploaded(result, now, client);
}

void BootRunner::on_polled(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  const BootStep& step = current();
  const bool refused =
      result.fault == SdoFault::aborted_by_device && !means_busy(result.abort_code);
  const bool reached =
      step.action == BootAction::probe
          ? result.fault == SdoFault::none || result.fault == SdoFault::too_long
          : result.fault == SdoFault::none && same_value(received(), step.value, step.mask);
  if (reached || (refused && step.action == BootAction::probe)) return next();
  if (refused && may_be_missing(step, result.abort_code)) return next();
  if (now >= deadline_ || (refused && !step.may_restart)) return fail(result, now, client);
  const Time pause = step.action == BootAction::probe ? waits::probe_pause : waits::poll_pause;
  phase_ = Phase::wait;
  wait_until_ = result.fault == SdoFault::timeout ? now : std::min(now + pause, deadline_);
}

void BootRunner::on_uploaded(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  const BootStep& step = current();
  const bool silent = result.fault == SdoFault::timeout ||
                      result.fault == SdoFault::aborted_by_master ||
                      result.fault == SdoFault::cancelled;
  if (silent && attempts_ < waits::upload_attempts) {
    phase_ = Phase::upload_next;
    return;
  }
  if (result.fault != SdoFault::none && step.unread_letter != 0) {
    return fail(result, step.unread_letter, now, client);
  }
  if (silent) return fail(result, now, client);
  if (result.fault == SdoFault::none) remember_cob_id();
  const bool same = result.fault == SdoFault::none ? same_value(received(), step.value, step.mask)
                                                   : may_be_missing(step, result.abort_code);
  switch (step.action) {
    case BootAction::compare:
    case BootAction::write_if_differs:
      return same ? next() : on_differs(result, now, client);
    case BootAction::read_serial:
      if (result.fault == SdoFault::none) serial_number_ = load_le<std::uint32_t>(received());
      return next();
    case BootAction::read_firmware:
      if (result.fault == SdoFault::none) take_firmware();
      return next();
    case BootAction::read_limit:
      if (result.fault == SdoFault::none) take_limit();
      return next();
    case BootAction::disable_pdo:
    case BootAction::enable_pdo:
      if (cob_id_object_ == step.object) return write_cob_id();
      return fail(result, now, client);
    default:
      return same ? next() : fail(result, now, client);
  }
}

/// Handles a difference in a step that compares.
void BootRunner::on_differs(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  const BootStep& step = current();
  if (running_) {
    if (step.running_letter != 0) return fail(result, step.running_letter, now, client);
    if (left_alone_++ == 0) first_left_alone_ = step.object;
    return next();
  }
  if (step.action == BootAction::compare) {
    differs_ = true;
    return next();
  }
  to_write_ = step.value;
  phase_ = Phase::download_next;
}

/// Takes a limit; these objects have 32 bits. If the node restarts during its boot, the limit is
/// read again and replaces the earlier reading.
void BootRunner::take_limit() noexcept {
  const bool option = is_quick_stop_option(current().object);
  if (received_ != (option ? 2 : 4)) return;
  const std::uint32_t value =
      option ? load_le<std::uint16_t>(received()) : load_le<std::uint32_t>(received());
  const LimitReading reading{current().object, value};
  const auto place = std::ranges::find(limits(), reading.object, &LimitReading::object);
  const auto index = static_cast<std::size_t>(place - limits().begin());
  if (index == limits_.size()) return;
  limits_[index] = reading;
  limits_read_ = std::max(limits_read_, index + 1);
}

/// Takes the firmware version. The revision number in 0x1018 is a number; all other objects hold a
/// text.
void BootRunner::take_firmware() noexcept {
  const auto bytes = received();
  if (current().object.index == 0x1018) {
    firmware_ = Firmware::of_revision(load_le<std::uint32_t>(bytes));
    return;
  }
  std::array<char, 64> text{};
  const std::size_t size = std::min(bytes.size(), text.size());
  for (std::size_t i = 0; i < size; ++i) text[i] = std::to_integer<char>(bytes[i]);
  firmware_ = Firmware::find_in({text.data(), size});
}

void BootRunner::remember_cob_id() noexcept {
  if (!is_cob_id(current().object)) return;
  cob_id_object_ = current().object;
  cob_id_ = load_le<std::uint32_t>(received());
}

void BootRunner::write_cob_id() noexcept {
  const std::uint32_t wanted =
      current().action == BootAction::disable_pdo
          ? cob_id_ | pdo_invalid
          : (load_le<std::uint32_t>(std::span{current().value}) & ~no_rtr) | (cob_id_ & no_rtr);
  if (wanted == cob_id_) return next();
  store_le(std::span{cob_id_bytes_}, wanted);
  to_write_ = cob_id_bytes_;
  phase_ = Phase::download_next;
}

void BootRunner::on_written() noexcept {
  wrote_ = true;
  // The device has refused this write before the second command, so it had started itself.
  took_out_ = took_out_ || preop_again_;
  if (is_cob_id(current().object) && to_write_.size() == 4) {
    cob_id_object_ = current().object;
    cob_id_ = load_le<std::uint32_t>(to_write_);
  }
  next();
}

void BootRunner::on_downloaded(const SdoResult& result, Time now,
                               const SdoClient& client) noexcept {
  const BootStep& step = current();
  if (result.fault == SdoFault::none) return on_written();
  // A write is never repeated. If its answer does not come, or the device calls the write
  // redundant, reading the object back tells whether the write has worked.
  const bool refused = result.fault == SdoFault::aborted_by_device;
  if (refused && retries_in_preop(result.abort_code)) return;
  if (refused && may_be_missing(step, result.abort_code)) return next();
  if (!refused && step.may_restart) return next();  // the device restarts instead of answering
  if (step.action == BootAction::download_program) return fail(result, now, client);
  if (refused && !may_be_redundant(step, result.abort_code)) return fail(result, now, client);
  refused_ = result;
  refused_trace_ = client.trace();
  phase_ = Phase::confirm_next;
}

void BootRunner::on_confirmed(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  if (result.fault == SdoFault::none && same_value(received(), to_write_, 0xFFFF'FFFF)) {
    return on_written();
  }
  fail(refused_, now, client);
}

std::size_t BootRunner::program_size() const noexcept {
  const bool downloads = state_ == State::running && phase_ == Phase::download &&
                         current().action == BootAction::download_program;
  return downloads ? current().value.size() : 0;
}

void BootRunner::fail(const SdoResult& result, char letter, Time now,
                      const SdoClient& client) noexcept {
  const bool confirming = phase_ == Phase::confirm;
  const SdoTrace& trace = confirming ? refused_trace_ : client.trace();
  const bool transfer = phase_ != Phase::wait && result.fault != SdoFault::cancelled;
  const std::span value = received();
  state_ = State::failed;
  failure_ = {.step = step_,
              .action = current().action,
              .letter = letter,
              .fault = result.fault,
              .downloading = phase_ == Phase::download || confirming,
              .abort_code = result.abort_code,
              .object = current().object,
              .received_size = transfer ? trace.received.length : std::uint8_t{0},
              .received = trace.received.data,
              .sent_size = transfer ? trace.sent.length : std::uint8_t{0},
              .sent = trace.sent.data,
              .moved = static_cast<std::uint32_t>(transfer ? result.size : 0),
              .value_size = static_cast<std::uint16_t>(transfer ? value.size() : 0),
              .node_state = heard_,
              .bootup_seen = bootup_seen_,
              .attempts = attempts_,
              .restarts = restarts_,
              .running = running_,
              .elapsed = now - began_,
              .late = client.lateness(),
              .quiet = now - std::max(entered_, client.heard_at()),
              .empty_answer = transfer && trace.empty_answer,
              .answered = transfer ? client.answered() : std::nullopt,
              .preop_again = preop_again_ && result.abort_code == abort_code::device_state};
  for (std::size_t i = 0; i < failure_.value.size() && i < failure_.value_size; ++i) {
    failure_.value[i] = static_cast<std::uint8_t>(value[i]);
  }
}

}  // namespace takt
