#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/node_status.hpp"

namespace takt {

/// Holds back a SYNC with counter until the first node is about to be started. Before that, the
/// devices do not know the counter (0x1019): they report each SYNC as one of unexpected length
/// (EMCY 0x8240, CiA 301, 7.2.5.3), and some then stay out of OPERATIONAL. Bus thread only.
class SyncHold {
 public:
  explicit SyncHold(const BusPlan& plan) : open_{plan.cycle.sync_overflow == 0} {
    steps_.reserve(plan.nodes.size());
    for (const NodePlan& node : plan.nodes) steps_.push_back(last_before_start(node.boot_plan));
  }

  /// Returns true if SYNC may be sent; once true, the result stays true. `nodes` has the order of
  /// the plan.
  bool open(std::span<const NodeStatus> nodes) noexcept {
    if (open_) return true;
    bool booting = false;
    for (std::size_t i = 0; i < nodes.size() && i < steps_.size(); ++i) {
      const bool runs = nodes[i].boot == BootState::booting;
      booting = booting || runs;
      open_ =
          open_ || nodes[i].boot == BootState::ready || (runs && nodes[i].boot_step >= steps_[i]);
    }
    open_ = open_ || !booting;
    return open_;
  }

  /// Returns true if SYNC was permitted before.
  bool is_open() const noexcept { return open_; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(open_);
  }

 private:
  /// Returns the index of the wait for the first heartbeat, or of the start itself. Returns the end
  /// of the plan if there is neither.
  static std::size_t last_before_start(const BootPlan& plan) noexcept {
    const auto start = std::ranges::find_if(plan.steps, [](const BootStep& step) {
      return step.action == BootAction::nmt && step.command == NmtCommand::start;
    });
    const auto at = static_cast<std::size_t>(start - plan.steps.begin());
    const bool waits = at > 0 && plan.steps[at - 1].action == BootAction::await_heartbeat;
    return waits ? at - 1 : at;
  }

  std::vector<std::size_t> steps_;  // per node: the step from which on the node knows the counter
  bool open_;
};

}  // namespace takt
