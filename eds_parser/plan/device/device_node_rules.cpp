#include "eds_parser/plan/device/device_rules.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

class NodeJudge {
 public:
  NodeJudge(const NodeSource& node, NetworkReport& report)
      : spec_{*node.spec}, data_{*node.data}, report_{report} {}

  void run() {
    node_id();
    heartbeat();
    for (const SdoSpec& sdo : spec_.sdo) heartbeat_by_sdo(sdo);
    reset();
  }

 private:
  void node_id() {
    const NumberRange& ids = data_.node_ids.ids;
    if (!spec_.id.given || ids.contains(*spec_.id)) return;
    report_.error(spec_.id.pos, "device-data", "node `", spec_.name, "` can't have node id ",
                  *spec_.id, " as ", data_.name, ", which allows only ", list_of({ids}),
                  data_.cite(data_.node_ids.fact));
  }

  void heartbeat() {
    const Sourced<std::uint16_t>& ms = spec_.heartbeat_producer;
    if (ms.given) rounded(ms.pos, "`heartbeat_producer` of node `" + spec_.name + "`", *ms);
  }

  void heartbeat_by_sdo(const SdoSpec& sdo) {
    const std::int64_t* value = sdo.integer();
    const bool consumer = sdo.object.index == 0x1016 && sdo.object.sub != 0;
    const bool producer = sdo.object == ObjectKey{0x1017, 0};
    if (value == nullptr || (!consumer && !producer)) return;
    rounded(sdo.value_pos, "`sdo` of node `" + spec_.name + "`: " + to_string(sdo.object),
            static_cast<std::uint32_t>(*value & 0xFFFF));
  }

  void rounded(SourcePos pos, const std::string& what, std::uint32_t ms) {
    const HeartbeatRule& rule = data_.heartbeat;
    const std::uint32_t kept = rule.kept(ms);
    if (kept == ms) return;
    const std::string text = concat(what, " is ", ms, " ms; ", data_.name, " counts in steps of ",
                                    rule.multiple_of_ms, " ms and rounds this time down to ", kept);
    if (kept == 0) {
      report_.error(pos, "device-data", text, ", which means off", data_.cite(rule.fact));
    } else {
      report_.warning(pos, "device-data", text, " ms", data_.cite(rule.fact));
    }
  }

  /// Warns if the network file resets the node differently from the device data. The network file
  /// decides.
  void reset() {
    const auto& wanted = data_.boot.reset;
    if (!wanted || !spec_.reset.given || data_.boot.fact.reason.empty()) return;
    const bool whole = *spec_.reset == ResetPolicy::node;
    const bool whole_wanted = *wanted == ResetPolicy::node;
    if (whole == whole_wanted || *spec_.reset == ResetPolicy::none) return;
    report_.warning(spec_.reset.pos, "device-data", "node `", spec_.name,
                    "` should be reset with `reset: ", whole_wanted ? "node" : "communication", "`",
                    data_.cite(data_.boot.fact));
  }

  const NodeSpec& spec_;
  const DeviceData& data_;
  NetworkReport& report_;
};

}  // namespace

void judge_node_by_device_data(const NodeSource& node, NetworkReport& report) {
  NodeJudge{node, report}.run();
}

}  // namespace takt
