#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "apps/takt/audit/supervision.hpp"

namespace takt {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t usual_heartbeat_ms = 100;
constexpr double usual_multiplier = 3.0;
constexpr double longest_consumer_ms = 65535.0;  // 0x1016 has 16 bits for the time
constexpr const char* master_line = "master: {heartbeat_producer: 100}   # ms";
constexpr std::int64_t guard_ms = 100;
constexpr std::int64_t life_time_factor = 3;

/// Returns `heartbeat_multiplier` of the node, as the timeout of its own heartbeat shows it. Where
/// the master does not watch a heartbeat of the node, that is the usual value.
double multiplier_of(const NodePlan& node) {
  if (node.heartbeat_timeout == Time{} || node.heartbeat_period == Time{}) return usual_multiplier;
  return static_cast<double>(node.heartbeat_timeout.count()) /
         static_cast<double>(node.heartbeat_period.count());
}

/// Returns the entry of 0x1016 that the boot would write.
std::int64_t consumer_entry(const BusPlan& plan, const NodePlan& node) {
  const std::int64_t ms = plan.master_heartbeat == Time{} ? usual_heartbeat_ms
                                                          : plan.master_heartbeat / milliseconds{1};
  const double accepted =
      std::min(longest_consumer_ms, std::ceil(static_cast<double>(ms) * multiplier_of(node)));
  return (std::int64_t{plan.master_id.value()} << 16) | static_cast<std::int64_t>(accepted);
}

bool is_of_master(const BusPlan& plan, std::uint64_t entry) {
  return ((entry >> 16) & 0xFF) == plan.master_id.value() && (entry & 0xFFFF) != 0;
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
std::optional<std::uint8_t> wide_entry(const BusPlan& plan, const NodePlan& node,
                                       const DeviceValues& values) {
  for (std::uint8_t sub = 1; sub <= entries_of(values); ++sub) {
    const bool unused = entry_of(plan, values, sub) == Entry::watches_nobody;
    if (unused && values.takes({0x1016, sub}, consumer_entry(plan, node))) return sub;
  }
  return std::nullopt;
}

std::uint64_t number_of(const BootStep& step) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < step.value.size() && i < sizeof number; ++i) {
    number |= std::to_integer<std::uint64_t>(step.value[i]) << (8 * i);
  }
  return number;
}

/// Returns true if the boot writes a value into this entry of 0x1016 with which the device does not
/// watch the master. `sdo` of the network file does that. A value of a DCF gives way to the
/// boot's own value.
bool is_overwritten(const BusPlan& plan, const NodePlan& node, std::uint8_t sub) {
  return std::ranges::any_of(node.boot_plan.steps, [&](const BootStep& step) {
    return step.object == ObjectKey{0x1016, sub} && !is_of_master(plan, number_of(step)) &&
           !step.purpose.starts_with("DCF: ");
  });
}

std::string explicit_entry(const BusPlan& plan, const NodePlan& node, std::uint8_t sub) {
  std::array<char, 96> line{};
  std::snprintf(line.data(), line.size(),
                "sdo: [{index: 0x1016, sub_index: %u, value: 0x%06X}]   # watches the master",
                unsigned{sub}, static_cast<unsigned>(consumer_entry(plan, node)));
  return line.data();
}

/// Returns the first entry to which `sdo` of the network file gives another node, and which accepts
/// the master's node-ID and time.
std::optional<std::uint8_t> given_away(const BusPlan& plan, const NodePlan& node,
                                       const DeviceValues& values) {
  for (std::uint8_t sub = 1; sub <= entries_of(values); ++sub) {
    if (!is_overwritten(plan, node, sub)) continue;
    if (values.takes({0x1016, sub}, consumer_entry(plan, node))) return sub;
  }
  return std::nullopt;
}

/// Adds the lines without which the boot does not write the master into 0x1016.
void let_boot_write_consumer(const BusPlan& plan, const NodePlan& node, SupervisionRemedy& remedy) {
  if (plan.master_heartbeat == Time{}) remedy.master = master_line;
  if (node.consumes_master) return;
  remedy.node.emplace_back("heartbeat_consumer: true   # 1016: the device watches the master");
}

/// Adds the lines for a device whose entries of 0x1016 all watch other nodes. Returns false if the
/// network file can't free one of them.
bool free_an_entry(const BusPlan& plan, const NodePlan& node, const DeviceValues& values,
                   SupervisionRemedy& remedy) {
  const auto entry = given_away(plan, node, values);
  if (!entry) return false;
  let_boot_write_consumer(plan, node, remedy);
  remedy.removal = "each entry of 1016 watches another node, and `sdo` in the network file sets " +
                   to_string(ObjectKey{0x1016, *entry}) +
                   ": remove it there, then takt writes the master into the entry, and the device "
                   "watches that other node no longer";
  return true;
}

/// Adds the lines with which the device watches the guarding requests of the master. A guard plan
/// without retries says that only `retry_factor: 0` keeps the master from guarding the node.
void watch_guarding(const NodePlan& node, const DeviceValues& values, SupervisionRemedy& remedy) {
  if (node.boot && node.guard.retries == 0) {
    remedy.node.emplace_back(
        "retry_factor: 3   # with 0 the master does not guard; in addition to life_time_factor");
  } else if (node.boot && node.guard.period != Time{} &&
             values.takes({0x100D, 0}, life_time_factor)) {
    remedy.node.emplace_back("life_time_factor: 3   # life guarding notices a dead master");
  } else if (values.takes({0x100C, 0}, guard_ms) && values.takes({0x100D, 0}, life_time_factor)) {
    remedy.node.emplace_back("heartbeat_producer: 0");
    remedy.node.emplace_back("guard_time: 100   # ms");
    remedy.node.emplace_back("life_time_factor: 3   # life guarding notices a dead master");
  } else {
    remedy.node.clear();
  }
}

/// Adds the lines with which the device watches the heartbeat of the master. Returns false if no
/// entry of 0x1016 can do that.
bool watch_heartbeat(const BusPlan& plan, const NodePlan& node, const DeviceValues& values,
                     SupervisionRemedy& remedy) {
  const auto chosen = chosen_entry(plan, values);
  if (!chosen) return free_an_entry(plan, node, values, remedy);
  const bool by_default = values.takes({0x1016, *chosen}, consumer_entry(plan, node));
  const auto wide = by_default ? std::nullopt : wide_entry(plan, node, values);
  if (!by_default && !wide) return false;
  if (wide) {
    if (plan.master_heartbeat == Time{}) remedy.master = master_line;
    remedy.why = "entry " + to_string(ObjectKey{0x1016, *chosen}) +
                 " can't be written, or by the limits of the EDS does not hold the master's node "
                 "id and a time, but another entry does: name that entry, or correct the EDS";
    remedy.node.push_back(explicit_entry(plan, node, *wide));
    return true;
  }
  let_boot_write_consumer(plan, node, remedy);
  if (is_overwritten(plan, node, *chosen)) {
    remedy.removal =
        "`sdo` in the network file sets " + to_string(ObjectKey{0x1016, *chosen}) +
        " so that the entry does not watch the master: remove it there, then takt writes "
        "the master into the entry";
  }
  return true;
}

}  // namespace

SupervisionRemedy supervision_remedy(const BusPlan& plan, std::size_t node_index,
                                     const DeviceValues& values) {
  const NodePlan& node = plan.nodes[node_index];
  SupervisionRemedy remedy;
  if (!node.boot) remedy.node.emplace_back(boot_line);
  if (watch_heartbeat(plan, node, values, remedy)) return remedy;
  if (entries_of(values) != 0 && !chosen_entry(plan, values)) {
    remedy.why =
        "each entry of 1016 watches another node: the device can't watch the master's heartbeat";
  } else if (values.has(0x1016)) {
    remedy.why =
        "1016 can't be written, or by the limits of the EDS does not hold the master's node id and "
        "a time: the device can't watch the master's heartbeat";
  }
  watch_guarding(node, values, remedy);
  return remedy;
}

}  // namespace takt
