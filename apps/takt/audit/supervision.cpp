#include "apps/takt/audit/supervision.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace takt {
namespace {

using std::chrono::milliseconds;

class Finder {
 public:
  Finder(const BusPlan& plan, std::size_t node_index, const DeviceValues& values)
      : plan_{plan}, index_{node_index}, node_{plan.nodes[node_index]}, values_{values} {}

  Supervision run() {
    heartbeat();
    life_guarding();
    sync();
    deadlines();
    return std::move(found_);
  }

 private:
  void notice(Time after, std::string how) {
    if (found_.after && *found_.after <= after) return;
    found_.after = after;
    found_.how = std::move(how);
  }

  void heartbeat() {
    const std::uint64_t entries =
        std::min<std::uint64_t>(values_.get({0x1016, 0}).value_or(0), 127);
    for (std::uint8_t sub = 1; sub <= entries; ++sub) {
      const std::uint64_t entry = values_.get({0x1016, sub}).value_or(0);
      const bool of_master = ((entry >> 16) & 0xFF) == plan_.master_id.value();
      if (!of_master || (entry & 0xFFFF) == 0) continue;
      const std::string name = to_string(ObjectKey{0x1016, sub});
      if (plan_.master_heartbeat != Time{}) {
        notice(milliseconds{entry & 0xFFFF}, "no heartbeat of the master arrives (" + name + ")");
      } else {
        found_.besides.push_back(name +
                                 " watches the master, but the master produces no heartbeat");
      }
    }
  }

  /// Life guarding counts only if the device produces no heartbeat, because a device that produces
  /// one does not answer guarding requests. CiA 301, 7.2.8.2.2.3.
  void life_guarding() {
    const std::uint64_t life =
        values_.get({0x100C, 0}).value_or(0) * values_.get({0x100D, 0}).value_or(0);
    const bool guarded = node_.guard.period != Time{} && values_.get({0x1017, 0}).value_or(0) == 0;
    if (life == 0 || !guarded) return;
    notice(milliseconds{life}, "no guarding request arrives (life guarding: 100C x 100D)");
  }

  void sync() {
    const std::uint64_t period = values_.get({0x1006, 0}).value_or(0);
    const bool heard = found_.after.has_value() && node_.on_sync_loss.empty();
    if (period == 0 || !plan_.cycle.sync || heard) return;
    const std::string known =
        "the device expects SYNC every " + std::to_string(period) + " us (1006)";
    found_.by_sync = !plan_.cycle.sync_followed && !node_.on_sync_loss.empty();
    found_.besides.push_back(known +
                             (found_.by_sync ? ": without SYNC " + node_.on_sync_loss
                              : plan_.cycle.sync_followed
                                  ? "; another device produces SYNC, also without the master"
                                  : "; for the effect of a missing SYNC see the manual"));
  }

  /// Reports the deadlines of RPDOs. An expired deadline causes an EMCY; CiA 301 requires no
  /// reaction.
  void deadlines() {
    for (const PdoRow& row : plan_.pdos.rpdos) {
      if (row.node_index != index_) continue;
      const ObjectKey timer{static_cast<std::uint16_t>(0x1400 + row.number - 1), 5};
      const std::uint64_t deadline = values_.get(timer).value_or(0);
      if (deadline == 0) continue;
      found_.besides.push_back(fmt::format(
          "RPDO{} has a deadline of {} ms ({}): the device sends EMCY 0x8250; for other "
          "effects see the manual",
          row.number, deadline, to_string(timer)));
    }
  }

  const BusPlan& plan_;
  std::size_t index_;
  const NodePlan& node_;
  const DeviceValues& values_;
  Supervision found_;
};

}  // namespace

Supervision supervision_of(const BusPlan& plan, std::size_t node_index,
                           const DeviceValues& values) {
  return Finder{plan, node_index, values}.run();
}

}  // namespace takt
