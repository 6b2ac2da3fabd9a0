#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/wire/frame.hpp"

namespace takt::soak {

/// Remembers the commands and checks the frames that the master passes to the interface against
/// them: the master sends a value only within the time to live of its command, two SYNCs never
/// follow each other in a burst, and the SYNC counter has no gap and starts at 1 only after an NMT
/// command that resets it.
class OutputJudge {
 public:
  OutputJudge(const BusPlan& plan, Verdict& verdict);

  /// `time_to_live` is in cycles and must not be 0.
  void commanded(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live, Time now);
  void sent(std::span<const Frame> frames, Time now);
  /// Call this for an NMT command to the master itself, which causes no frame.
  void ordered() noexcept { ++own_orders_; }

 private:
  struct Command {
    std::uint64_t value = 0;
    Time until{};  ///< end of the time to live, plus the delay between front and bus thread
  };
  static constexpr std::size_t depth = 32;

  void judge_sync(const Frame& frame, Time now);
  void judge_counter(std::uint8_t counter, Time now);
  void note_nmt(const Frame& frame, Time now);
  void judge_pdo(const PdoRow& row, const Frame& frame, Time now);
  bool fresh(std::size_t output, std::uint64_t value, Time now) const noexcept;

  const BusPlan& plan_;
  Verdict& verdict_;
  std::vector<std::array<Command, depth>> commands_;
  std::vector<std::uint64_t> count_;
  Time last_sync_{};
  std::uint8_t last_counter_ = 0;
  bool stopped_ = false;     ///< NMT has stopped the whole network, including the master
  Time restarts_ = -never;   ///< time of the newest NMT command that lets the counter start at 1
  unsigned own_orders_ = 0;  ///< commands to the master, each of which permits one start at 1
  Time restarted_ = never;   ///< time of a start at 1 whose NMT command is not yet known
};

}  // namespace takt::soak
