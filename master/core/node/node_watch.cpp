#include "master/core/node/node_watch.hpp"

namespace takt {

NodeWatch::Sign NodeWatch::on_heartbeat(NmtState state, Time now, NodeStatus& status) noexcept {
  const NmtState before = std::exchange(status.nmt, state);
  if (state == NmtState::bootup) {
    deadline_ = never;
    ++status.bootups;
    return Sign::bootup;
  }
  status.last_heartbeat = now;
  if (timeout_ > Time{}) deadline_ = now + timeout_;
  return state == before ? Sign::same_state : Sign::new_state;
}

std::optional<Time> NodeWatch::on_time(Time now, NodeStatus& status) noexcept {
  if (now < deadline_) return std::nullopt;
  note_loss(status);
  return now - status.last_heartbeat;
}

void NodeWatch::note_loss(NodeStatus& status) noexcept {
  deadline_ = never;
  silent_ = true;
  status.nmt = NmtState::unknown;
  ++status.heartbeat_lost;
}

bool NodeWatch::on_emcy(const Emcy& emcy, Time now, NodeStatus& status) noexcept {
  status.last_emcy = emcy.code;
  status.error_register = emcy.error_register;
  ++status.emcy_count;
  if (emcys_in_window_ == 0 || now - emcy_window_ >= std::chrono::seconds{1}) {
    emcy_window_ = now;
    emcys_in_window_ = 0;
  }
  if (++emcys_in_window_ <= emcys_per_second) return true;
  ++unreported_emcys_;
  return false;
}
}  // namespace takt
