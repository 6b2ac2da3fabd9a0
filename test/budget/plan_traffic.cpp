#include "test/budget/plan_traffic.hpp"

#include <algorithm>
#include <utility>

namespace takt {
namespace {

constexpr std::uint8_t longest_data = 8;
constexpr Time nmt_distance = std::chrono::seconds{1};

bool only_on_request(const PdoRow& pdo) {
  return pdo.transmission == 252 || pdo.transmission == 253;
}

class PlanTraffic {
 public:
  explicit PlanTraffic(const BusPlan& plan) : plan_{plan} {}

  std::vector<PlanFrame> run(Dialogues dialogues) {
    add_master();
    for (const auto& pdo : plan_.pdos.tpdos) add_tpdo(pdo);
    for (const auto& pdo : plan_.pdos.rpdos) add_rpdo(pdo);
    for (const auto& node : plan_.nodes) add_node(node);
    add_dialogues(dialogues);
    return std::move(out_);
  }

 private:
  void add_master() {
    in_slack(Traffic::nmt, CobId::base(0), 2, nmt_distance);
    if (plan_.cycle.sync) {
      out_.push_back({.cob_id = plan_.cycle.sync_cob_id,
                      .bytes = static_cast<std::uint8_t>(plan_.cycle.sync_overflow != 0),
                      .kind = Traffic::sync,
                      .sent = Sent::sync});
    }
    if (plan_.time.period > Time{0})
      in_slack(Traffic::time, plan_.time.cob_id, 6, plan_.time.period);
    if (plan_.master_heartbeat > Time{0}) {
      in_slack(Traffic::error_control, CobId::base(0x700U + plan_.master_id.value()), 1,
               plan_.master_heartbeat);
    }
  }

  PlanFrame& in_slack(Traffic kind, CobId id, std::uint8_t bytes, Time distance) {
    return out_.emplace_back(PlanFrame{
        .cob_id = id, .bytes = bytes, .kind = kind, .sent = Sent::in_slack, .distance = distance});
  }

  /// Adds a remote request of the master and the answer of the device.
  void add_asked(Traffic kind, CobId id, std::uint8_t bytes, Time distance) {
    auto& request = in_slack(Traffic::remote, id, 0, distance);
    request.remote_request = true;
    request.answer = out_.size();
    out_.push_back({.cob_id = id, .bytes = bytes, .kind = kind, .sent = Sent::on_request});
  }

  void add_tpdo(const PdoRow& pdo) {
    PlanFrame frame{.cob_id = pdo.cob_id, .bytes = pdo.length, .kind = Traffic::tpdo};
    if (pdo.poll > Time{0}) add_asked(Traffic::tpdo, pdo.cob_id, pdo.length, pdo.poll);
    if (pdo.poll_syncs != 0)
      add_asked(Traffic::tpdo, pdo.cob_id, pdo.length, pdo.poll_syncs * plan_.cycle.period);
    if (only_on_request(pdo)) return;
    if (plan_.cycle.sync && pdo.synchronous()) {
      frame.sent = Sent::after_sync;
      frame.awaited = pdo.cyclic();
      frame.every = std::max<unsigned>(pdo.transmission, 1);
      frame.turn = turn_of(pdo);
    } else {
      frame.distance = least_distance(pdo);
    }
    out_.push_back(frame);
  }

  /// Without an inhibit time, values change once per cycle. An event timer sends in addition.
  Time least_distance(const PdoRow& pdo) const {
    if (pdo.inhibit > Time{0}) return pdo.inhibit;
    const Time timer = pdo.event_timer > Time{0} ? pdo.event_timer : plan_.cycle.period;
    return std::min(timer, plan_.cycle.period);
  }

  /// The number of the first SYNC that carries the start value. CiA 301, 7.5.2.37.
  unsigned turn_of(const PdoRow& pdo) const {
    const unsigned overflow = plan_.cycle.sync_overflow;
    if (!pdo.cyclic() || pdo.sync_start == 0 || overflow % pdo.transmission != 0) return 0;
    unsigned cycle = 1;
    while (1 + (cycle - 1) % overflow != pdo.sync_start) ++cycle;
    return cycle % pdo.transmission;
  }

  void add_rpdo(const PdoRow& pdo) {
    const bool cyclic = plan_.cycle.sync && pdo.cyclic();
    out_.push_back({.cob_id = pdo.cob_id,
                    .bytes = pdo.length,
                    .kind = Traffic::rpdo,
                    .sent = Sent::outputs,
                    .every = cyclic ? pdo.transmission : 1U,
                    .distance = pdo.inhibit});
  }

  void add_node(const NodePlan& node) {
    const auto error_control = CobId::base(0x700U + node.id.value());
    out_.push_back({.cob_id = node.emcy_cob_id.value_or(CobId::base(0x080U + node.id.value())),
                    .bytes = longest_data,
                    .kind = Traffic::emcy,
                    .sent = Sent::as_emcy});
    if (node.heartbeat_period > Time{0}) {
      out_.push_back({.cob_id = error_control,
                      .bytes = 1,
                      .kind = Traffic::error_control,
                      .distance = node.heartbeat_period});
    } else if (node.guard.period > Time{0}) {
      add_asked(Traffic::error_control, error_control, 1, node.guard.period);
    }
  }

  /// Adds SDO requests and answers. A server answers when it has done what was requested.
  void add_dialogues(Dialogues dialogues) {
    if (plan_.nodes.empty() || dialogues.count == 0) return;
    const unsigned id = plan_.nodes.front().id.value();
    for (const bool request : {true, false}) {
      out_.push_back({.cob_id = CobId::base((request ? 0x600U : 0x580U) + id),
                      .bytes = longest_data,
                      .kind = Traffic::sdo,
                      .sent = request ? Sent::in_slack : Sent::by_itself,
                      .distance = dialogues.round,
                      .burst = dialogues.count});
    }
  }

  const BusPlan& plan_;
  std::vector<PlanFrame> out_;
};

}  // namespace

std::vector<PlanFrame> traffic_of(const BusPlan& plan, Dialogues dialogues) {
  return PlanTraffic{plan}.run(dialogues);
}

}  // namespace takt
