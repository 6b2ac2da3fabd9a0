#include <algorithm>

#include "eds_parser/table/waits.hpp"
#include "master/core/node/boot_runner.hpp"
#include "master/core/node/boot_value.hpp"

// This file evaluates the results of the SDO transfers of a boot.

namespace takt {

/// Repeats a write that the device has refused because of its state, once, after a second command
/// PRE-OPERATIONAL. Some devices start themselves after the first command. Returns false if the
/// write can't be repeated.
bool BootRunner::retries_in_preop(std::uint32_t abort_code) noexcept {
  if (current().action == BootAction::download_program || progress_.preop_again) return false;
  if (abort_code != abort_code::device_state || !nmt_.preoperational()) return false;
  progress_.preop_again = true;
  nmt_.left_preoperational();
  go_to_transfer(Transfer::download);
  return true;
}

void BootRunner::on_result(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  if (transfer_ == Transfer::download) return on_downloaded(result, now, client);
  progress_.received = result.fault == SdoFault::none ? result.size : 0;
  if (transfer_ == Transfer::read_back) return on_read_back(result, now, client);
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
  if (now >= progress_.deadline || (refused && !step.may_restart)) return fail(result, now, client);
  const Time pause = step.action == BootAction::probe ? waits::probe_pause : waits::poll_pause;
  state_ = State::waiting;
  progress_.wait_until =
      result.fault == SdoFault::timeout ? now : std::min(now + pause, progress_.deadline);
}

void BootRunner::on_uploaded(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  const BootStep& step = current();
  const bool silent = result.fault == SdoFault::timeout ||
                      result.fault == SdoFault::aborted_by_master ||
                      result.fault == SdoFault::cancelled;
  if (silent && progress_.uploads < waits::upload_attempts) {
    return go_to_transfer(Transfer::upload);
  }
  const bool read = result.fault == SdoFault::none;
  if (!read && step.unread_letter != 0) return fail(result, step.unread_letter, now, client);
  if (silent) return fail(result, now, client);
  if (read) take_value();
  const bool same = read ? same_value(received(), step.value, step.mask)
                         : may_be_missing(step, result.abort_code);
  switch (step.action) {
    case BootAction::compare:
    case BootAction::write_if_differs:
      return same ? next() : on_differs(result, now, client);
    case BootAction::read_serial:
    case BootAction::read_firmware:
    case BootAction::read_limit:
      return next();
    case BootAction::disable_pdo:
    case BootAction::enable_pdo:
      if (cob_id_.knows(step.object)) return write_cob_id();
      return fail(result, now, client);
    default:
      return same ? next() : fail(result, now, client);
  }
}

/// Handles a value of the device that differs in a step that compares.
void BootRunner::on_differs(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  const BootStep& step = current();
  if (course_ == BootCourse::keeping_operational) {
    if (step.running_letter != 0) return fail(result, step.running_letter, now, client);
    if (left_alone_++ == 0) first_left_alone_ = step.object;
    return next();
  }
  if (step.action == BootAction::write_if_differs) return write(step.value);
  compared_ = Compared::differs;
  next();
}

/// Stores the value that was read if it is used later.
void BootRunner::take_value() noexcept {
  const ObjectKey object = current().object;
  const auto number = load_le<std::uint32_t>(received());
  cob_id_.note(object, number);
  switch (current().action) {
    case BootAction::read_serial:
      serial_number_ = number;
      return;
    case BootAction::read_firmware:
      firmware_ = firmware_in(object, received());
      return;
    case BootAction::read_limit:  // an option code has 16 bits, the limits have 32 bits
      if (received().size() != (is_quick_stop_option(object) ? 2 : 4)) return;
      limits_.take({object, number});
      return;
    default:
      return;
  }
}

void BootRunner::write_cob_id() noexcept {
  const std::uint32_t wanted =
      current().action == BootAction::disable_pdo
          ? cob_id_.disabled()
          : cob_id_.enabled(load_le<std::uint32_t>(std::span{current().value}));
  if (wanted == cob_id_.value()) return next();
  store_le(std::span{cob_id_bytes_}, wanted);
  write(cob_id_bytes_);
}

void BootRunner::on_written() noexcept {
  device_ = Device::written;
  // The device had refused this write before the second command PRE-OPERATIONAL, so it had started
  // itself after the first one.
  if (progress_.preop_again) nmt_.note_taken_out();
  if (to_write_.size() == 4) cob_id_.note(current().object, load_le<std::uint32_t>(to_write_));
  next();
}

void BootRunner::on_downloaded(const SdoResult& result, Time now,
                               const SdoClient& client) noexcept {
  const BootStep& step = current();
  if (result.fault == SdoFault::none) return on_written();
  // A write is never repeated. If its answer does not come, or the device calls the write
  // redundant, the object is read back to find out whether the write has worked.
  const bool refused = result.fault == SdoFault::aborted_by_device;
  if (refused && retries_in_preop(result.abort_code)) return;
  if (refused && may_be_missing(step, result.abort_code)) return next();
  if (!refused && step.may_restart) return next();  // the device restarts instead of answering
  if (step.action == BootAction::download_program) return fail(result, now, client);
  if (refused && !may_be_redundant(step, result.abort_code)) return fail(result, now, client);
  refused_ = {.result = result, .trace = client.trace()};
  go_to_transfer(Transfer::read_back);
}

void BootRunner::on_read_back(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  if (result.fault == SdoFault::none && same_value(received(), to_write_, 0xFFFF'FFFF)) {
    return on_written();
  }
  fail(refused_.result, now, client);
}

std::size_t BootRunner::program_size() const noexcept {
  const bool downloads = state_ == State::in_transfer && transfer_ == Transfer::download &&
                         current().action == BootAction::download_program;
  return downloads ? current().value.size() : 0;
}

void BootRunner::fail(const SdoResult& result, char letter, Time now,
                      const SdoClient& client) noexcept {
  const bool in_transfer = state_ == State::in_transfer;
  const bool reads_back = in_transfer && transfer_ == Transfer::read_back;
  const SdoTrace& trace = reads_back ? refused_.trace : client.trace();
  const bool transfer = state_ != State::waiting && result.fault != SdoFault::cancelled;
  const std::span value = received();
  state_ = State::failed;
  failure_ = {
      .step = step_,
      .action = current().action,
      .letter = letter,
      .fault = result.fault,
      .downloading = in_transfer && transfer_ != Transfer::upload,
      .abort_code = result.abort_code,
      .object = current().object,
      .received_size = transfer ? trace.received.length : std::uint8_t{0},
      .received = trace.received.data,
      .sent_size = transfer ? trace.sent.length : std::uint8_t{0},
      .sent = trace.sent.data,
      .moved = static_cast<std::uint32_t>(transfer ? result.size : 0),
      .value_size = static_cast<std::uint16_t>(transfer ? value.size() : 0),
      .node_state = nmt_.reported(),
      .bootup_seen = nmt_.bootup_seen(),
      .attempts = progress_.uploads,
      .restarts = restarts_,
      .running = course_ == BootCourse::keeping_operational,
      .elapsed = now - began_,
      .late = client.lateness(),
      .quiet = now - std::max(progress_.entered, client.heard_at()),
      .empty_answer = transfer && trace.empty_answer,
      .answered = transfer ? client.answered() : std::nullopt,
      .preop_again = progress_.preop_again && result.abort_code == abort_code::device_state};
  for (std::size_t i = 0; i < failure_.value.size() && i < failure_.value_size; ++i) {
    failure_.value[i] = static_cast<std::uint8_t>(value[i]);
  }
}

}  // namespace takt
