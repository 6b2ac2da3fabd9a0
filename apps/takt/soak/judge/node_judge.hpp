#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/exchange/status_board.hpp"

namespace takt::soak {

/// Checks that every node is always in a known state, that each boot makes progress, and that all
/// nodes are ready at the end.
class NodeJudge {
 public:
  NodeJudge(const BusPlan& plan, Verdict& verdict);

  void judge(const StatusSnapshot& status, Time now);
  bool all_ready(const StatusSnapshot& status) const noexcept;
  /// Checks after the end of all faults that every node is ready.
  void judge_end(const StatusSnapshot& status);
  std::uint64_t boots(const StatusSnapshot& status) const noexcept;

 private:
  static constexpr Time time_limit = std::chrono::seconds{60};  ///< limit for one step of a boot

  struct Progress {
    BootState boot = BootState::idle;
    std::uint16_t step = 0;
    Time since{};
  };
  static bool ready(const NodeStatus& node) noexcept;
  std::string description(std::size_t index, const NodeStatus& node) const;

  const BusPlan& plan_;
  Verdict& verdict_;
  std::vector<Progress> progress_;
};

}  // namespace takt::soak
