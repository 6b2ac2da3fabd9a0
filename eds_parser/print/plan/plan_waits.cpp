#include "eds_parser/print/plan/plan_waits.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>

#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"
#include "eds_parser/table/waits.hpp"

namespace takt {
namespace {

bool has_lss(const NodePlan& node) { return node.lss.has_value(); }

class Waits {
 public:
  explicit Waits(const BusPlan& plan) : plan_{plan} {}

  std::vector<PlanWait> list() {
    sdo();
    pdos();
    lss();
    sync();
    add("transfer_silence", waits::transfer_silence,
        "message from an application during its file transfer");
    stop();
    return std::move(list_);
  }

 private:
  void add(const char* wait, Time limit, std::string what) {
    list_.push_back({.wait = wait, .limit = limit, .what = std::move(what)});
  }

  /// Returns "every node", or the names of the nodes for which `holds` is true.
  template <class Holds>
  std::string nodes(Holds holds) const {
    std::string names;
    for (const NodePlan& node : plan_.nodes) {
      if (holds(node)) names += (names.empty() ? "" : ", ") + node.name;
    }
    return std::ranges::all_of(plan_.nodes, holds) ? "every node" : names;
  }

  void sdo() {
    std::set<Time> limits;
    for (const NodePlan& node : plan_.nodes) limits.insert(node.sdo_timeout);
    for (const Time limit : limits) {
      const auto has = [limit](const NodePlan& node) { return node.sdo_timeout == limit; };
      add("sdo_answer", limit,
          fmt::format("SDO answer of {}; a boot asks up to {} times and writes once; a block "
                      "upload asks for missing segments after {}",
                      nodes(has), waits::upload_attempts, span_text(waits::block_silence(limit))));
    }
    sdo_objects();
    if (!plan_.nodes.empty()) {
      add("sdo_probe", waits::probe_try,
          "one attempt of a probe; the next one follows at once, after an abort " +
              span_text(waits::probe_pause) + " later");
      add("sdo_settle", waits::sdo_settle,
          "segments still in transit when a device aborts a block download");
    }
    add("sdo_sub_block", waits::sub_block_end,
        "service frames of the master while a device sends a sub-block, for each block upload in "
        "progress");
    add("sdo_server", waits::own_server, "next frame of a client of the master's own SDO server");
  }

  using ObjectLimit = std::pair<Time, std::string>;

  /// Returns the time-outs of objects. If an object has several entries, the first one counts.
  static std::set<ObjectLimit> object_limits(const SdoAccess& sdo) {
    std::set<ObjectLimit> limits;
    for (const SdoObjectTimeout& entry : sdo.timeouts) {
      const auto first = std::ranges::find_if(sdo.timeouts, [&](const SdoObjectTimeout& other) {
        return other.index == entry.index && (!other.sub || other.sub == entry.sub);
      });
      if (&*first != &entry) continue;
      const std::string index = fmt::format("{:04X}", entry.index);
      limits.emplace(entry.timeout,
                     entry.sub ? fmt::format("{}:{:02X}", index, *entry.sub) : index);
    }
    return limits;
  }

  /// Adds the objects that have separate time-outs. Objects of the same nodes with the same limit
  /// share a line.
  void sdo_objects() {
    std::set<ObjectLimit> limits;
    for (const NodePlan& node : plan_.nodes) limits.merge(object_limits(node.sdo));
    std::map<ObjectLimit, std::string> rows;  // maps limit and nodes to objects
    for (const ObjectLimit& limit : limits) {
      const std::string whose =
          nodes([&](const NodePlan& node) { return object_limits(node.sdo).contains(limit); });
      std::string& objects = rows[{limit.first, whose}];
      objects += (objects.empty() ? "" : ", ") + limit.second;
    }
    for (const auto& [row, objects] : rows) {
      add("sdo_object", row.first, "SDO answer of " + row.second + " for " + objects);
    }
  }

  void pdos() {
    add("pdo_answer", waits::pdo_answer,
        "TPDO of a request without time-out; the same time again for a late TPDO");
    add("pdo_turn", waits::pdo_turn(waits::pdo_answer),
        fmt::format(
            "end of earlier requests for the same PDO; {} if the waiting request sends an RPDO",
            span_text(2 * waits::pdo_turn(waits::pdo_answer))));
  }

  void lss() {
    add("lss_answer", waits::lss_answer, "LSS answer of one device");
    add("lss_store", waits::lss_store, "LSS answer to `store`, which writes flash memory");
    add("lss_all", waits::lss_all,
        fmt::format("LSS answers of all devices, always the full time; in a scan down to {}",
                    span_text(waits::lss_shortest)));
    if (std::ranges::none_of(plan_.nodes, has_lss)) return;
    add("lss_look_again", waits::lss_look_again,
        "pause between two searches for a node without id");
    add("lss_let_boot", waits::lss_let_boot,
        "boot-up of a node that has got its id, before the next search for it");
  }

  void sync() {
    const CyclePlan& cycle = plan_.cycle;
    if (cycle.makes_sync()) {
      add("held_sync", waits::held_sync_longest,
          fmt::format(
              "next attempt of a SYNC that no node acknowledges: {}, then twice as long each time",
              span_text(waits::held_sync_first)));
    } else if (cycle.sync) {
      add("first_sync", std::max<Time>(waits::first_sync, cycle.sync_timeout),
          "first SYNC of the other device, after the boots of all nodes");
    }
  }

  void stop() {
    const auto limits = waits::stop_limits(plan_.stop_timeout, plan_.cycle.period);
    add("stop_fallback", limits.fallback, "ordered stop: outputs take their fallback");
    add("stop_quick_stop", limits.quick_stop,
        "ordered stop: axes stop by quick stop; each is disabled at standstill");
    add("stop_disable", limits.disable, "ordered stop: axes that are still enabled are disabled");
    add("stop_disarm", limits.disarm, "ordered stop: the devices stop watching the master");
    add("stop_nmt", limits.nmt, "ordered stop: nodes get their last NMT command");
  }

  const BusPlan& plan_;
  std::vector<PlanWait> list_;
};

}  // namespace

std::vector<PlanWait> plan_waits(const BusPlan& plan) { return Waits{plan}.list(); }

void add_waits(PlanLines& lines, const BusPlan& plan) {
  lines.line("");
  lines.line(
      "waits: the longest duration of each; waits for nodes, PDOs and boots are listed there");
  for (const PlanWait& wait : plan_waits(plan)) {
    lines.line("{:>9}  {}", span_text(wait.limit), wait.what);
  }
}

}  // namespace takt
