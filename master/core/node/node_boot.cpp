#include <algorithm>
#include <bit>
#include <utility>

#include "master/core/node/node_session.hpp"
#include "master/wire/bytes.hpp"

// The boot of a node by its session, and the consequences of its result.

namespace takt {
namespace {

constexpr Time default_reboot_delay = std::chrono::seconds{1};
constexpr std::uint8_t most_failed_boots = 20;  // the pause has reached its maximum long before

bool same_cause(const BootFailure& a, const BootFailure& b) noexcept {
  return a.step == b.step && a.fault == b.fault && a.abort_code == b.abort_code &&
         a.value == b.value && a.node_state == b.node_state;
}

constexpr std::uint16_t sync_length_emcy = 0x8240;

/// A SYNC with counter came before the node had its 0x1019. Some stacks keep that error until their
/// next reset and do not enter OPERATIONAL; after the reset, they know the counter.
bool met_counter_too_early(const BootFailure& failure) noexcept {
  return failure.action == BootAction::await_operational && failure.emcy == sync_length_emcy;
}

/// Another device has answered. A reset cannot change that.
bool is_another_device(const BootFailure& failure) noexcept {
  return failure.action == BootAction::expect && failure.fault == SdoFault::none &&
         failure.object.index == 0x1018;
}

/// Returns true for the first, second, fourth, eighth ... failure, so that an absent node does not
/// fill the log.
bool worth_telling(std::uint32_t count) noexcept { return std::has_single_bit(count); }

}  // namespace

void NodeSession::boot(BootRunner::From from, Time now) noexcept {
  status_.boot = BootState::booting;
  retry_at_ = never;
  silent_ = false;
  heartbeats_out_ = 0;
  wanted_ = NmtState::unknown;
  guard_.stop();
  state_at_boot_ = status_.nmt;
  twins_.restart();
  progress_told_ = 0;
  emcys_at_boot_ = status_.emcy_count;
  runner_.start(from, now);
  if (worth_telling(same_failures_ + 1)) tell(EventKind::boot_started, now);
  advance(now);
}

void NodeSession::follow_boot(Time now) noexcept {
  runner_.on_time(now, client_);
  status_.boot_step = runner_.step();
  if (runner_.guards()) guard_.start(now);
  tell_progress(now);
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
  same_failures_ = failed_boots_ = 0;
  client_.forget_lateness();
  counter_excused_ = false;
  tell_replaced(now);
  tell_firmware(now);
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
  const bool with_network = plan_->start_later && network_started_ && !runner_.keeps_running();
  if (plan_->boot && (with_network || (runner_.nmt().taken_out() && !plan_->start_later))) {
    own_command_ = NmtCommand::start;
  }
}

/// Reports the progress of a program download after each tenth.
void NodeSession::tell_progress(Time now) noexcept {
  const std::size_t size = runner_.program_size();
  if (size == 0) return;
  const std::size_t done = client_.progress();
  const auto tenth = static_cast<std::uint32_t>(10 * done / size);
  if (tenth == progress_told_) return;
  progress_told_ = tenth;
  tell(EventKind::program_progress, now, static_cast<std::int64_t>(done),
       static_cast<std::uint32_t>(size));
}

void NodeSession::tell_replaced(Time now) noexcept {
  const auto serial = runner_.serial_number();
  if (serial_number_ && serial && *serial != *serial_number_) {
    tell(EventKind::node_replaced, now, *serial, *serial_number_);
  }
  if (serial) serial_number_ = serial;
}

void NodeSession::tell_firmware(Time now) noexcept {
  const auto is = runner_.firmware();
  if (!is || !plan_->firmware) return;
  Firmware assumed = plan_->firmware->assumed;
  if (plan_->firmware->of_revision()) assumed.parts[2] = 0;  // a revision number has only two parts
  if (*is != assumed) tell(EventKind::firmware_differs, now, is->packed());
}

void NodeSession::on_boot_failed(Time now) noexcept {
  runner_.stop();
  guard_.stop();
  BootFailure failure = runner_.failure();
  // A node that should be alive but shows no sign of life is asked by SDO next: it may be
  // OPERATIONAL without a heartbeat.
  const bool silent = failure.action == BootAction::await_alive;
  const bool other = is_another_device(failure) || runner_.identifies();
  retry_later(BootState::failed,
              other    ? BootRunner::From::identity
              : silent ? BootRunner::From::silent
                       : BootRunner::From::beginning,
              now);
  if (status_.emcy_count != emcys_at_boot_) failure.emcy = status_.last_emcy;
  if (met_counter_too_early(failure) && !std::exchange(counter_excused_, true)) {
    retry_at_ = now;  // this is no failure of the node yet
    return;
  }
  if (failed_boots_ < most_failed_boots) ++failed_boots_;
  status_.boot_tried = true;
  status_.boot_letter = failure.letter;
  if (failure.fault == SdoFault::aborted_by_device) ++status_.sdo_aborts;
  same_failures_ = same_cause(failure, last_failure_) ? same_failures_ + 1 : 1;
  last_failure_ = failure;
  if (!worth_telling(same_failures_)) return;
  shared_.events.push({.when = now,
                       .kind = EventKind::boot_failed,
                       .node = plan_->id.value(),
                       .detail = same_failures_,
                       .failure = failure});
}

void NodeSession::retry_later(BootState state, BootRunner::From from, Time now) noexcept {
  status_.boot = state;
  retry_from_ = from;
  retry_at_ = now + pause_before_retry();
}

/// The pause doubles after each failed boot, up to a maximum.
Time NodeSession::pause_before_retry() const noexcept {
  const Time first = plan_->reboot_delay > Time{} ? plan_->reboot_delay : default_reboot_delay;
  const Time longest = std::max(first, plan_->longest_reboot_delay);
  Time pause = first;
  for (int i = 0; i < failed_boots_ && pause < longest; ++i) pause *= 2;
  return std::min(pause, longest);
}

/// The newest boot has failed because the node gave no sign of life at all.
bool NodeSession::was_absent() const noexcept {
  return status_.boot == BootState::failed && last_failure_.fault == SdoFault::timeout &&
         last_failure_.node_state == NmtState::unknown;
}

/// The node restarts again and again, so it waits for its next regular boot.
bool NodeSession::restless(Time now) noexcept {
  constexpr Time window = std::chrono::seconds{10};
  constexpr std::uint32_t most_bootups = 5;
  if (now - bootups_since_ >= window) {
    bootups_since_ = now;
    bootups_ = 0;
  }
  const bool gave_up = status_.boot == BootState::failed && last_failure_.restarts != 0 &&
                       last_failure_.fault == SdoFault::cancelled;
  return ++bootups_ > most_bootups || gave_up;
}

}  // namespace takt
