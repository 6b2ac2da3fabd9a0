#include "master/core/node/node_session.hpp"

#include <algorithm>

// This file contains the start of the session and the evaluation of the frames of the node.

namespace takt {

NodeSession::NodeSession(const NodePlan& plan, Managed managed, Shared shared) noexcept
    : plan_{&plan},
      managed_{managed},
      shared_{shared},
      client_{plan.sdo.channel_of(plan.id), plan.sdo.block, shared.sub_block_segments},
      runner_{plan.boot_plan},
      retries_{plan},
      requests_{plan, shared.requests},
      watch_{plan.heartbeat_timeout},
      guard_{plan.guard},
      duplicates_{plan.heartbeat_period, plan.sdo.channel_of(plan.id).request} {}

void NodeSession::announce(EventKind kind, Time now, std::int64_t value,
                           std::uint32_t detail) noexcept {
  shared_.events.push(
      {.when = now, .kind = kind, .node = plan_->id.value(), .detail = detail, .value = value});
}

void NodeSession::start(Time now) noexcept {
  if (managed_ == Managed::no || stopping()) return;
  boot(BootRunner::From::beginning, now);
}

void NodeSession::advance(Time now) noexcept {
  if (const auto none = client_.take_no_block()) {
    announce(EventKind::no_sdo_block, now, none->abort_code,
             std::uint32_t{none->object.index} << 8U | none->object.sub);
  }
  if (booting()) follow_boot(now);
  if (booting()) return;
  requests_.follow(client_, status_, now);
  if (requests_.active()) return;
  if (waits_to_boot() && retries_.due(now)) return boot(retries_.from(), now);
  if (!stopping()) requests_.begin_next(client_, now);
}

void NodeSession::on_sdo_answer(const Frame& frame, Time now) noexcept {
  report_duplicate(duplicates_.on_sdo_answer(frame, now), now);
  client_.on_frame(frame, now);
  advance(now);
}

/// Returns false if the message is a guarding answer that counts as not received.
bool NodeSession::take_guarding_answer(const Heartbeat& sign, Time now) noexcept {
  if (sign.state == NmtState::bootup || guard_.on_answer(sign.toggle, now)) return true;
  if (guard_.repeated() == 1) announce(EventKind::guarding_toggle, now);
  return false;
}

void NodeSession::on_heartbeat(const Heartbeat& sign, Time now) noexcept {
  if (!take_guarding_answer(sign, now)) return;
  const NmtState state = sign.state;
  const auto noticed = watch_.on_heartbeat(state, now, status_);
  if (noticed == NodeWatch::Sign::bootup) return on_bootup(now);
  const bool against = ends_exchange() && state == NmtState::operational;
  heartbeats_against_ = against ? heartbeats_against_ + 1 : 0;
  if (noticed == NodeWatch::Sign::new_state) {
    announce(EventKind::node_state, now, static_cast<std::int64_t>(state));
  }
  const bool halted = command_ == Command::application;
  if (watch_.end_silence()) {
    if (halted) return advance(now);
    if (managed_ == Managed::no) announce(EventKind::heartbeat_back, now);
    if (status_.boot == BootState::lost) retries_.without_pause(now);
  }
  if (was_absent() && !halted) retries_.without_pause(now);
  if (booting()) runner_.on_heartbeat(state);
  if (status_.boot == BootState::ready) report_duplicate(duplicates_.on_heartbeat(now), now);
  look_for_fall(state, now);
  advance(now);
}

/// Boots a node again if it has left OPERATIONAL by itself, for example because it has missed the
/// heartbeat of the master. One heartbeat with PRE-OPERATIONAL or STOPPED is ignored, because the
/// node may have sent it before it received NMT start.
void NodeSession::look_for_fall(NmtState state, Time now) noexcept {
  const bool out = status_.boot == BootState::ready && wanted_ == NmtState::operational &&
                   (state == NmtState::preoperational || state == NmtState::stopped);
  heartbeats_out_ = out ? heartbeats_out_ + 1 : 0;
  if (heartbeats_out_ >= 2) boot_later(BootState::lost, BootRunner::From::bootup, now);
}

void NodeSession::on_bootup(Time now) noexcept {
  if (stopping()) return;
  const bool again = managed_ == Managed::yes && status_.boot == BootState::ready;
  announce(again ? EventKind::bootup_again : EventKind::node_state, now,
           again && command_ == Command::application ? 1 : 0);
  if (managed_ == Managed::no) return;
  if (booting()) {
    guard_.node_was_reset();
    runner_.on_bootup(now, client_);
    return advance(now);
  }
  on_node_reset();
  if (command_ == Command::application) {
    if (again) status_.boot = BootState::lost;
    return;
  }
  if (retries_.boots_up_repeatedly(now, status_.boot)) {
    if (status_.boot == BootState::ready) {
      boot_later(BootState::lost, BootRunner::From::beginning, now);
    }
    return;
  }
  retries_.shorten_pause();
  boot(BootRunner::From::bootup, now);
}

void NodeSession::report_duplicate(std::optional<DuplicateSign> sign, Time now) noexcept {
  if (sign) announce(EventKind::duplicate_node, now, static_cast<std::int64_t>(*sign));
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
              .value = watch_.take_unreported_emcys()};
  std::ranges::copy_n(frame.data.begin(), std::min<int>(frame.length, 8), event.bytes.begin());
  shared_.events.push(event);
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
  if (status_.boot == BootState::failed) return;
  announce(kind, now, silence.count());
  if (status_.boot == BootState::ready) {
    loss_to_report_ = true;
    boot_later(BootState::lost, BootRunner::From::beginning, now);
  }
}

bool NodeSession::on_time(Time now, Outbox& out) noexcept {
  const std::size_t before = out.frames().size();
  look_for_silence(now);
  client_.on_time(now, out);
  duplicates_.on_sdo_requests(out.frames().subspan(before));
  advance(now);
  send_own_command(now, out);
  send_boot_command(now, out);
  if (guard_.wants_request(now) && out.push(guarding_request(plan_->id))) guard_.request_sent(now);
  return out.frames().size() != before;
}

Time NodeSession::deadline() const noexcept {
  if (own_command_) return at_once;
  Time first = std::min(client_.deadline(), guard_.deadline());
  if (booting()) return std::min(first, runner_.deadline());
  first = std::min({first, watch_.deadline(), requests_.deadline()});
  if (waits_to_boot() && !requests_.active()) first = std::min(first, retries_.deadline());
  return first;
}

void NodeSession::extend_deadlines(Time away) noexcept {
  watch_.extend_deadlines(away);
  guard_.extend_deadlines(away);
  client_.extend_deadlines(away);
  runner_.extend_deadlines(away);
}

}  // namespace takt
