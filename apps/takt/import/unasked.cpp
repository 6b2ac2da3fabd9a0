#include "apps/takt/import/unasked.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include "eds_parser/specification/object_units.hpp"

namespace takt {
namespace {

/// Returns the key that controls a write of this object. Empty if the object is of no interest.
std::string_view key_of(ObjectKey object) {
  if (object == ObjectKey{0x1017, 0}) return "heartbeat_producer";
  if (object.index == 0x1016) return "heartbeat_consumer";
  const bool is_interpolation = first_axis(object.index) == 0x60C2 && object.sub == 1;
  return is_interpolation ? "sdo" : std::string_view{};
}

std::string_view remedy(std::string_view key) {
  if (key == "heartbeat_producer") return "`heartbeat_producer: 0` switches it off";
  if (key == "heartbeat_consumer") return "`heartbeat_consumer: false` switches it off";
  return "an entry in `sdo` sets another value";
}

class Unasked {
 public:
  Unasked(const YamlNode& root, const BusPlan& plan) : root_{root}, plan_{plan} {}

  std::vector<std::string> lines() {
    for (const NodePlan& node : plan_.nodes) {
      for (const BootStep& step : node.boot_plan.steps) add(node, step);
    }
    std::vector<std::string> lines = of_master();
    for (const auto& [what, nodes] : groups_) {
      lines.push_back(to_string(what.object) + " of " + nodes + ": " + what.purpose + "; " +
                      std::string{remedy(what.key)});
    }
    return lines;
  }

 private:
  struct What {
    ObjectKey object;
    std::string purpose;
    std::string_view key;
    bool operator==(const What&) const = default;
  };

  std::vector<std::string> of_master() const {
    const YamlNode* master = root_.find("master");
    const bool declared = master != nullptr && master->find("heartbeat_producer") != nullptr;
    if (declared || plan_.master_heartbeat == Time{}) return {};
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(plan_.master_heartbeat);
    return {"the master: heartbeat every " + std::to_string(ms.count()) +
            " ms; `heartbeat_producer: 0` switches it off"};
  }

  void add(const NodePlan& node, const BootStep& step) {
    const std::string_view key = key_of(step.object);
    const bool writes =
        step.action == BootAction::write || step.action == BootAction::write_if_differs;
    const bool listed = step.purpose.starts_with("sdo:") || step.purpose.starts_with("DCF:");
    if (key.empty() || !writes || listed || (key != "sdo" && is_declared(node.name, key))) return;
    const What what{step.object, step.purpose, key};
    auto found = std::ranges::find(groups_, what, &std::pair<What, std::string>::first);
    if (found == groups_.end()) found = groups_.insert(groups_.end(), {what, {}});
    found->second += (found->second.empty() ? "`" : ", `") + node.name + '`';
  }

  bool is_declared(const std::string& name, std::string_view key) const {
    const YamlNode* nodes = root_.find("nodes");
    const YamlNode* listed = nodes == nullptr ? nullptr : nodes->find(name);
    const YamlNode* node = listed == nullptr ? root_.find(name) : listed;
    const YamlNode* defaults = root_.find("defaults");
    return (node != nullptr && node->find(key) != nullptr) ||
           (defaults != nullptr && defaults->find(key) != nullptr);
  }

  const YamlNode& root_;
  const BusPlan& plan_;
  std::vector<std::pair<What, std::string>> groups_;  // actions with the names of their nodes
};

}  // namespace

std::vector<std::string> unasked(const YamlNode& root, const BusPlan& plan) {
  return Unasked{root, plan}.lines();
}

}  // namespace takt
