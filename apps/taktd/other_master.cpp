#include "apps/taktd/other_master.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time shortest_listening = 1100ms;  // most masters have a heartbeat of a second or less
constexpr Time longest_listening = 5s;
constexpr Time status_is_alive = 5s;
constexpr std::size_t longest_name = 64;  // bytes of a foreign name that are shown in a sentence

}  // namespace

OtherMaster::OtherMaster(const BusPlan& plan, std::string bus, std::int64_t session,
                         StatusCounts status)
    : plan_{plan}, bus_{std::move(bus)}, session_{session}, status_{status} {}

std::vector<std::string> OtherMaster::warnings() const {
  std::vector<std::string> all;
  if (sync_warning_) all.push_back(*sync_warning_);
  if (status_warning_) all.push_back(*status_warning_);
  return all;
}

Time OtherMaster::listening_time() const noexcept {
  const Time heartbeat = plan_.master_heartbeat;
  return std::clamp(heartbeat + heartbeat / 10, shortest_listening, longest_listening);
}

void OtherMaster::on_frame(const Frame& frame) {
  if (frame.rtr) return;
  const unsigned id = plan_.master_id.value();
  if (!refusal_ && frame.id == CobId::base(0x700 + id)) {
    refusal_ = fmt::format(
        "{}: node {}, the id of the master, has a heartbeat on the bus already: another master "
        "runs on this bus, or a device has this id; end the other master, or give this master "
        "another `node_id` under `master:`",
        bus_, id);
  }
  if (!sync_warning_ && plan_.cycle.makes_sync() && frame.id == plan_.cycle.sync_cob_id) {
    sync_warning_ = fmt::format("{}: another node produces SYNC (COB-ID 0x{:X}) on the bus", bus_,
                                frame.id.id());
  }
}

void OtherMaster::on_status(const status_t& status, Time realtime) {
  const std::chrono::microseconds sent{status.utime};
  const bool alive = sent > realtime - status_is_alive && sent < realtime + status_is_alive;
  const bool master = status.session != session_ && status.frames_sent > 0;
  if (refusal_ || !alive || !master || status.bus != plan_.name) return;
  const std::string what =
      fmt::format("bus '{}' has a master on LCM already: a taktd on {}, session {}", plan_.name,
                  printable_text(status.interface.substr(0, longest_name)), status.session);
  constexpr std::string_view remedy =
      "or give one of the two buses another name: `bus: {name: ...}`";
  if (status_ == StatusCounts::as_refusal) {
    refusal_ = fmt::format("{}; end that master, {}", what, remedy);
  } else {
    status_warning_ = fmt::format(
        "{}. The message is unsigned, so this master starts all the same; if the other master "
        "exists, end it, {}",
        what, remedy);
  }
}

}  // namespace takt
