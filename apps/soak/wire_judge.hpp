#pragma once
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "apps/soak/limit_judge.hpp"
#include "apps/soak/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Who sends commands: one bit for each program.
using SenderBit = std::uint32_t;

/// What an application knows of a value that it has sent.
struct SentCommand {
  SenderBit sender = 0;
  Time computed_from{};            ///< SYNC of the image
  std::uint32_t time_to_live = 0;  ///< cycles; 0: as configured
};

/// Holds the outputs on the wire against what the applications know by the true clock: no value is
/// older than its time to live, nobody moves an axis that somebody else holds, and each is within
/// its limits.
class WireJudge {
 public:
  WireJudge(const BusPlan& plan, sim::World& world, Verdict& verdict);

  /// An application has sent this value.
  void commanded(SignalIndex signal, std::int64_t value, const SentCommand& command);
  /// Nobody may ever see this value on the wire.
  void forged(SignalIndex signal, std::int64_t value);
  /// This sender has given up its outputs.
  void released(SenderBit sender, Time now);
  /// The daemon is a new process: the outputs belong to nobody, and nothing was sent so far.
  void begin_anew();
  /// The master begins a cycle.
  void begin_cycle(Time now) { limits_.begin_cycle(now); }
  /// Anything on the wire.
  void heard(const Frame& frame) { limits_.heard(frame); }
  /// What the master hands to the interface.
  void sent(std::span<const Frame> frames, Time now);
  /// Positions on the wire that an application had commanded.
  std::uint64_t moves() const noexcept { return moves_; }
  /// When a position of this sender was on the wire last.
  Time last_move(SenderBit sender) const noexcept;

 private:
  struct Known {
    Time until = -never;  ///< its time to live, and what is on the way
    Time computed_from{};
    Time held_until{};  ///< its sender certainly holds the node so long
    SenderBit senders = 0;
  };
  struct Holder {
    SenderBit sender = 0;
    Time until{};
  };
  struct Output {
    std::unordered_map<std::uint64_t, Known> known;
    std::uint64_t last = 0;
    Time when = -never;  ///< of `last`
  };

  void judge(SignalIndex signal, std::uint64_t value, Time now);
  void judge_holder(const Signal& signal, const Known& known, Time now);
  bool lasting(const Signal& signal, std::uint64_t value) const noexcept;
  void blame_stale(const Signal& signal, std::uint64_t value, const Known* known, Time now);
  Output& output(SignalIndex signal) { return outputs_[signal - plan_.layout.inputs]; }

  const BusPlan& plan_;
  Verdict& verdict_;
  std::vector<Output> outputs_;
  std::vector<Holder> holders_;  // order of BusPlan::nodes
  std::vector<Time> moved_;      // by the number of the sender's bit
  std::vector<Time> released_;   // the same
  LimitJudge limits_;
  std::uint64_t moves_ = 0;
};

}  // namespace takt
