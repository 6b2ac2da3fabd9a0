#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>

#include "apps/takt/audit/supervision.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t usual_heartbeat_ms = 100;
constexpr double usual_multiplier = 3.0;
constexpr double longest_consumer_ms = 65535.0;  // 0x1016 has 16 bits for the time
constexpr const char* master_line = "master: {heartbeat_producer: 100}   # ms";
constexpr std::int64_t guard_ms = 100;
constexpr std::int64_t life_time_factor = 3;

/// Returns `heartbeat_multiplier` of the node, computed from the timeout of its heartbeat. Returns
/// the usual value if the master does not watch a heartbeat of the node.
double multiplier_of(const NodePlan& node) {
  if (node.heartbeat_timeout == Time{} || node.heartbeat_period == Time{}) return usual_multiplier;
  return static_cast<double>(node.heartbeat_timeout.count()) /
         static_cast<double>(node.heartbeat_period.count());
}

/// Use of an entry of 0x1016, from the view of the master.
enum class Entry : std::uint8_t { of_master, watches_nobody, of_another };

class Adviser {
 public:
  Adviser(const BusPlan& plan, const NodePlan& node, const DeviceValues& values)
      : plan_{plan},
        node_{node},
        values_{values},
        entries_{static_cast<std::uint8_t>(
            std::min<std::uint64_t>(values.get({0x1016, 0}).value_or(0), 127))} {}

  SupervisionRemedy run() {
    if (!node_.boot) remedy_.node.emplace_back(boot_line);
    if (watch_heartbeat()) return std::move(remedy_);
    if (entries_ != 0 && !chosen_entry()) {
      remedy_.why =
          "each entry of 1016 watches another node: the device can't watch the master's heartbeat";
    } else if (values_.has(0x1016)) {
      remedy_.why =
          "1016 can't be written, or its limits in the EDS exclude a value with the master's node "
          "id and a time: the device can't watch the master's heartbeat";
    }
    watch_guarding();
    return std::move(remedy_);
  }

 private:
  /// Returns the first entry of 0x1016 for which `fits` is true.
  template <class Fits>
  std::optional<std::uint8_t> first_entry(const Fits& fits) const {
    for (std::uint8_t sub = 1; sub <= entries_; ++sub) {
      if (fits(sub)) return sub;
    }
    return std::nullopt;
  }

  Entry use_of(std::uint8_t sub) const {
    const std::uint64_t entry = values_.get({0x1016, sub}).value_or(0);
    const std::uint64_t node = (entry >> 16) & 0xFF;
    if (node == plan_.master_id.value()) return Entry::of_master;
    const bool watches = node != 0 && node <= 127 && (entry & 0xFFFF) != 0;
    return watches ? Entry::of_another : Entry::watches_nobody;
  }

  /// Returns the value of the entry that the boot would write.
  std::int64_t consumer_entry() const {
    const std::int64_t ms = plan_.master_heartbeat == Time{}
                                ? usual_heartbeat_ms
                                : plan_.master_heartbeat / milliseconds{1};
    const double accepted =
        std::min(longest_consumer_ms, std::ceil(static_cast<double>(ms) * multiplier_of(node_)));
    return (std::int64_t{plan_.master_id.value()} << 16) | static_cast<std::int64_t>(accepted);
  }

  /// Returns true if the device accepts the master's node-ID and time in this entry.
  bool takes_master(std::uint8_t sub) const {
    return values_.takes({0x1016, sub}, consumer_entry());
  }

  /// Returns the entry that the boot chooses: the one for the master, or else the first that
  /// watches nobody.
  std::optional<std::uint8_t> chosen_entry() const {
    const auto own = first_entry([this](auto sub) { return use_of(sub) == Entry::of_master; });
    return own ? own
               : first_entry([this](auto sub) { return use_of(sub) == Entry::watches_nobody; });
  }

  /// Returns true if an `sdo` entry of the network file lets the boot write a value into this entry
  /// with which the device does not watch the master. Values of a DCF do not count, because the
  /// boot replaces them by its own value.
  bool is_overwritten(std::uint8_t sub) const {
    return std::ranges::any_of(node_.boot_plan.steps, [&](const BootStep& step) {
      const std::uint64_t value = from_little_endian(step.value);
      const bool of_master =
          ((value >> 16) & 0xFF) == plan_.master_id.value() && (value & 0xFFFF) != 0;
      return step.object == ObjectKey{0x1016, sub} && !of_master &&
             !step.purpose.starts_with("DCF: ");
    });
  }

  /// Adds the lines without which the boot does not write the master into 0x1016.
  void let_boot_write_consumer() {
    if (plan_.master_heartbeat == Time{}) remedy_.master = master_line;
    if (node_.consumes_master) return;
    remedy_.node.emplace_back("heartbeat_consumer: true   # 1016: the device watches the master");
  }

  /// Adds the lines for a device whose entries of 0x1016 all watch other nodes. Returns false if
  /// the network file can't free one of them.
  bool free_an_entry() {
    const auto entry =
        first_entry([this](auto sub) { return is_overwritten(sub) && takes_master(sub); });
    if (!entry) return false;
    let_boot_write_consumer();
    remedy_.removal =
        "each entry of 1016 watches another node, and `sdo` in the network file sets " +
        to_string(ObjectKey{0x1016, *entry}) +
        ": remove it there, then takt writes the master into the entry, and the device watches "
        "that other node no longer";
    return true;
  }

  /// Adds the lines with which the device watches the guarding requests of the master. If the guard
  /// plan has 0 retries, `retry_factor: 0` is the only reason why the master does not guard the
  /// node.
  void watch_guarding() {
    const bool takes_factor = values_.takes({0x100D, 0}, life_time_factor);
    if (node_.boot && node_.guard.retries == 0) {
      remedy_.node.emplace_back(
          "retry_factor: 3   # with 0 the master does not guard; in addition to life_time_factor");
    } else if (node_.boot && node_.guard.period != Time{} && takes_factor) {
      remedy_.node.emplace_back("life_time_factor: 3   # life guarding notices a dead master");
    } else if (values_.takes({0x100C, 0}, guard_ms) && takes_factor) {
      remedy_.node.emplace_back("heartbeat_producer: 0");
      remedy_.node.emplace_back("guard_time: 100   # ms");
      remedy_.node.emplace_back("life_time_factor: 3   # life guarding notices a dead master");
    } else {
      remedy_.node.clear();
    }
  }

  /// Adds the lines with which the device watches the heartbeat of the master. Returns false if no
  /// entry of 0x1016 can do that.
  bool watch_heartbeat() {
    const auto chosen = chosen_entry();
    if (!chosen) return free_an_entry();
    const std::string name = to_string(ObjectKey{0x1016, *chosen});
    if (!takes_master(*chosen)) return name_another_entry(name);
    let_boot_write_consumer();
    if (is_overwritten(*chosen)) {
      remedy_.removal = "`sdo` in the network file sets " + name +
                        " so that the entry does not watch the master: remove it there, then takt "
                        "writes the master into the entry";
    }
    return true;
  }

  /// Adds the line for an entry that watches nobody and accepts the master, because the entry
  /// `chosen`, which the boot would use, does not accept the master. Returns false if there is no
  /// such entry.
  bool name_another_entry(const std::string& chosen) {
    const auto wide = first_entry(
        [this](auto sub) { return use_of(sub) == Entry::watches_nobody && takes_master(sub); });
    if (!wide) return false;
    if (plan_.master_heartbeat == Time{}) remedy_.master = master_line;
    remedy_.why =
        "entry " + chosen +
        " can't be written, or its limits in the EDS exclude a value with the master's node "
        "id and a time, but another entry can hold it: name that entry, or correct the EDS";
    remedy_.node.push_back(fmt::format(
        "sdo: [{{index: 0x1016, sub_index: {}, value: 0x{:06X}}}]   # watches the master", *wide,
        consumer_entry()));
    return true;
  }

  const BusPlan& plan_;
  const NodePlan& node_;
  const DeviceValues& values_;
  std::uint8_t entries_;
  SupervisionRemedy remedy_;
};

}  // namespace

SupervisionRemedy supervision_remedy(const BusPlan& plan, std::size_t node_index,
                                     const DeviceValues& values) {
  return Adviser{plan, plan.nodes[node_index], values}.run();
}

}  // namespace takt
