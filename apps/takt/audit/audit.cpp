#include "apps/takt/audit/audit.hpp"

#include <algorithm>
#include <utility>

#include "apps/takt/audit/supervision.hpp"

namespace takt {
namespace {

class NodeAuditor {
 public:
  NodeAuditor(const BusPlan& plan, std::size_t index, const DeviceValues& values)
      : plan_{plan}, index_{index}, node_{plan.nodes[index]}, values_{values} {}

  NodeAudit run() {
    out_.name = node_.name;
    out_.id = node_.id.value();
    out_.drive = node_.cia402;
    Supervision supervision = supervision_of(plan_, index_, values_);
    out_.notices = supervision.after;
    out_.how = std::move(supervision.how);
    if (!out_.notices && supervision.by_sync) out_.how = "no SYNC arrives (1006)";
    out_.besides = std::move(supervision.besides);
    report_state();
    judge(out_.drive ? drive_reaction(values_) : output_reaction(plan_, index_, values_));
    if (!node_.boot) out_.besides.emplace_back("takt does not configure this node (boot: false)");
    out_.besides.insert(out_.besides.end(), values_.notes().begin(), values_.notes().end());
    return std::move(out_);
  }

 private:
  void report_state() {
    const auto behaviour = values_.get({0x1029, 1});
    const std::string source = behaviour ? " (1029:01 = " + std::to_string(*behaviour) + ")"
                                         : " (the device has no 1029, which acts like 0)";
    constexpr const char* states[] = {"goes to PRE-OPERATIONAL", "STAYS OPERATIONAL",
                                      "goes to STOPPED",
                                      "changes its state as the manufacturer defines"};
    out_.state = static_cast<ErrorState>(std::min<std::uint64_t>(behaviour.value_or(0), 3));
    state_text_ = states[static_cast<std::size_t>(out_.state)] + source;
    if (out_.notices) out_.then = state_text_;
  }

  void judge(Reaction reaction) {
    if (reaction.verdict == Failsafe::harmless) {
      out_.verdict = Failsafe::harmless;
      out_.outputs = "the device takes no outputs from the master";
      out_.bus_off = state_text_;
      return;
    }
    if (!out_.drive) keep_in_operational(reaction);
    out_.bus_off = out_.notices ? "the same reaction, at once" : state_text_ + "; " + reaction.text;
    const bool notices = !out_.how.empty();
    out_.verdict = notices ? reaction.verdict : Failsafe::goes_on;
    out_.outputs = notices ? reaction.text : "KEEPS its last set-points without a time limit";
    if (!notices) advise_supervision();
    advise_values(reaction);
  }

  void advise_values(const Reaction& reaction) {
    report_fixed(reaction.fixed);
    if (reaction.remedy.empty()) return;
    if (!node_.boot && out_.remedy.empty()) out_.remedy.emplace_back(boot_line);
    std::string line = "sdo: [";
    for (const std::string& entry : reaction.remedy) {
      line += (line.ends_with('[') ? "" : ", ") + entry;
    }
    out_.remedy.push_back(line + "]   # in addition to the present entries");
  }

  void report_fixed(const std::vector<ObjectKey>& objects) {
    if (objects.empty()) return;
    std::string names;
    for (const ObjectKey key : objects) names += (names.empty() ? "" : ", ") + to_string(key);
    out_.besides.push_back("the EDS does not let " + names + " be changed so that " +
                           (out_.drive ? "the drive stops" : "the outputs change") +
                           ": only its power, or a hardware enable, stops the device");
  }

  /// Handles a device that stays OPERATIONAL. CiA 401 applies error values after a failure, and not
  /// every device sees a failure while it stays OPERATIONAL.
  void keep_in_operational(Reaction& reaction) {
    if (out_.state != ErrorState::operational) return;
    if (reaction.verdict == Failsafe::stops) reaction.verdict = Failsafe::unspecified;
    reaction.text += ", if the device counts this as a failure: see the manual";
    if (values_.takes({0x1029, 1}, 0)) {
      out_.remedy.emplace_back("error_behavior: {1: 0}   # leave OPERATIONAL");
    } else {
      out_.besides.emplace_back("the EDS does not let 1029:01 be changed to 0");
    }
  }

  void advise_supervision() {
    SupervisionRemedy remedy = supervision_remedy(plan_, index_, values_);
    const bool without_remedy =
        remedy.node.empty() && remedy.master.empty() && remedy.removal.empty();
    out_.master_remedy = std::move(remedy.master);
    out_.remedy.insert(out_.remedy.end(), remedy.node.begin(), remedy.node.end());
    if (!remedy.why.empty()) out_.besides.push_back(remedy.why);
    if (!remedy.removal.empty()) out_.besides.push_back(remedy.removal);
    if (without_remedy) {
      out_.besides.emplace_back(
          "the device can watch neither heartbeat nor guarding: only its power, or a hardware "
          "enable, stops the device");
    }
  }

  const BusPlan& plan_;
  std::size_t index_;
  const NodePlan& node_;
  const DeviceValues& values_;
  NodeAudit out_;
  std::string state_text_;
};

}  // namespace

bool Audit::goes_on() const {
  return std::ranges::find(nodes, Failsafe::goes_on, &NodeAudit::verdict) != nodes.end();
}

Audit audit(const BusPlan& plan, const std::vector<DeviceValues>& values) {
  Audit result{
      .bus = plan.name, .master_id = plan.master_id.value(), .heartbeat = plan.master_heartbeat};
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    result.nodes.push_back(NodeAuditor{plan, i, values[i]}.run());
  }
  return result;
}

}  // namespace takt
