#include "master/core/node/node_session.hpp"
#include "master/wire/bytes.hpp"

// This file contains the boot of a node by its session, and the consequences of its result.

namespace takt {
namespace {

/// Returns true if another device has answered, which a reset can't change.
bool is_another_device(const BootFailure& failure) noexcept {
  return failure.action == BootAction::expect && failure.fault == SdoFault::none &&
         failure.object.index == 0x1018;
}

}  // namespace

void NodeSession::boot(BootRunner::From from, Time now) noexcept {
  status_.boot = BootState::booting;
  retries_.cancel();
  watch_.end_silence();
  heartbeats_out_ = 0;
  wanted_ = NmtState::unknown;
  guard_.stop();
  state_at_boot_ = status_.nmt;
  duplicates_.restart();
  progress_reported_ = 0;
  emcys_at_boot_ = status_.emcy_count;
  runner_.start(from, now);
  if (BootRetries::is_reported(retries_.same_failures() + 1))
    announce(EventKind::boot_started, now);
  advance(now);
}

void NodeSession::follow_boot(Time now) noexcept {
  runner_.on_time(now, client_);
  status_.boot_step = runner_.step();
  if (runner_.guards()) guard_.start(now);
  report_progress(now);
  if (runner_.failed()) return on_boot_failed(now);
  if (!runner_.done()) return;
  on_boot_done(now);
}

void NodeSession::on_boot_done(Time now) noexcept {
  runner_.stop();
  status_.boot = BootState::ready;
  status_.boot_tried = true;
  status_.boot_letter = runner_.keeps_running() ? 'L' : '\0';
  ++status_.boot_count;
  // No NMT command has started a node that was found OPERATIONAL, but it has to stay so.
  if (runner_.keeps_running()) wanted_ = NmtState::operational;
  retries_.on_success();
  client_.forget_lateness();
  report_replaced(now);
  report_firmware(now);
  report_boot_done(now);
  const bool with_network =
      plan_->start_later && network_ == NetworkPhase::started && !runner_.keeps_running();
  if (plan_->boot && (with_network || (runner_.nmt().taken_out() && !plan_->start_later))) {
    own_command_ = NmtCommand::start;
  }
}

void NodeSession::report_boot_done(Time now) noexcept {
  const bool untouched = runner_.keeps_running() ||
                         (state_at_boot_ == NmtState::operational && !runner_.nmt().reset_sent());
  const auto took = std::chrono::duration_cast<std::chrono::milliseconds>(now - runner_.began());
  Event event{.when = now,
              .kind = EventKind::boot_done,
              .node = plan_->id.value(),
              .detail = static_cast<std::uint32_t>(took.count()),
              .value = untouched ? 1 : 0};
  store_le(std::span{event.bytes}, runner_.left_alone());
  store_le(std::span{event.bytes}.subspan(2), runner_.first_left_alone().index);
  event.bytes[4] = runner_.first_left_alone().sub;
  shared_.events.push(event);
}

/// Reports the progress of a program download after each tenth.
void NodeSession::report_progress(Time now) noexcept {
  const std::size_t size = runner_.program_size();
  if (size == 0) return;
  const std::size_t done = client_.progress();
  const auto tenth = static_cast<std::uint32_t>(10 * done / size);
  if (tenth == progress_reported_) return;
  progress_reported_ = tenth;
  announce(EventKind::program_progress, now, static_cast<std::int64_t>(done),
           static_cast<std::uint32_t>(size));
}

void NodeSession::report_replaced(Time now) noexcept {
  const auto serial = runner_.serial_number();
  if (serial_number_ && serial && *serial != *serial_number_) {
    announce(EventKind::node_replaced, now, *serial, *serial_number_);
  }
  if (serial) serial_number_ = serial;
}

void NodeSession::report_firmware(Time now) noexcept {
  const auto is = runner_.firmware();
  if (!is || !plan_->firmware) return;
  Firmware assumed = plan_->firmware->assumed;
  if (plan_->firmware->of_revision())
    assumed.parts[2] = 0;  // A revision number has only two parts.
  if (*is != assumed) announce(EventKind::firmware_differs, now, is->packed());
}

void NodeSession::on_boot_failed(Time now) noexcept {
  runner_.stop();
  guard_.stop();
  BootFailure failure = runner_.failure();
  if (status_.emcy_count != emcys_at_boot_) failure.emcy = status_.last_emcy;
  // A node that should be alive but shows no sign of life is asked by SDO next: it may be
  // OPERATIONAL without a heartbeat.
  const bool silent = failure.action == BootAction::await_alive;
  const bool other = is_another_device(failure) || runner_.identifies();
  boot_later(BootState::failed,
             other    ? BootRunner::From::identity
             : silent ? BootRunner::From::silent
                      : BootRunner::From::beginning,
             now);
  if (!retries_.on_failure(failure, now)) return;
  status_.boot_tried = true;
  status_.boot_letter = failure.letter;
  if (failure.fault == SdoFault::aborted_by_device) ++status_.sdo_aborts;
  if (!BootRetries::is_reported(retries_.same_failures())) return;
  shared_.events.push({.when = now,
                       .kind = EventKind::boot_failed,
                       .node = plan_->id.value(),
                       .detail = retries_.same_failures(),
                       .failure = failure});
}

void NodeSession::boot_later(BootState state, BootRunner::From from, Time now) noexcept {
  status_.boot = state;
  retries_.after_pause(from, now);
}

/// Returns true if the newest boot has failed because the node gave no sign of life at all.
bool NodeSession::was_absent() const noexcept {
  const BootFailure& failure = retries_.last_failure();
  return status_.boot == BootState::failed && failure.fault == SdoFault::timeout &&
         failure.node_state == NmtState::unknown;
}

}  // namespace takt
