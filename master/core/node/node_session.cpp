#include "master/core/node/node_session.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "master/wire/bytes.hpp"

namespace takt {
namespace {

constexpr Time default_sdo_timeout = std::chrono::seconds{1};
constexpr Time transfer_look = std::chrono::milliseconds{20};

}  // namespace

NodeSession::NodeSession(const NodePlan& plan, Managed managed, Shared shared) noexcept
    : plan_{&plan},
      managed_{managed},
      shared_{shared},
      client_{plan.sdo.channel_of(plan.id), plan.sdo.block, shared.sub_block_segments},
      runner_{plan.boot_plan},
      watch_{plan.heartbeat_timeout},
      guard_{plan.guard},
      twins_{plan.heartbeat_period, plan.sdo.channel_of(plan.id).request} {}

void NodeSession::tell(EventKind kind, Time now, std::int64_t value,
                       std::uint32_t detail) noexcept {
  shared_.events.push(
      {.when = now, .kind = kind, .node = plan_->id.value(), .detail = detail, .value = value});
}

void NodeSession::start(Time now) noexcept {
  if (managed_ == Managed::no || stopping_) return;
  boot(BootRunner::From::beginning, now);
}

void NodeSession::advance(Time now) noexcept {
  if (const auto none = client_.take_no_block()) {
    tell(EventKind::no_sdo_block, now, none->abort_code,
         std::uint32_t{none->object.index} << 8U | none->object.sub);
  }
  if (booting()) follow_boot(now);
  if (booting()) return;
  follow_request(now);
  if (waits_to_boot() && active_ == nullptr && now >= retry_at_) boot(retry_from_, now);
}

void NodeSession::follow_request(Time now) noexcept {
  if (active_ != nullptr) {
    follow_transfer(now);
    const auto result = client_.take_result();
    if (!result) return;
    answer_request(*result);
  }
  const bool boot_is_due = waits_to_boot() && now >= retry_at_;
  if (stopping_ || boot_is_due || !client_.idle() || !next_request()) return;
  begin_request(now);
}

/// Publishes the progress of a transfer, and cancels it if the sender has called it off.
void NodeSession::follow_transfer(Time now) noexcept {
  SdoTransfer* const transfer = active_->request.transfer;
  if (transfer == nullptr) return;
  transfer->done.store(static_cast<std::uint32_t>(client_.progress()), std::memory_order_relaxed);
  transfer->announced.store(static_cast<std::uint32_t>(client_.announced()),
                            std::memory_order_relaxed);
  if (transfer->cancel.load(std::memory_order_relaxed)) client_.cancel();
  next_look_ = now + transfer_look;
}

void NodeSession::answer_request(const SdoResult& result) noexcept {
  if (result.fault == SdoFault::aborted_by_device) ++status_.sdo_aborts;
  const bool upload = active_->request.kind == RequestKind::sdo_upload;
  SdoTransfer* const transfer = active_->request.transfer;
  if (transfer != nullptr) {
    transfer->done.store(static_cast<std::uint32_t>(result.size), std::memory_order_relaxed);
  }
  if (result.fault == SdoFault::timeout) {
    active_->silence = {.late = client_.lateness(), .answered = client_.answered()};
  }
  const bool carries = upload && transfer == nullptr && result.fault == SdoFault::none;
  shared_.requests.answer(*active_, result.fault, result.abort_code, carries ? result.size : 0);
  active_ = nullptr;
  next_look_ = never;
}

/// Activates the next request. Requests that were called off while they waited are answered at
/// once.
bool NodeSession::next_request() noexcept {
  for (;;) {
    active_ = shared_.requests.next(plan_->id.value());
    if (active_ == nullptr) return false;
    const SdoTransfer* const transfer = active_->request.transfer;
    if (transfer == nullptr || !transfer->cancel.load(std::memory_order_relaxed)) return true;
    shared_.requests.answer(*active_, SdoFault::cancelled);
  }
}

void NodeSession::begin_request(Time now) noexcept {
  Request& request = active_->request;
  const Time own = plan_->sdo_timeout > Time{} ? plan_->sdo_timeout : default_sdo_timeout;
  const Time timeout =
      request.timeout > Time{} ? request.timeout : plan_->sdo.timeout_of(request.object, own);
  SdoTransfer* const transfer = request.transfer;
  const bool upload = request.kind == RequestKind::sdo_upload;
  if (transfer != nullptr) {
    next_look_ = now + transfer_look;
    if (upload) return client_.upload(request.object, transfer->data, timeout, SdoMode::block);
    return client_.download(request.object, transfer->data, timeout);
  }
  if (upload) return client_.upload(request.object, request.data, timeout);
  const std::size_t size = std::min<std::size_t>(request.size, request.data.size());
  client_.download(request.object, std::span{request.data}.first(size), timeout);
}

void NodeSession::on_request(Time now) noexcept { advance(now); }

bool NodeSession::withdraw(std::uint64_t id) noexcept {
  if (active_ == nullptr || active_->request.id != id || client_.begun()) return false;
  client_.cancel();
  if (const auto result = client_.take_result()) answer_request(*result);
  return true;
}

void NodeSession::on_sdo_answer(const Frame& frame, Time now) noexcept {
  tell_twin(twins_.on_sdo_answer(frame, now), now);
  client_.on_frame(frame, now);
  advance(now);
}

/// Returns false if the message is a guarding answer that counts as not received.
bool NodeSession::take_guarding_answer(const Heartbeat& sign, Time now) noexcept {
  if (sign.state == NmtState::bootup || guard_.on_answer(sign.toggle, now)) return true;
  if (guard_.repeated() == 1) tell(EventKind::guarding_toggle, now);
  return false;
}

void NodeSession::on_heartbeat(const Heartbeat& sign, Time now) noexcept {
  if (!take_guarding_answer(sign, now)) return;
  const NmtState state = sign.state;
  const auto news = watch_.on_heartbeat(state, now, status_);
  if (news == NodeWatch::Sign::bootup) return on_bootup(now);
  const bool against = ends_exchange() && state == NmtState::operational;
  heartbeats_against_ = against ? heartbeats_against_ + 1 : 0;
  if (news == NodeWatch::Sign::new_state) {
    tell(EventKind::node_state, now, static_cast<std::int64_t>(state));
  }
  if (std::exchange(silent_, false)) {
    if (halted_) return advance(now);
    if (managed_ == Managed::no) tell(EventKind::heartbeat_back, now);
    if (status_.boot == BootState::lost) retry_at_ = now;
  }
  if (was_absent() && !halted_) retry_at_ = now;
  if (booting()) runner_.on_heartbeat(state);
  if (status_.boot == BootState::ready) tell_twin(twins_.on_heartbeat(now), now);
  look_for_fall(state, now);
  advance(now);
}

/// Brings a node back that leaves OPERATIONAL unasked, for example because it has missed the
/// heartbeat of the master. The first such heartbeat is ignored, because it may have been under way
/// while the node was started.
void NodeSession::look_for_fall(NmtState state, Time now) noexcept {
  const bool out = status_.boot == BootState::ready && wanted_ == NmtState::operational &&
                   (state == NmtState::preoperational || state == NmtState::stopped);
  heartbeats_out_ = out ? heartbeats_out_ + 1 : 0;
  if (heartbeats_out_ >= 2) retry_later(BootState::lost, BootRunner::From::bootup, now);
}

void NodeSession::on_bootup(Time now) noexcept {
  if (stopping_) return;
  const bool again = managed_ == Managed::yes && status_.boot == BootState::ready;
  tell(again ? EventKind::bootup_again : EventKind::node_state, now, again && halted_ ? 1 : 0);
  if (managed_ == Managed::no) return;
  if (booting()) {
    guard_.node_was_reset();
    runner_.on_bootup(now, client_);
    return advance(now);
  }
  node_was_reset();
  if (halted_) {
    if (again) status_.boot = BootState::lost;
    return;
  }
  if (restless(now)) {
    if (status_.boot == BootState::ready)
      retry_later(BootState::lost, BootRunner::From::beginning, now);
    return;
  }
  failed_boots_ = 0;
  boot(BootRunner::From::bootup, now);
}

void NodeSession::tell_twin(std::optional<DuplicateSign> sign, Time now) noexcept {
  if (sign) tell(EventKind::duplicate_node, now, static_cast<std::int64_t>(*sign));
}

void NodeSession::await_command() noexcept {
  halted_ = true;
  paused_ = false;  // resume() must not start the node
  if (!booting()) return;
  runner_.stop();
  client_.cancel();
  client_.take_result();
  status_.boot = BootState::lost;
}

void NodeSession::give_up_boot() noexcept {
  if (managed_ == Managed::no) return;
  const bool first = booting() && status_.boot_count == 0;
  await_command();
  if (first) status_.boot = BootState::failed;
}

void NodeSession::halt() noexcept {
  await_command();
  if (managed_ == Managed::yes && !stopping_) own_command_ = NmtCommand::stop;
}

void NodeSession::pause() noexcept {
  const bool runs = status_.boot == BootState::ready && wanted_ == NmtState::operational;
  if (managed_ == Managed::no || stopping_ || halted_ || !runs) return;
  paused_ = true;
  own_command_ = NmtCommand::stop;
}

void NodeSession::resume() noexcept {
  if (!std::exchange(paused_, false) || stopping_) return;
  if (own_command_ == NmtCommand::stop) {
    own_command_.reset();  // NMT stop was not sent yet
  } else if (wanted_ == NmtState::stopped) {
    own_command_ = NmtCommand::start;  // unless another command was sent since
  }
}

void NodeSession::disarm() noexcept {
  watch_.disarm();
  guard_.node_was_reset();
  twins_.restart();
}

void NodeSession::node_was_reset() noexcept {
  disarm();
  client_.drop();
  if (active_ == nullptr) return;
  shared_.requests.answer(*active_, SdoFault::cancelled);
  active_ = nullptr;
  next_look_ = never;
}

void NodeSession::on_emcy(const Frame& frame, Time now) noexcept {
  if (frame.length == 0) return;
  Emcy emcy = emcy_of(plan_->id, frame);  // missing fields keep their last values
  if (frame.length < 2) emcy.code = status_.last_emcy;
  if (frame.length < 3) emcy.error_register = status_.error_register;
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

bool NodeSession::exchanges_pdos() const noexcept {
  const bool booted = status_.boot == BootState::ready || status_.boot == BootState::idle;
  if (!booted || status_.nmt != NmtState::operational) return false;
  return !ends_exchange() || heartbeats_against_ >= 2;
}

void NodeSession::want(NmtState state, Time now) noexcept {
  wanted_ = state;
  heartbeats_against_ = 0;
  assume(state, now);
}

void NodeSession::on_commanded(NmtCommand command, Time now) noexcept {
  switch (command) {
    case NmtCommand::start:
      if (std::exchange(halted_, false) && status_.boot == BootState::lost) retry_at_ = now;
      return want(NmtState::operational, now);
    case NmtCommand::stop:
      return want(NmtState::stopped, now);
    case NmtCommand::enter_preoperational:
      return want(NmtState::preoperational, now);
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      break;
  }
  halted_ = false;
  failed_boots_ = 0;
  node_was_reset();
  assume(NmtState::unknown, now);
  if (managed_ == Managed::no || stopping_ || status_.boot == BootState::idle) return;
  if (booting()) return boot(BootRunner::From::beginning, now);
  // The boot waits for the boot-up message, or for the pause.
  retry_later(BootState::lost, BootRunner::From::beginning, now);
}

void NodeSession::look_for_silence(Time now) noexcept {
  if (booting()) return;
  if (const auto silence = watch_.on_time(now, status_)) {
    on_silence(EventKind::heartbeat_lost, *silence, now);
  }
  if (const auto silence = guard_.on_time(now)) {
    watch_.note_loss(status_);
    on_silence(EventKind::guarding_lost, *silence, now);
  }
}

void NodeSession::on_silence(EventKind kind, Time silence, Time now) noexcept {
  silent_ = true;
  if (status_.boot == BootState::failed) return;
  tell(kind, now, silence.count());
  if (status_.boot == BootState::ready) {
    loss_ = true;
    retry_later(BootState::lost, BootRunner::From::beginning, now);
  }
}

bool NodeSession::on_time(Time now, Outbox& out) noexcept {
  const std::size_t before = out.frames().size();
  look_for_silence(now);
  client_.on_time(now, out);
  twins_.on_sdo_requests(out.frames().subspan(before));
  advance(now);
  send_nmt(now, out);
  send_guarding(now, out);
  return out.frames().size() != before;
}

void NodeSession::send_nmt(Time now, Outbox& out) noexcept {
  const auto send = [&](NmtCommand command) {
    const bool sent =
        shared_.nmt_gate.open(now) && out.push(encode(NmtMessage{command, plan_->id.value()}));
    if (sent) shared_.nmt_gate.sent(now);
    return sent;
  };
  if (own_command_ && send(*own_command_)) {
    const NmtCommand command = *std::exchange(own_command_, std::nullopt);
    if (stopping_) {
      status_.nmt = is_reset(command) ? NmtState::unknown : NmtState::preoperational;
    } else {
      const bool halted = halted_;
      on_commanded(command, now);
      halted_ = halted;
    }
  }
  const auto command = runner_.nmt_to_send();
  if (!command || !send(*command)) return;
  runner_.nmt_sent(client_);
  if (is_reset(*command)) {
    disarm();
    status_.nmt = NmtState::unknown;
  } else {
    on_commanded(*command, now);
  }
  advance(now);
}

void NodeSession::send_guarding(Time now, Outbox& out) noexcept {
  if (guard_.wants_request(now) && out.push(guarding_request(plan_->id))) guard_.request_sent(now);
}

Time NodeSession::deadline() const noexcept {
  if (own_command_) return at_once;
  Time first = std::min(client_.deadline(), guard_.deadline());
  if (booting()) return std::min(first, runner_.deadline());
  first = std::min({first, watch_.deadline(), next_look_});
  if (waits_to_boot() && active_ == nullptr) first = std::min(first, retry_at_);
  return first;
}

void NodeSession::excuse(Time away) noexcept {
  watch_.excuse(away);
  guard_.excuse(away);
  client_.excuse(away);
  runner_.excuse(away);
}

void NodeSession::begin_stop(NmtCommand last) noexcept {
  if (stopping_) return;
  stopping_ = true;
  own_command_.reset();
  const bool keeps_alive = std::ranges::any_of(plan_->boot_plan.steps, [](const BootStep& step) {
    return step.action == BootAction::await_alive;
  });
  if (managed_ == Managed::yes) {
    own_command_ = keeps_alive ? NmtCommand::enter_preoperational : last;
  }
  runner_.stop();
  guard_.stop();
  client_.cancel();
  client_.take_result();
  active_ = nullptr;  // the network answers all requests
  next_look_ = never;
  status_.boot = BootState::idle;
  retry_at_ = never;
}

bool NodeSession::stopped() const noexcept { return stopping_ && !own_command_ && client_.idle(); }

}  // namespace takt
