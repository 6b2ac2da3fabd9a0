#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/soak/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/status_board.hpp"

namespace takt {

/// Every node is in a named state, a boot makes progress, and in the end all are ready.
class NodeJudge {
 public:
  NodeJudge(const BusPlan& plan, Verdict& verdict);

  void judge(const StatusSnapshot& status, Time now);
  bool all_ready(const StatusSnapshot& status) const noexcept;
  /// The faults are over and this is what is left.
  void judge_end(const StatusSnapshot& status);
  std::uint64_t boots(const StatusSnapshot& status) const noexcept;

 private:
  static constexpr Time patience = std::chrono::seconds{60};  ///< for one step of a boot

  struct Progress {
    BootState boot = BootState::idle;
    std::uint16_t step = 0;
    Time since{};
  };
  static bool ready(const NodeStatus& node) noexcept;
  std::string story(std::size_t index, const NodeStatus& node) const;

  const BusPlan& plan_;
  Verdict& verdict_;
  std::vector<Progress> progress_;
};

}  // namespace takt
