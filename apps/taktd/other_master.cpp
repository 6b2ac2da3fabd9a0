#include "apps/taktd/other_master.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <utility>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time shortest_listening = 150ms;
constexpr Time longest_listening = 1500ms;
constexpr Time status_is_alive = 5s;

}  // namespace

OtherMaster::OtherMaster(const BusPlan& plan, std::string bus, std::int64_t session)
    : plan_{plan}, bus_{std::move(bus)}, session_{session} {}

Time OtherMaster::listening_time() const noexcept {
  const Time heartbeat = plan_.master_heartbeat;
  return std::clamp(heartbeat + heartbeat / 2, shortest_listening, longest_listening);
}

void OtherMaster::on_frame(const Frame& frame) {
  if (frame.rtr) return;
  const unsigned id = plan_.master_id.value();
  if (!refusal_ && frame.id == CobId::base(0x700 + id)) {
    refusal_ = fmt::format(
        "{}: node {}, the id of the master, has a heartbeat on the bus: another master runs it "
        "already, or a device has this id; end the other one, or give this one another "
        "`node_id` under `master:`",
        bus_, id);
  }
  if (!warning_ && plan_.cycle.makes_sync() && frame.id == plan_.cycle.sync_cob_id) {
    warning_ =
        fmt::format("{}: somebody else makes SYNC (COB-ID 0x{:X}) on the bus", bus_, frame.id.id());
  }
}

void OtherMaster::on_status(const status_t& status, Time realtime) {
  const std::chrono::microseconds sent{status.utime};
  const bool alive = sent > realtime - status_is_alive && sent < realtime + status_is_alive;
  const bool master = status.session != session_ && status.frames_sent > 0;
  if (refusal_ || !alive || !master || status.bus != plan_.name) return;
  refusal_ = fmt::format(
      "bus '{}' has a master on LCM already: a taktd on {}, session {}; end it, or give one of the "
      "two buses another name: `bus: {{name: ...}}`",
      plan_.name, status.interface, status.session);
}

}  // namespace takt
