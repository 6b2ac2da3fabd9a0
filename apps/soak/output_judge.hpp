#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "apps/soak/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Remembers what was commanded and holds it against what the master hands to the interface: a
/// value goes out only while its command is within its time to live; SYNC beats evenly and counts
/// without a gap, from 1 on where NMT of the whole network begins it anew.
class OutputJudge {
 public:
  OutputJudge(const BusPlan& plan, Verdict& verdict);

  /// `time_to_live` in cycles, not 0.
  void commanded(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live, Time now);
  void sent(std::span<const Frame> frames, Time now);
  /// NMT for the master itself, of which no frame tells.
  void ordered() noexcept { ++own_orders_; }

 private:
  struct Command {
    std::uint64_t value = 0;
    Time until{};  ///< its time to live, and what may be lost between front and bus thread
  };
  static constexpr std::size_t depth = 32;

  void judge_sync(const Frame& frame, Time now);
  void judge_counter(std::uint8_t counter, Time now);
  void note_nmt(const Frame& frame, Time now);
  void judge_pdo(const PdoRow& row, const Frame& frame, Time now);
  bool lasting(const Signal& signal, std::uint64_t value) const noexcept;
  bool fresh(std::size_t output, std::uint64_t value, Time now) const noexcept;

  const BusPlan& plan_;
  Verdict& verdict_;
  std::vector<std::array<Command, depth>> commands_;
  std::vector<std::uint64_t> count_;
  Time last_sync_{};
  std::uint8_t last_counter_ = 0;
  bool stopped_ = false;     ///< the whole network, and the master with it
  Time restarts_ = -never;   ///< the newest NMT command that lets the counter start at 1
  unsigned own_orders_ = 0;  ///< each may let it start at 1 once
  Time restarted_ = never;   ///< it did so, and no such command is known yet
};

}  // namespace takt
