#include "eds_parser/budget/traffic.hpp"

#include <algorithm>
#include <utility>

#include "eds_parser/budget/service_traffic.hpp"
#include "eds_parser/plan/frame_time.hpp"
#include "eds_parser/report/message.hpp"

namespace takt {
namespace {

constexpr Time nmt_interval = std::chrono::seconds{1};

/// Returns the frame's bits in the order of arbitration. A base identifier goes before the extended
/// identifiers that begin with it, and data go before a remote request. ISO 11898-1, 10.4.
std::uint64_t rank(const TrafficFrame& frame) noexcept {
  const std::uint64_t id = frame.cob_id.id();
  const std::uint64_t remote = frame.remote_request ? 1 : 0;
  if (!frame.cob_id.is_extended()) return id << 21 | remote << 20;
  return (id >> 18) << 21 | 3ULL << 19 | (id & 0x3FFFF) << 1 | remote;
}

bool is_polled(const PdoRow& pdo) noexcept { return pdo.poll > Time{0} || pdo.poll_syncs != 0; }

/// Returns whether the device sends the PDO only on request (types 252 and 253), never on an event.
bool only_on_request(const PdoRow& pdo) noexcept {
  return pdo.transmission == 252 || pdo.transmission == 253;
}

CobId error_control_id(NodeId node) noexcept { return CobId::base(0x700U + node.value()); }

/// Typical PDOs of n bytes, with small values and many zeros, have about 2 + 0.9 n stuff bits.
double typical_bits(const TrafficFrame& frame) noexcept {
  return shortest_frame_bits(frame.bytes, frame.cob_id.is_extended()) + 2.0 + 0.9 * frame.bytes;
}

double seconds(Time time) noexcept { return std::chrono::duration<double>(time).count(); }

enum class Sender : std::uint8_t { master, device };

class TrafficCollector {
 public:
  TrafficCollector(const BusPlan& plan, const BudgetOptions& options)
      : plan_{plan}, options_{options} {}

  BusTraffic run() {
    collect_master();
    for (const auto& row : plan_.pdos.tpdos) add_tpdo(row);
    for (const auto& row : plan_.pdos.rpdos) add_rpdo(row);
    for (const auto& node : plan_.nodes) collect_node(node);
    services_ = service_share(plan_, bus_load(out_, plan_.bitrate).worst);
    collect_sdo();
    std::ranges::stable_sort(out_.frames, {}, rank);
    out_.service_dialogues = services_.dialogues;
    out_.service_round = services_.round;
    report_assumptions();
    return std::move(out_);
  }

 private:
  TrafficFrame& add(Sender sender, Traffic kind, std::string name, CobId id, unsigned bytes,
                    Time period = {}) {
    return out_.frames.emplace_back(
        TrafficFrame{.name = std::move(name),
                     .kind = kind,
                     .cob_id = id,
                     .from_master = sender == Sender::master,
                     .bytes = static_cast<std::uint8_t>(bytes),
                     .frame = wire_time(worst_frame_bits(bytes, id.is_extended()), plan_.bitrate),
                     .period = period});
  }

  TrafficFrame& add_request(std::string name, CobId id, Time period) {
    auto& request = add(Sender::master, Traffic::remote, std::move(name), id, 0, period);
    request.remote_request = true;
    return request;
  }

  void collect_master() {
    add(Sender::master, Traffic::nmt, "NMT", CobId::base(0), 2, nmt_interval);
    if (plan_.time.period > Time{0}) {
      add(Sender::master, Traffic::time, "TIME", plan_.time.cob_id, 6, plan_.time.period);
    }
    if (plan_.cycle.sync) {
      auto& sync =
          add(plan_.cycle.makes_sync() ? Sender::master : Sender::device, Traffic::sync, "SYNC",
              plan_.cycle.sync_cob_id, plan_.cycle.sync_overflow != 0 ? 1 : 0, plan_.cycle.period);
      sync.in_cycle = true;
      limit_by_period(sync);
    }
    if (plan_.master_heartbeat > Time{0}) {
      auto& frame = add(Sender::master, Traffic::error_control, "heartbeat master",
                        error_control_id(plan_.master_id), 1, plan_.master_heartbeat);
      limit_by_consumers(frame, plan_.master_id);
    }
  }

  /// Limits a frame by a receiver that waits at most `wait` for the next one. The shortest limit
  /// counts.
  static void limit_by_wait(TrafficFrame& frame, Time wait, std::string who) {
    if (wait <= Time{0}) return;
    const Time beyond_period = std::max(wait - frame.period, Time{0});
    if (frame.limit && *frame.limit <= beyond_period) return;
    frame.limit = beyond_period;
    frame.why = BudgetLimit::timeout;
    frame.waits = std::move(who);
  }

  /// Limits a frame by the devices that watch the heartbeats of `producer`.
  void limit_by_consumers(TrafficFrame& frame, NodeId producer) const {
    for (const auto& node : plan_.nodes) {
      for (const auto& watch : node.watches) {
        if (watch.producer == producer)
          limit_by_wait(frame, watch.longest, node.name + " (0x1016)");
      }
    }
  }

  std::string name_of(const PdoRow& pdo, std::string_view kind) const {
    return concat(kind, pdo.number, ' ', plan_.nodes[pdo.node_index].name);
  }

  /// An MPDO has one row for each object. The frames of these rows share one identifier.
  bool joins_frame_of_its_mpdo(const PdoRow& pdo, Traffic kind) {
    if (!pdo.multiplexed()) return false;
    const auto same = std::ranges::find_if(out_.frames, [&](const TrafficFrame& frame) {
      return frame.kind == kind && frame.cob_id == pdo.cob_id;
    });
    if (same == out_.frames.end()) return false;
    ++same->burst;
    return true;
  }

  void add_tpdo(const PdoRow& pdo) {
    if (joins_frame_of_its_mpdo(pdo, Traffic::tpdo)) return;
    const bool in_cycle = plan_.cycle.sync && pdo.synchronous();
    auto& frame = add(Sender::device, Traffic::tpdo, name_of(pdo, "TPDO"), pdo.cob_id, pdo.length);
    frame.in_cycle = in_cycle;
    frame.awaited = in_cycle && pdo.cyclic();
    set_rate(frame, pdo);
    if (is_polled(pdo)) add_poll(pdo);
  }

  void add_rpdo(const PdoRow& pdo) {
    if (joins_frame_of_its_mpdo(pdo, Traffic::rpdo)) return;
    auto& frame = add(Sender::master, Traffic::rpdo, name_of(pdo, "RPDO"), pdo.cob_id, pdo.length);
    frame.in_cycle = plan_.cycle.sync && !pdo.on_request;
    set_rate(frame, pdo);
    // The master's own cyclic PDOs are all due at the same SYNC.
    if (frame.every > 1) frame.turn.reset();
  }

  void add_poll(const PdoRow& pdo) {
    add_request(name_of(pdo, "request of TPDO"), pdo.cob_id, poll_period(pdo));
    if (pdo.synchronous() || only_on_request(pdo)) return;
    limit_by_period(add(Sender::device, Traffic::tpdo, name_of(pdo, "answer of TPDO"), pdo.cob_id,
                        pdo.length, poll_period(pdo)));
  }

  Time poll_period(const PdoRow& pdo) const {
    return pdo.poll > Time{0} ? pdo.poll : pdo.poll_syncs * plan_.cycle.period;
  }

  void set_rate(TrafficFrame& frame, const PdoRow& pdo) {
    frame.period = plan_.cycle.period;
    frame.on_change = !pdo.cyclic();
    if (plan_.cycle.sync && pdo.cyclic()) {
      frame.every = pdo.transmission;
      frame.period = frame.every * plan_.cycle.period;
      frame.turn = certain_turn(pdo);
    } else if (plan_.cycle.sync && pdo.synchronous()) {
      return;
    } else if (frame.from_master) {
      frame.period = std::max(pdo.inhibit, plan_.cycle.period);
    } else if (is_polled(pdo) && only_on_request(pdo)) {
      frame.period = poll_period(pdo);
      limit_by_period(frame);
    } else {
      set_rate_of_events(frame, pdo);
    }
  }

  /// An event timer is an additional cause of sending. No cause sends within the inhibit time.
  void set_rate_of_events(TrafficFrame& frame, const PdoRow& pdo) {
    if (pdo.inhibit > Time{0}) {
      frame.period = pdo.inhibit;
    } else if (pdo.event_timer > Time{0} && pdo.event_timer <= plan_.cycle.period) {
      frame.period = pdo.event_timer;
      append_item(by_timer_, frame.name);
    } else {
      frame.period_assumed = true;
      return;
    }
    limit_by_period(frame);
  }

  static void limit_by_period(TrafficFrame& frame) {
    frame.limit = frame.period;
    frame.why = BudgetLimit::own_period;
  }

  /// Returns the turn that the SYNC counter determines, if the counter overflows with the same
  /// phase each time.
  std::optional<std::uint16_t> certain_turn(const PdoRow& pdo) const {
    const unsigned overflow = plan_.cycle.sync_overflow;
    if (pdo.sync_start == 0 || overflow < 2 || overflow % pdo.transmission != 0) return {};
    return static_cast<std::uint16_t>(pdo.sync_start % pdo.transmission);
  }

  void collect_node(const NodePlan& node) {
    add(Sender::device, Traffic::emcy, "EMCY " + node.name,
        node.emcy_cob_id.value_or(CobId::base(0x080U + node.id.value())), longest_data,
        options_.emcy_interval);
    if (node.heartbeat_period > Time{0}) {
      add_heartbeat(node);
    } else if (node.guard.period > Time{0}) {
      add_guarding(node);
    }
  }

  void add_heartbeat(const NodePlan& node) {
    auto& frame = add(Sender::device, Traffic::error_control, "heartbeat " + node.name,
                      error_control_id(node.id), 1, node.heartbeat_period);
    limit_by_wait(frame, node.heartbeat_timeout, "the master");
    limit_by_consumers(frame, node.id);
  }

  /// The device detects missing requests by its life guarding, and the master detects missing
  /// answers.
  void add_guarding(const NodePlan& node) {
    const CobId id = error_control_id(node.id);
    limit_by_wait(add_request("guard request " + node.name, id, node.guard.period),
                  node.life_guarding, node.name + " (0x100D)");
    auto& answer = add(Sender::device, Traffic::error_control, "guarding " + node.name, id, 1,
                       node.guard.period);
    answer.answers = true;
    limit_by_wait(answer, node.guard.life_time(), "the master");
  }

  /// The identifiers of the first node represent those of all nodes.
  void collect_sdo() {
    if (plan_.nodes.empty()) return;
    const unsigned first = plan_.nodes.front().id.value();
    for (const bool request : {false, true}) {
      auto& frame =
          add(request ? Sender::master : Sender::device, Traffic::sdo,
              request ? "SDO requests" : "SDO answers",
              CobId::base((request ? 0x600U : 0x580U) + first), longest_data, services_.round);
      frame.burst = services_.dialogues;
      frame.jitter = services_.round;
      frame.answers = !request;
      limit_by_timeouts(frame);
    }
  }

  void limit_by_timeouts(TrafficFrame& frame) const {
    for (const auto& node : plan_.nodes) {
      if (node.sdo_timeout <= Time{0} || (frame.limit && *frame.limit <= node.sdo_timeout))
        continue;
      frame.limit = node.sdo_timeout;
      frame.why = BudgetLimit::timeout;
      frame.waits = "the master (sdo_timeout of " + node.name + ")";
    }
  }

  void report_assumptions() {
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(options_.device_time);
    out_.assumptions.push_back(
        concat("devices have their TPDOs ready ", us.count(), " us after SYNC (--device-time)"));
    std::string free;
    for (const auto& frame : out_.frames) {
      if (frame.period_assumed) append_item(free, frame.name);
    }
    assume(
        "no inhibit time: counted once per cycle, although the device may send at every change of "
        "a value: ",
        free);
    assume(
        "no inhibit time: counted once per event timer, although the device may also send at every "
        "change of a value: ",
        by_timer_);
  }

  void assume(const std::string& what, const std::string& names) {
    if (!names.empty()) out_.assumptions.push_back(what + names);
  }

  const BusPlan& plan_;
  const BudgetOptions& options_;
  ServiceShare services_;
  BusTraffic out_;
  std::string by_timer_;  ///< names of the frames that are sent by a timer
};

}  // namespace

BusTraffic bus_traffic(const BusPlan& plan, const BudgetOptions& options) {
  return TrafficCollector{plan, options}.run();
}

BusLoad bus_load(const BusTraffic& traffic, std::uint32_t bitrate) noexcept {
  BusLoad load;
  for (const auto& frame : traffic.frames) {
    const double worst = seconds(frame.frame) * frame.burst / seconds(frame.period);
    if (frame.kind == Traffic::sdo) {
      load.services += worst;
    } else if (frame.kind != Traffic::nmt && frame.kind != Traffic::emcy) {
      load.worst += worst;
      load.typical += typical_bits(frame) * frame.burst / bitrate / seconds(frame.period);
    }
  }
  return load;
}

std::vector<std::string> left_out_tpdos(const Findings& findings) {
  std::vector<std::string> reported;
  for (const Finding& finding : findings) {
    const std::string_view pdos =
        std::string_view{finding.message}.substr(0, finding.message.find(" of node "));
    const bool tpdo = pdos.find("TPDO") != std::string_view::npos;
    if (finding.rule == "pdo-left-out" && tpdo)
      reported.push_back("not counted: " + finding.message);
  }
  return reported;
}

}  // namespace takt
