#include "apps/takt/learn/network_text.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ranges>
#include <set>

#include "apps/takt/learn/learned_pdos.hpp"
#include "apps/takt/learn/made_eds.hpp"
#include "apps/takt/learn/node_text.hpp"
#include "apps/takt/learn/yaml_text.hpp"
#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/read/eds.hpp"

namespace takt::learn {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t makes_sync = 0x4000'0000;
constexpr std::size_t most_unknown = 200;
constexpr std::uint64_t shortest_sync_us = 200;
constexpr std::uint64_t longest_sync_us = 60'000'000;
constexpr std::int64_t shortest_time_ms = 100;
constexpr std::int64_t longest_time_ms = 86'400'000;
constexpr std::uint8_t least_overflow = 2;  // the value 1 is reserved; CiA 301, 7.5.2.22
constexpr std::uint8_t most_overflow = 240;

/// Properties of SYNC that the SDO writes and the frames show.
struct SyncFacts {
  std::uint32_t cob_id = 0x80;
  std::int64_t period_us = 0;  ///< 0 means no SYNC
  std::uint8_t overflow = 0;
  std::optional<std::uint64_t> window_us;
  std::optional<std::uint8_t> producer;
};

class NetworkText {
 public:
  NetworkText(const LearnedBus& bus, const DeviceFiles& files, const LearnOptions& options)
      : bus_{bus}, files_{files}, options_{options}, devices_{bus.devices()} {
    out_.findings = bus.findings;
  }

  LearnedNetwork run() {
    find_master();
    report_files_without_node();
    for (const LearnedNode* node : devices_) find_file(*node);
    learn_sync();
    learn_time();
    header();
    master_section();
    out_.text += devices_.empty() ? "nodes: {}\n" : "nodes:\n";
    for (const LearnedNode* node : devices_) {
      const NodeToWrite what{.node = *node,
                             .dictionary = matches_[node->id].dictionary.get(),
                             .dcf = names_[node->id],
                             .made = out_.made_files.contains(names_[node->id]),
                             .master_id = master_id_,
                             .master_heartbeat_ms = heartbeat_ms_,
                             .sync_us = sync_.period_us,
                             .inhibit_unit_us = inhibit_unit(*node)};
      out_.text += node_text(what, bus_, out_.findings);
    }
    unknown_traffic();
    return std::move(out_);
  }

 private:
  void announce(Severity severity, std::string_view rule, std::uint32_t line, std::string message) {
    out_.findings.push_back({bus_.file, {line, 0}, severity, rule, std::move(message)});
  }

  std::uint8_t highest_free_id() const {
    std::uint8_t id = 127;
    while (id > 1 && std::ranges::find(devices_, id, &LearnedNode::id) != devices_.end()) --id;
    return id;
  }

  /// Warns of files that the user gave for nodes that do not exist, like `--eds 5=FILE` without a
  /// node 5.
  void report_files_without_node() {
    for (const std::uint8_t id : files_.assigned()) {
      if (std::ranges::find(devices_, id, &LearnedNode::id) != devices_.end()) continue;
      announce(
          Severity::warning, "nobody-there", 0,
          fmt::format("a device file was given for node {}, which is not in the recording", id));
    }
  }

  /// Returns the heartbeat period of the master in ms. It is the measured period; or else a third
  /// of the shortest time in a heartbeat consumer of a device; or else the shortest time between
  /// two heartbeats; or else the default, 100 ms. 0 means that there is no heartbeat.
  std::int64_t heartbeat_of_master(const LearnedNode& master) const {
    const PeriodMeter& heartbeats = master.heartbeats;
    if (const auto ms = as_configured_ms(heartbeats.median())) return *ms;
    std::int64_t shortest = 0;
    for (const LearnedNode* node : devices_) {
      for (const auto& [key, value] : node->values()) {
        const auto entry = static_cast<std::int64_t>(value.number().value_or(0));
        const std::int64_t ms = entry & 0xFFFF;
        if (key.index != 0x1016 || key.sub == 0 || (entry >> 16 & 0x7F) != master.id) continue;
        if (ms != 0 && (shortest == 0 || ms < shortest)) shortest = ms;
      }
    }
    if (shortest != 0) return std::max<std::int64_t>(1, shortest / 3);
    if (const auto ms = as_configured_ms(heartbeats.shortest())) return *ms;
    return heartbeats.count() != 0 ? 100 : 0;
  }

  void find_master() {
    const auto own = bus_.master();
    master_id_ = own.value_or(highest_free_id());
    if (own) {
      heartbeat_ms_ = heartbeat_of_master(bus_.nodes.at(*own));
    } else {
      announce(Severity::note, "no-master-id", 0,
               fmt::format("the recording does not show the node id of the master: takt uses {}",
                           master_id_));
    }
    if (const auto strangers = bus_.strangers(); !strangers.empty()) {
      announce(
          Severity::note, "nobody-there", bus_.nodes.at(strangers.front()).first_line,
          fmt::format(
              "the recording has SDO requests to {} that sent no frame ({}{}): takt leaves {} out",
              strangers.size() == 1 ? "1 node id" : fmt::format("{} node ids", strangers.size()),
              fmt::join(strangers | std::views::take(8), ", "), strangers.size() > 8 ? " ..." : "",
              strangers.size() == 1 ? "it" : "them"));
    }
    if (devices_.empty()) {
      announce(Severity::warning, "no-nodes", 0, "no device answers in this recording");
    }
  }

  /// Finds the device file of a node: a file of the user, or else one that is made here.
  void find_file(const LearnedNode& node) {
    const LearnedValues values = node.values();
    const SeenIdentity identity = identity_of(values);
    DeviceFiles::Match& match = matches_[node.id] = files_.find(node.id, identity);
    if (match.dictionary) {
      std::error_code error;
      const fs::path base = options_.folder.empty() ? fs::path{"."} : options_.folder;
      const fs::path near = fs::proximate(match.path, base, error);
      names_[node.id] = (error ? match.path : near).generic_string();
      report_match(node, identity, match);
      return;
    }
    const std::string name = fmt::format("{}_node_{}.eds", options_.stem, node.id);
    const std::string text = made_eds(node, fs::path{bus_.file}.filename().string(), name);
    EdsFile made = read_eds(text, name, NodeId::from(node.id));
    match.dictionary = std::make_shared<const ObjectDictionary>(std::move(made.dictionary));
    names_[node.id] = name;
    out_.made_files[name] = text;
    announce(
        Severity::warning, "made-device-file", node.first_line,
        fmt::format("node {}: no device file fits (vendor 0x{:08X}, product 0x{:08X}); takt made "
                    "{} from the recording. To use the vendor's file: --eds {}=FILE or --eds-dir",
                    node.id, identity.vendor_id, identity.product_code, name, node.id));
  }

  /// Returns the unit of the inhibit time in us, by the device data that taktd will apply.
  std::uint32_t inhibit_unit(const LearnedNode& node) const {
    const SeenIdentity identity = identity_of(node.values());
    NodeSpec spec;
    spec.vendor_id = {identity.vendor_id, {}, identity.vendor_id != 0};
    spec.product_code = {identity.product_code, {}, identity.product_code != 0};
    Findings ignored;
    NetworkReport report{bus_.file, ignored};
    const DeviceData* data =
        find_device_data(options_.device_data, spec, *matches_.at(node.id).dictionary, report);
    return data == nullptr ? 100 : data->inhibit.unit_us;
  }

  void report_match(const LearnedNode& node, const SeenIdentity& identity,
                    const DeviceFiles::Match& match) {
    if (match.rivals != 0) {
      announce(Severity::note, "several-files", node.first_line,
               fmt::format("node {}: {} other files fit as well as {}", node.id, match.rivals,
                           match.path.string()));
    }
    if (match.other_revision) {
      announce(Severity::note, "other-revision", node.first_line,
               fmt::format("node {}: the device has revision 0x{:08X}, {} has another", node.id,
                           identity.revision_number, match.path.string()));
    }
  }

  void learn_sync() {
    std::map<std::uint64_t, std::size_t> overflows;
    std::optional<std::uint64_t> period;
    for (const LearnedNode* node : devices_) {
      const LearnedValues values = node->values();
      const auto at = [&](std::uint16_t index) { return values.number_written({index, 0}); };
      if (const auto id = at(0x1005)) {
        if ((*id & 0x2000'0000U) == 0) sync_.cob_id = static_cast<std::uint32_t>(*id & 0x7FFU);
        if ((*id & makes_sync) != 0) sync_.producer = node->id;
      }
      if (const auto us = at(0x1006); us && *us != 0) period = us;
      if (const auto window = at(0x1007)) sync_.window_us = window;
      if (const auto overflow = at(0x1019)) ++overflows[*overflow];
    }
    const auto seen = bus_.sync.find(sync_.cob_id);
    if (seen == bus_.sync.end()) return;
    learn_period(seen->second, period);
    if (seen->second.highest_counter != 0) learn_counter(seen->second.highest_counter, overflows);
  }

  /// Determines the SYNC period. `reported` is the value of 0x1006 in us.
  void learn_period(const LearnedSync& seen, std::optional<std::uint64_t> reported) {
    const bool usable = reported && *reported >= shortest_sync_us && *reported <= longest_sync_us;
    const auto written = usable ? static_cast<std::int64_t>(*reported) : 0;
    if (const auto measured = seen.frames.median()) {
      const bool same = std::abs(written - *measured) * 20 <= *measured;
      sync_.period_us = same ? written : as_configured(*measured);
      return;
    }
    const auto shortest = seen.frames.shortest();
    sync_.period_us = written != 0 ? written : as_configured(shortest.value_or(0));
    const std::string few =
        fmt::format("{} frames of SYNC do not show `sync_period`", seen.frames.count());
    if (sync_.period_us == 0) {
      announce(Severity::warning, "few-frames", 0, few + ": takt left the key out");
    } else {
      announce(Severity::note, "few-frames", 0,
               few + (written != 0 ? ": takt uses the value that was written to 0x1006"
                                   : ": takt uses the shortest time between two frames"));
    }
  }

  /// Determines the counter overflow. `overflows` holds the number of devices for each value of
  /// 0x1019.
  void learn_counter(std::uint8_t highest, const std::map<std::uint64_t, std::size_t>& overflows) {
    const std::uint8_t seen = std::clamp(highest, least_overflow, most_overflow);
    sync_.overflow = seen;
    std::size_t most = 0;
    for (const auto& [overflow, count] : overflows) {
      if (overflow < seen || overflow > most_overflow || count <= most) continue;
      most = count;
      sync_.overflow = static_cast<std::uint8_t>(overflow);
    }
  }

  void learn_time() {
    const auto period = bus_.time.median();
    const auto shortest = bus_.time.shortest();
    if (!shortest) return;
    const std::int64_t ms = as_configured(period.value_or(*shortest)) / 1000;
    const std::string count =
        fmt::format("{} frames of TIME do not show `time_period`: ", bus_.time.count());
    if (ms < shortest_time_ms || ms > longest_time_ms) {
      announce(Severity::warning, "few-frames", 0,
               count + fmt::format("{} ms is out of range, so takt left the key out", ms));
      return;
    }
    time_ms_ = ms;
    if (!period) {
      announce(Severity::note, "few-frames", 0,
               count + "takt uses the shortest time between two frames");
    }
  }

  void header() {
    out_.text = fmt::format("# Learned from {}: {} frames",
                            yaml_word(fs::path{bus_.file}.filename().string()), bus_.frames);
    if (bus_.seconds) out_.text += fmt::format(" in {:.3f} s", *bus_.seconds);
    out_.text += fmt::format(
        ".\n# What a recording can't show is left at its default: units, fallbacks, `mandatory`, "
        "the "
        "bit rate.\nbus: {{interface: {}, bitrate_kbit: {}}}\n\n",
        yaml_word(bus_.interface.empty() ? "can0" : bus_.interface), options_.bitrate_kbit);
  }

  void master_section() {
    std::string& text = out_.text;
    text += fmt::format("master:\n  node_id: {}\n  heartbeat_producer: {}\n", master_id_,
                        heartbeat_ms_);
    if (sync_.period_us != 0) {
      text += fmt::format("  sync_period: {}\n", sync_.period_us);
      if (sync_.cob_id != 0x80) text += fmt::format("  sync_cob_id: 0x{:03X}\n", sync_.cob_id);
      if (sync_.overflow != 0) text += fmt::format("  sync_overflow: {}\n", sync_.overflow);
      if (sync_.window_us) text += fmt::format("  sync_window: {}\n", *sync_.window_us);
      if (sync_.producer) text += fmt::format("  sync_source: {}\n", node_name(*sync_.producer));
    }
    if (time_ms_ != 0) text += fmt::format("  time_period: {}\n", time_ms_);
    const bool one_by_one =
        std::ranges::any_of(devices_, [](const LearnedNode* node) { return node->started; });
    if (bus_.started_all && !one_by_one) text += "  start_all_nodes: true\n";
    text += '\n';
  }

  bool is_emcy(CobId id) const {
    if (id.is_extended()) return false;
    return std::ranges::any_of(devices_, [&](const LearnedNode* node) {
      const unsigned usual = 0x80U + node->id;
      const std::uint64_t set = node->values().number({0x1014, 0}).value_or(usual);
      return id.id() == usual || id.id() == (set & 0x7FFU);
    });
  }

  std::set<CobId> claimed() const {
    std::set<CobId> ids;
    if (sync_.period_us != 0) ids.insert(CobId::base(sync_.cob_id));
    for (const LearnedNode* node : devices_) {
      for (const LearnedPdo& pdo : learned_pdos(node->values())) {
        if (pdo.identifier() && pdo.enabled()) ids.insert(*pdo.identifier());
      }
      for (const PdoDescription& pdo : describe_pdos(*matches_.at(node->id).dictionary)) {
        if (!pdo.valid || !pdo.cob_id()) continue;
        ids.insert(pdo.extended ? CobId::extended(*pdo.cob_id()) : CobId::base(*pdo.cob_id()));
      }
    }
    return ids;
  }

  void unknown_traffic() {
    const std::set<CobId> known = claimed();
    std::size_t listed = 0;
    for (const auto& [id, traffic] : bus_.traffic) {
      if (known.contains(id) || is_emcy(id)) continue;
      if (listed++ == 0) out_.text += "\n# Traffic that nothing above explains:\n";
      if (listed <= most_unknown) one_unknown(id, traffic);
    }
    if (listed > most_unknown) {
      out_.text += fmt::format("#   and {} more identifiers\n", listed - most_unknown);
    }
    if (listed != 0) {
      announce(Severity::warning, "unknown-traffic", 0,
               fmt::format("nothing in the recording explains the frames of {} identifiers; the "
                           "network file lists these identifiers",
                           listed));
    }
    if (bus_.time.count() != 0 && time_ms_ == 0) {
      out_.text += fmt::format("# {} frames of TIME (0x100), which do not show `time_period`.\n",
                               bus_.time.count());
    }
    if (bus_.lss != 0) out_.text += fmt::format("# {} frames of LSS (0x7E5, 0x7E4).\n", bus_.lss);
    if (bus_.more_traffic != 0) {
      out_.text += fmt::format("# {} frames of further identifiers.\n", bus_.more_traffic);
    }
    if (bus_.error_frames != 0) {
      out_.text += fmt::format("# {} error frames.\n", bus_.error_frames);
    }
  }

  /// Returns the PDO that has this identifier in the predefined connection set. This helps the user
  /// to find the purpose of the frame. CiA 301, 7.3.5.
  static std::string guess(CobId id) {
    if (id.is_extended() || id.id() < 0x181 || id.id() > 0x57F) return {};
    const unsigned function = (id.id() >> 7U) - 3;
    const unsigned node = id.id() & 0x7FU;
    if (node == 0) return {};
    return fmt::format(
        " ({}PDO{} of node {} by the predefined connection set, the mapping is not in the "
        "recording)",
        function % 2 == 0 ? 'T' : 'R', function / 2 + 1, node);
  }

  void one_unknown(CobId id, const LearnedTraffic& traffic) {
    std::string& text = out_.text;
    text += fmt::format("#   {}{}: {} frames", to_string(id), guess(id), traffic.frames.count());
    if (traffic.frames.count() != 0) {
      text += traffic.shortest == traffic.longest
                  ? fmt::format(" of {} bytes", traffic.longest)
                  : fmt::format(" of {} to {} bytes", traffic.shortest, traffic.longest);
    }
    if (const auto period = traffic.frames.median()) {
      text += fmt::format(", usually every {} us", *period);
    }
    if (traffic.requests.count() != 0) {
      text += fmt::format(", {} remote requests", traffic.requests.count());
    }
    text += fmt::format(", first in line {}\n", traffic.first_line);
  }

  const LearnedBus& bus_;
  const DeviceFiles& files_;
  const LearnOptions& options_;
  std::vector<const LearnedNode*> devices_;
  std::uint8_t master_id_ = 127;
  std::int64_t heartbeat_ms_ = 0;
  SyncFacts sync_;
  std::int64_t time_ms_ = 0;  // period of TIME; 0 means no TIME
  std::map<std::uint8_t, DeviceFiles::Match> matches_;
  std::map<std::uint8_t, std::string> names_;
  LearnedNetwork out_;
};

}  // namespace

LearnedNetwork learned_network(const LearnedBus& bus, const DeviceFiles& files,
                               const LearnOptions& options) {
  return NetworkText{bus, files, options}.run();
}

}  // namespace takt::learn
