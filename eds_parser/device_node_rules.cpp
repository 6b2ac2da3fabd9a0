#include "eds_parser/device_node_rules.hpp"

#include "eds_parser/device_data.hpp"

namespace takt {
namespace {

class NodeJudge {
 public:
  NodeJudge(const NodeSource& node, NetworkReport& report)
      : spec_{*node.spec}, data_{*node.data}, report_{report} {}

  void run() {
    node_id();
    reset();
  }

 private:
  void node_id() {
    const NumberRange& ids = data_.node_ids.ids;
    if (!spec_.id.given || ids.contains(*spec_.id)) return;
    report_.error(spec_.id.pos, "device-data",
                  "node `" + spec_.name + "` can't have node id " + std::to_string(*spec_.id) +
                      " as " + data_.name + ", only " + std::to_string(ids.low) + ".." +
                      std::to_string(ids.high) + data_.cite(data_.node_ids.fact));
  }

  /// The network file decides, though it may not know.
  void reset() {
    const auto& wanted = data_.boot.reset;
    if (!wanted || !spec_.reset.given || data_.boot.fact.reason.empty()) return;
    const bool whole = *spec_.reset == ResetPolicy::node;
    const bool whole_wanted = *wanted == ResetPolicy::node;
    if (whole == whole_wanted || *spec_.reset == ResetPolicy::none) return;
    report_.warning(spec_.reset.pos, "device-data",
                    "node `" + spec_.name + "` is better reset by `reset: " +
                        (whole_wanted ? "node" : "communication") + '`' +
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
