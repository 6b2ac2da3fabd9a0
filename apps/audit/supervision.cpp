#include "apps/audit/supervision.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>

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
      if (plan_.master_heartbeat == Time{}) {
        found_.besides.push_back(name + " watches the master, but the master makes no heartbeat");
        continue;
      }
      notice(milliseconds{entry & 0xFFFF}, "the master's heartbeat stays away (" + name + ")");
    }
  }

  /// Life guarding counts only if the device produces no heartbeat, because a device that produces
  /// one does not answer guarding requests. CiA 301, 7.2.8.2.2.3.
  void life_guarding() {
    const std::uint64_t life =
        values_.get({0x100C, 0}).value_or(0) * values_.get({0x100D, 0}).value_or(0);
    const bool guarded = node_.guard.period != Time{} && values_.get({0x1017, 0}).value_or(0) == 0;
    if (life == 0 || !guarded) return;
    notice(milliseconds{life}, "no guarding request comes (life guarding: 100C x 100D)");
  }

  void sync() {
    const std::uint64_t period = values_.get({0x1006, 0}).value_or(0);
    const bool heard = found_.after.has_value() && node_.on_sync_loss.empty();
    if (period == 0 || !plan_.cycle.sync || heard) return;
    const std::string known =
        "SYNC is known to come every " + std::to_string(period) + " us (1006)";
    if (plan_.cycle.sync_followed) {
      found_.besides.push_back(known + "; another device makes it, and goes on without the master");
      return;
    }
    if (node_.on_sync_loss.empty()) {
      found_.besides.push_back(known + "; whether its absence does anything: see the manual");
      return;
    }
    found_.besides.push_back(known + ": without it " + node_.on_sync_loss);
    found_.by_sync = true;
  }

  /// Reports the deadlines of RPDOs. An expired deadline causes an EMCY; CiA 301 requires no
  /// reaction.
  void deadlines() {
    for (const PdoRow& row : plan_.pdos.rpdos) {
      if (row.node_index != index_) continue;
      const ObjectKey timer{static_cast<std::uint16_t>(0x1400 + row.number - 1), 5};
      const std::uint64_t deadline = values_.get(timer).value_or(0);
      if (deadline == 0) continue;
      found_.besides.push_back("RPDO" + std::to_string(row.number) + " has a deadline of " +
                               std::to_string(deadline) + " ms (" + to_string(timer) +
                               "): EMCY 0x8250; what else follows: see the manual");
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

namespace {

constexpr std::int64_t usual_heartbeat_ms = 100;
constexpr int missed_heartbeats = 3;
constexpr std::int64_t guard_ms = 100;
constexpr std::int64_t life_time_factor = 3;

/// Returns the entry of 0x1016 that the boot would write.
std::int64_t consumer_entry(const BusPlan& plan) {
  const std::int64_t ms = plan.master_heartbeat == Time{} ? usual_heartbeat_ms
                                                          : plan.master_heartbeat / milliseconds{1};
  return (std::int64_t{plan.master_id.value()} << 16) | (missed_heartbeats * ms);
}

/// Use of an entry of 0x1016, as the master sees it.
enum class Entry : std::uint8_t { of_master, watches_nobody, of_another };

Entry entry_of(const BusPlan& plan, const DeviceValues& values, std::uint8_t sub) {
  const std::uint64_t entry = values.get({0x1016, sub}).value_or(0);
  const std::uint64_t node = (entry >> 16) & 0xFF;
  if (node == plan.master_id.value()) return Entry::of_master;
  const bool watches = node != 0 && node <= 127 && (entry & 0xFFFF) != 0;
  return watches ? Entry::of_another : Entry::watches_nobody;
}

std::uint8_t entries_of(const DeviceValues& values) {
  const auto count = std::min<std::uint64_t>(values.get({0x1016, 0}).value_or(0), 127);
  return static_cast<std::uint8_t>(count);
}

/// Returns the entry that the boot chooses: the one for the master, or else the first that watches
/// nobody.
std::optional<std::uint8_t> chosen_entry(const BusPlan& plan, const DeviceValues& values) {
  std::optional<std::uint8_t> unused;
  for (std::uint8_t sub = 1; sub <= entries_of(values); ++sub) {
    const Entry entry = entry_of(plan, values, sub);
    if (entry == Entry::of_master) return sub;
    if (entry == Entry::watches_nobody && !unused) unused = sub;
  }
  return unused;
}

/// Returns the first entry that watches nobody and that accepts the master's node-ID and time.
std::optional<std::uint8_t> wide_entry(const BusPlan& plan, const DeviceValues& values) {
  for (std::uint8_t sub = 1; sub <= entries_of(values); ++sub) {
    const bool unused = entry_of(plan, values, sub) == Entry::watches_nobody;
    if (unused && values.takes({0x1016, sub}, consumer_entry(plan))) return sub;
  }
  return std::nullopt;
}

/// Returns true if the boot writes an entry of 0x1016. It does so with `heartbeat_consumer: true`,
/// which is the default.
bool boot_writes_consumer(const NodePlan& node) {
  return std::ranges::any_of(node.boot_plan.steps, [](const BootStep& step) {
    return step.object.index == 0x1016 && step.object.sub != 0;
  });
}

std::string explicit_entry(const BusPlan& plan, std::uint8_t sub) {
  std::array<char, 96> line{};
  std::snprintf(line.data(), line.size(),
                "sdo: [{index: 0x1016, sub_index: %u, value: 0x%06X}]   # it watches the master",
                unsigned{sub}, static_cast<unsigned>(consumer_entry(plan)));
  return line.data();
}

void watch_guarding(const DeviceValues& values, SupervisionRemedy& remedy) {
  if (values.takes({0x100C, 0}, guard_ms) && values.takes({0x100D, 0}, life_time_factor)) {
    remedy.node.emplace_back("heartbeat_producer: 0");
    remedy.node.emplace_back("guard_time: 100   # ms");
    remedy.node.emplace_back("life_time_factor: 3   # life guarding: it misses the master");
  } else {
    remedy.node.clear();
  }
}

/// Adds the lines with which the device watches the heartbeat of the master. Returns false if no
/// entry of 0x1016 can do that.
bool watch_heartbeat(const BusPlan& plan, const NodePlan& node, const DeviceValues& values,
                     SupervisionRemedy& remedy) {
  const auto chosen = chosen_entry(plan, values);
  const bool by_default = chosen && values.takes({0x1016, *chosen}, consumer_entry(plan));
  const auto wide = by_default ? std::nullopt : wide_entry(plan, values);
  if (!by_default && !wide) return false;
  const bool silent = plan.master_heartbeat == Time{};
  if (silent) remedy.master = "master: {heartbeat_producer: 100}   # ms";
  if (wide) {
    remedy.why = "its " + to_string(ObjectKey{0x1016, *chosen}) +
                 " can't be written, or by the limits of its EDS does not hold the master's node "
                 "id and a time, but another entry does: name that one, or correct the EDS";
    remedy.node.push_back(explicit_entry(plan, *wide));
  } else if (!silent && node.boot && !boot_writes_consumer(node)) {  // set to false
    remedy.node.emplace_back("heartbeat_consumer: true   # 1016: it watches the master");
  }
  return true;
}

}  // namespace

SupervisionRemedy supervision_remedy(const BusPlan& plan, std::size_t node_index,
                                     const DeviceValues& values) {
  const NodePlan& node = plan.nodes[node_index];
  SupervisionRemedy remedy;
  if (!node.boot) remedy.node.emplace_back("boot: true   # takt configures it");
  if (watch_heartbeat(plan, node, values, remedy)) return remedy;
  if (entries_of(values) != 0 && !chosen_entry(plan, values)) {
    remedy.why =
        "each entry of its 1016 watches another node: it can't watch the master's heartbeat";
  } else if (values.has(0x1016)) {
    remedy.why =
        "its 1016 can't be written, or by the limits of its EDS does not hold the master's node id "
        "and a time: it can't watch the master's heartbeat";
  }
  watch_guarding(values, remedy);
  return remedy;
}

}  // namespace takt
