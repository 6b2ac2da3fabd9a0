#include "eds_parser/plan/image/layout_compiler.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "eds_parser/dictionary/object_names.hpp"
#include "eds_parser/plan/image/signal_rules.hpp"
#include "eds_parser/plan/pdo/mapping_compiler.hpp"

namespace takt {
namespace {

constexpr std::size_t max_signals = 0xFFFF;

/// A mapped object that is to become a signal.
struct Candidate {
  std::size_t node_index = 0;
  std::size_t row = 0;  ///< index in tpdos or rpdos
  const EffectiveEntry* entry = nullptr;
  /// Number of earlier occurrences of this object in the same node and direction.
  std::size_t occurrence = 0;
  bool output = false;
};

class LayoutCompiler {
 public:
  LayoutCompiler(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report)
      : nodes_{nodes}, plan_{plan}, report_{report} {}

  void run() {
    for (const bool is_tpdo : {true, false}) add_rows(is_tpdo);
    std::ranges::stable_sort(candidates_, {}, [](const Candidate& c) {
      return std::tuple{c.output, c.entry->object, c.occurrence, c.node_index};
    });
    if (candidates_.size() > max_signals) {
      report_.error({}, "too-many", "more than 65535 mapped objects on one bus");
      return;
    }
    for (const Candidate& candidate : candidates_) add_signal(candidate);
    give_names();
    seed_outputs();
    add_fields(plan_.pdos.tpdos, tpdo_sources_);
    add_fields(plan_.pdos.rpdos, rpdo_sources_);
    if (plan_.pdos.fields.size() > max_signals) {
      report_.error({}, "too-many", "more than 65535 mapped entries on one bus");
    }
    plan_.layout.hash = hash();
  }

 private:
  struct Source {
    std::size_t node_index;
    const EffectivePdo* pdo;
    const EffectiveEntry* entry = nullptr;  ///< object of this row for an MPDO
    std::uint32_t header = 0;

    /// Returns the entries that become signals.
    std::span<const EffectiveEntry> entries() const {
      if (pdo->on_request) return {};
      return entry != nullptr ? std::span{entry, 1} : std::span{pdo->mapping};
    }
  };

  void add_source(std::size_t node, const EffectivePdo& pdo, std::vector<Source>& sources) const {
    if (pdo.mpdo == Mpdo::none) return sources.push_back({node, &pdo});
    const auto first = static_cast<std::ptrdiff_t>(sources.size());
    check_dispatching(nodes_[node].node, pdo, plan_.master_id, report_);
    for (const EffectiveEntry& entry : pdo.mapping) {
      const std::uint32_t header = mpdo_header(nodes_[node].node, pdo, entry, plan_.master_id);
      sources.push_back({node, &pdo, &entry, header});
    }
    std::ranges::sort(sources.begin() + first, sources.end(), {}, &Source::header);
  }

  void add_rows(bool is_tpdo) {
    std::vector<Source>& sources = is_tpdo ? tpdo_sources_ : rpdo_sources_;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      for (const EffectivePdo& pdo : nodes_[n].pdos) {
        if (pdo.use == PdoUse::exchanged && pdo.is_tpdo == is_tpdo) add_source(n, pdo, sources);
      }
    }
    // The master sends RPDOs in the order of their priority, so that no frame waits in the
    // controller for one of lower priority.
    if (!is_tpdo) {
      std::ranges::stable_sort(sources, {}, [](const Source& s) { return s.pdo->cob_id; });
    }
    auto& rows = is_tpdo ? plan_.pdos.tpdos : plan_.pdos.rpdos;
    for (const Source& source : sources) {
      add_candidates(source, rows.size());
      rows.push_back(row_of(source));
      const CobId id = source.pdo->cob_id;
      const bool again =
          rows.size() > 1 && source.entry != nullptr && rows[rows.size() - 2].cob_id == id;
      if (source.entry != nullptr && is_tpdo && !again) {
        rows.back().siblings = static_cast<std::uint16_t>(source.pdo->mapping.size());
      }
      if (is_tpdo && !again && !id.is_extended()) {
        plan_.pdos.route[id.id()] = static_cast<std::uint16_t>(rows.size() - 1);
      }
    }
  }

  PdoRow row_of(const Source& source) const {
    const EffectivePdo& pdo = *source.pdo;
    PdoRow row{.cob_id = pdo.cob_id,
               .node = nodes_[source.node_index].node.id,
               .node_index = static_cast<std::uint8_t>(source.node_index),
               .number = pdo.number,
               .transmission = pdo.transmission,
               .length = pdo.bytes(),
               .sync_start = pdo.sync_start,
               .poll = std::chrono::milliseconds{pdo.poll_ms},
               .poll_syncs = pdo.poll_syncs,
               .header = source.header,
               .on_request = pdo.on_request,
               .drop_late = pdo.drop_late};
    if (pdo.is_tpdo) {
      row.inhibit = std::chrono::microseconds{inhibit_us(pdo)};
      row.event_timer = std::chrono::milliseconds{pdo.event_timer};
      row.deadline = deadline_of(pdo);
    } else {
      row.inhibit = std::chrono::microseconds{pdo.master_inhibit * 100};
      row.event_timer = std::chrono::milliseconds{pdo.master_timer};
    }
    return row;
  }

  static std::int64_t inhibit_us(const EffectivePdo& pdo) {
    return std::int64_t{pdo.inhibit_time} * pdo.inhibit_unit_us;
  }

  /// Returns `event_deadline`. If there is none and the device repeats the PDO itself, returns 1.5
  /// times its event timer, plus its inhibit time (which may delay each repetition), plus 10 ms.
  static Time deadline_of(const EffectivePdo& pdo) {
    if (pdo.master_timer != 0) return std::chrono::milliseconds{pdo.master_timer};
    if (pdo.synchronous() || pdo.event_timer == 0) return Time{};
    return std::chrono::microseconds{pdo.event_timer * 1500 + 10'000 + inhibit_us(pdo)};
  }

  /// An input that is mapped twice becomes two signals. An output is one signal, which is copied
  /// into every RPDO that maps it.
  void add_candidates(const Source& source, std::size_t row) {
    for (const EffectiveEntry& entry : source.entries()) {
      if (entry.dummy) continue;
      const bool output = !source.pdo->is_tpdo;
      const auto key = std::tuple{output, source.node_index, entry.object};
      const std::size_t before = seen_[key]++;
      if (output && before > 0) continue;
      candidates_.push_back({source.node_index, row, &entry, before, output});
    }
  }

  void add_signal(const Candidate& candidate) {
    const NodePdos& node = nodes_[candidate.node_index];
    Signal signal{.name = snake_case(candidate.entry->name.empty()
                                         ? "object " + to_string(candidate.entry->object)
                                         : candidate.entry->name),
                  .node = node.node.id,
                  .node_index = static_cast<std::uint8_t>(candidate.node_index),
                  .object = candidate.entry->object,
                  .type = candidate.entry->type,
                  .bits = candidate.entry->bits,
                  .output = candidate.output,
                  .row = static_cast<std::uint16_t>(candidate.row)};
    apply_units(node.node, signal);
    if (signal.output) {
      apply_fallback(node.node, plan_.nodes[candidate.node_index].cia402, plan_.cycle.period,
                     signal);
    } else {
      ++plan_.layout.inputs;
    }
    index_[{signal.output, candidate.node_index, signal.object, candidate.occurrence}] =
        static_cast<SignalIndex>(plan_.layout.signals.size());
    plan_.layout.signals.push_back(std::move(signal));
  }

  /// Gives each signal a name that is unique within its node. If an object is input and output, the
  /// output gets the plain name.
  void give_names() {
    std::set<std::pair<std::uint8_t, std::string>> taken;
    for (const bool output : {true, false}) {
      for (Signal& signal : plan_.layout.signals) {
        if (signal.output != output) continue;
        const std::string plain = signal.name;
        for (int n = 2; !taken.emplace(signal.node_index, signal.name).second; ++n) {
          signal.name = plain + "_" + std::to_string(n);
        }
      }
    }
  }

  void seed_outputs() {
    for (std::size_t i = plan_.layout.inputs; i < plan_.layout.signals.size(); ++i) {
      Signal& signal = plan_.layout.signals[i];
      if (!plan_.nodes[signal.node_index].cia402) continue;
      const std::optional<ObjectKey> source = seed_object(signal.object);
      if (!source) continue;
      const auto found = index_.find({false, std::size_t{signal.node_index}, *source, 0});
      if (found != index_.end()) signal.seeded_from = found->second;
    }
  }

  void add_fields(std::vector<PdoRow>& rows, const std::vector<Source>& sources) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      rows[r].first_field = static_cast<std::uint16_t>(plan_.pdos.fields.size());
      for (const EffectiveEntry& entry : sources[r].entries()) {
        if (!entry.dummy) add_field(sources[r], entry);
      }
      rows[r].field_count =
          static_cast<std::uint16_t>(plan_.pdos.fields.size() - rows[r].first_field);
    }
  }

  void add_field(const Source& source, const EffectiveEntry& entry) {
    const bool output = !source.pdo->is_tpdo;
    const std::size_t occurrence = output ? 0 : next_input_[{source.node_index, entry.object}]++;
    const SignalIndex signal = index_.at({output, source.node_index, entry.object, occurrence});
    plan_.pdos.fields.push_back({.signal = signal,
                                 .bit_offset = entry.bit_offset,
                                 .bits = entry.bits,
                                 .sign_extend = is_signed(entry.type)});
  }

  std::uint64_t hash() const {
    std::uint64_t value = 0xCBF2'9CE4'8422'2325;  // FNV-1a, 64 bit
    const auto add = [&](std::string_view text) {
      for (const char c : text) {
        value = (value ^ static_cast<unsigned char>(c)) * 0x0000'0100'0000'01B3;
      }
      value = (value ^ 0xFF) * 0x0000'0100'0000'01B3;
    };
    for (const Signal& s : plan_.layout.signals) {
      add(plan_.nodes[s.node_index].name);
      add(s.name);
      add(to_string(s.object));
      add(s.output ? "out" : "in");
      add(std::to_string(static_cast<unsigned>(s.type)) + ":" + std::to_string(s.bits));
      add(s.unit);
      add(std::to_string(s.scale) + ":" + std::to_string(s.offset));
    }
    return value;
  }

  std::span<const NodePdos> nodes_;
  BusPlan& plan_;
  NetworkReport& report_;
  std::vector<Source> tpdo_sources_;
  std::vector<Source> rpdo_sources_;
  std::vector<Candidate> candidates_;
  std::map<std::tuple<bool, std::size_t, ObjectKey>, std::size_t> seen_;
  std::map<std::tuple<bool, std::size_t, ObjectKey, std::size_t>, SignalIndex> index_;
  std::map<std::pair<std::size_t, ObjectKey>, std::size_t> next_input_;
};

}  // namespace

void compile_layout(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report) {
  LayoutCompiler{nodes, plan, report}.run();
}

}  // namespace takt
