#include "master/core/node_session.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace takt {
namespace {

constexpr Time default_reboot_delay = std::chrono::seconds{1};
constexpr Time default_sdo_timeout = std::chrono::seconds{1};

bool same_cause(const BootFailure& a, const BootFailure& b) noexcept {
  return a.step == b.step && a.fault == b.fault && a.abort_code == b.abort_code &&
         a.value == b.value && a.node_state == b.node_state;
}

/// The first, second, fourth, eighth ...: a node that stays away must not fill the log.
bool worth_telling(std::uint32_t count) noexcept { return std::has_single_bit(count); }

}  // namespace

NodeSession::NodeSession(const NodePlan& plan, Managed managed, Shared shared) noexcept
    : plan_{&plan},
      managed_{managed},
      shared_{shared},
      client_{plan.id},
      runner_{plan.boot_plan},
      watch_{plan.heartbeat_timeout} {}

void NodeSession::tell(EventKind kind, Time now, std::int64_t value,
                       std::uint32_t detail) noexcept {
  shared_.events.push(
      {.when = now, .kind = kind, .node = plan_->id.value(), .detail = detail, .value = value});
}

void NodeSession::start(Time now) noexcept {
  if (managed_ == Managed::no || stopping_) return;
  boot(BootRunner::From::beginning, now);
}

void NodeSession::boot(BootRunner::From from, Time now) noexcept {
  status_.boot = BootState::booting;
  retry_at_ = never;
  silent_ = false;
  heartbeats_out_ = 0;
  wanted_ = NmtState::unknown;
  state_at_boot_ = status_.nmt;
  emcys_at_boot_ = status_.emcy_count;
  runner_.start(from, now);
  if (worth_telling(same_failures_ + 1)) tell(EventKind::boot_started, now);
  advance(now);
}

void NodeSession::advance(Time now) noexcept {
  if (booting()) follow_boot(now);
  if (booting()) return;
  follow_request(now);
  if (waits_to_boot() && active_ == nullptr && now >= retry_at_) boot(retry_from_, now);
}

void NodeSession::follow_boot(Time now) noexcept {
  runner_.on_time(now, client_);
  status_.boot_step = runner_.step();
  if (runner_.state() == BootRunner::State::failed) return on_boot_failed(now);
  if (runner_.state() != BootRunner::State::done) return;
  runner_.stop();
  status_.boot = BootState::ready;
  ++status_.boot_count;
  same_failures_ = 0;
  const bool skipped = state_at_boot_ == NmtState::operational && !runner_.reset_sent();
  const auto took = std::chrono::duration_cast<std::chrono::milliseconds>(now - runner_.began());
  tell(EventKind::boot_done, now, skipped ? 1 : 0, static_cast<std::uint32_t>(took.count()));
}

void NodeSession::on_boot_failed(Time now) noexcept {
  runner_.stop();
  retry_later(BootState::failed, BootRunner::From::beginning, now);
  BootFailure failure = runner_.failure();
  if (failure.fault == SdoFault::aborted_by_device) ++status_.sdo_aborts;
  if (status_.emcy_count != emcys_at_boot_) failure.emcy = status_.last_emcy;
  same_failures_ = same_cause(failure, last_failure_) ? same_failures_ + 1 : 1;
  last_failure_ = failure;
  if (!worth_telling(same_failures_)) return;
  shared_.events.push({.when = now,
                       .kind = EventKind::boot_failed,
                       .node = plan_->id.value(),
                       .detail = same_failures_,
                       .failure = failure});
}

void NodeSession::follow_request(Time now) noexcept {
  if (active_ != nullptr) {
    const auto result = client_.take_result();
    if (!result) return;
    if (result->fault == SdoFault::aborted_by_device) ++status_.sdo_aborts;
    shared_.requests.answer(
        *active_, result->fault, result->abort_code,
        active_->request.kind == RequestKind::sdo_upload && result->fault == SdoFault::none
            ? result->size
            : 0);
    active_ = nullptr;
  }
  const bool boot_is_due = waits_to_boot() && now >= retry_at_;
  if (stopping_ || boot_is_due || !client_.idle()) return;
  active_ = shared_.requests.next(plan_->id.value());
  if (active_ == nullptr) return;
  Request& request = active_->request;
  const Time own = plan_->sdo_timeout > Time{} ? plan_->sdo_timeout : default_sdo_timeout;
  const Time timeout = request.timeout > Time{} ? request.timeout : own;
  if (request.kind == RequestKind::sdo_upload) {
    client_.upload(request.object, request.data, timeout);
  } else {
    const std::size_t size = std::min<std::size_t>(request.size, request.data.size());
    client_.download(request.object, std::span{request.data}.first(size), timeout);
  }
}

void NodeSession::on_request(Time now) noexcept { advance(now); }

void NodeSession::on_sdo_answer(const Frame& frame, Time now) noexcept {
  client_.on_frame(frame, now);
  advance(now);
}

void NodeSession::on_heartbeat(NmtState state, Time now) noexcept {
  const auto sign = watch_.on_heartbeat(state, now, status_);
  if (sign == NodeWatch::Sign::bootup) return on_bootup(now);
  if (sign == NodeWatch::Sign::new_state) {
    tell(EventKind::node_state, now, static_cast<std::int64_t>(state));
  }
  if (std::exchange(silent_, false)) {
    if (managed_ == Managed::no) tell(EventKind::heartbeat_back, now);
    if (status_.boot == BootState::lost) retry_at_ = now;
  }
  if (booting()) runner_.on_heartbeat(state);
  look_for_fall(state, now);
  advance(now);
}

/// A node that leaves OPERATIONAL unasked (it missed the master's heartbeat, say) is brought back.
/// The first such heartbeat may have been under way while the node was started.
void NodeSession::look_for_fall(NmtState state, Time now) noexcept {
  const bool out = status_.boot == BootState::ready && wanted_ == NmtState::operational &&
                   (state == NmtState::preoperational || state == NmtState::stopped);
  heartbeats_out_ = out ? heartbeats_out_ + 1 : 0;
  if (heartbeats_out_ >= 2) retry_later(BootState::lost, BootRunner::From::bootup, now);
}

void NodeSession::retry_later(BootState state, BootRunner::From from, Time now) noexcept {
  status_.boot = state;
  retry_from_ = from;
  retry_at_ = now + (plan_->reboot_delay > Time{} ? plan_->reboot_delay : default_reboot_delay);
}

void NodeSession::on_bootup(Time now) noexcept {
  if (stopping_) return;
  if (managed_ == Managed::no) return tell(EventKind::node_state, now, 0);
  if (booting()) {
    runner_.on_bootup(now, client_);
    return advance(now);
  }
  node_was_reset();
  if (status_.boot == BootState::ready) tell(EventKind::bootup_again, now);
  // A node that restarts again and again waits for its next turn.
  const bool restless = status_.boot == BootState::failed && last_failure_.restarts != 0 &&
                        last_failure_.fault == SdoFault::cancelled;
  if (!restless) boot(BootRunner::From::bootup, now);
}

void NodeSession::node_was_reset() noexcept {
  watch_.disarm();
  client_.drop();
  if (active_ == nullptr) return;
  shared_.requests.answer(*active_, SdoFault::cancelled);
  active_ = nullptr;
}

void NodeSession::on_emcy(const Emcy& emcy, const Frame& frame, Time now) noexcept {
  if (!watch_.on_emcy(emcy, now, status_)) return;
  Event event{.when = now,
              .kind = EventKind::emcy,
              .node = plan_->id.value(),
              .detail = frame.length,
              .value = watch_.take_untold_emcys()};
  std::ranges::copy_n(frame.data.begin(), std::min<int>(frame.length, 8), event.bytes.begin());
  shared_.events.push(event);
}

void NodeSession::assume(NmtState state, Time now) noexcept {
  if (status_.nmt == state) return;
  status_.nmt = state;
  tell(EventKind::node_state, now, static_cast<std::int64_t>(state));
}

void NodeSession::want(NmtState state, Time now) noexcept {
  wanted_ = state;
  assume(state, now);
}

void NodeSession::on_commanded(NmtCommand command, Time now) noexcept {
  switch (command) {
    case NmtCommand::start:
      return want(NmtState::operational, now);
    case NmtCommand::stop:
      return want(NmtState::stopped, now);
    case NmtCommand::enter_preoperational:
      return want(NmtState::preoperational, now);
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      break;
  }
  node_was_reset();
  assume(NmtState::unknown, now);
  if (managed_ == Managed::no || stopping_ || status_.boot == BootState::idle) return;
  if (booting()) return boot(BootRunner::From::beginning, now);
  // Until its boot-up message, or for the pause.
  retry_later(BootState::lost, BootRunner::From::beginning, now);
}

void NodeSession::look_for_silence(Time now) noexcept {
  if (booting()) return;
  const auto silence = watch_.on_time(now, status_);
  if (!silence) return;
  silent_ = true;
  if (status_.boot == BootState::failed) return;
  tell(EventKind::heartbeat_lost, now, silence->count());
  if (status_.boot == BootState::ready) {
    retry_later(BootState::lost, BootRunner::From::beginning, now);
  }
}

bool NodeSession::on_time(Time now, Outbox& out) noexcept {
  const std::size_t before = out.frames().size();
  look_for_silence(now);
  client_.on_time(now, out);
  advance(now);
  send_nmt(now, out);
  return out.frames().size() != before;
}

void NodeSession::send_nmt(Time now, Outbox& out) noexcept {
  const auto send = [&](NmtCommand command) {
    return out.push(encode(NmtMessage{command, plan_->id.value()}));
  };
  if (preop_to_send_ && send(NmtCommand::enter_preoperational)) {
    preop_to_send_ = false;
    status_.nmt = NmtState::preoperational;
  }
  const auto command = runner_.nmt_to_send();
  if (!command || !send(*command)) return;
  runner_.nmt_sent(now, client_);
  if (is_reset(*command)) {
    watch_.disarm();
    status_.nmt = NmtState::unknown;
  } else {
    on_commanded(*command, now);
  }
  advance(now);
}

Time NodeSession::deadline() const noexcept {
  if (preop_to_send_) return at_once;
  Time first = client_.deadline();
  if (booting()) return std::min(first, runner_.deadline());
  first = std::min(first, watch_.deadline());
  if (waits_to_boot() && active_ == nullptr) first = std::min(first, retry_at_);
  return first;
}

void NodeSession::begin_stop() noexcept {
  if (stopping_) return;
  stopping_ = true;
  preop_to_send_ = managed_ == Managed::yes;
  runner_.stop();
  client_.cancel();
  client_.take_result();
  active_ = nullptr;  // the network answers all requests
  status_.boot = BootState::idle;
  retry_at_ = never;
}

bool NodeSession::stopped() const noexcept {
  return stopping_ && !preop_to_send_ && client_.idle();
}

}  // namespace takt
