#pragma once
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "apps/takt/soak/judge/limit_judge.hpp"
#include "apps/takt/soak/judge/motion/holder_judge.hpp"
#include "apps/takt/soak/judge/motion/motion_judge.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/wire/frame.hpp"

namespace takt::soak {

/// Describes a value that an application has sent.
struct SentCommand {
  SenderBit sender = 0;
  Time computed_from{};            ///< SYNC time of the image that the value was computed from
  std::uint32_t time_to_live = 0;  ///< cycles; 0 means as configured
};

/// Checks the outputs on the wire against the commands of the applications, by the true clock: no
/// value is older than its time to live, no axis moves without a motion or set-point of a program
/// that is alive, no program moves an axis that another one holds, and each output is within its
/// limits.
class WireJudge {
 public:
  WireJudge(const BusPlan& plan, sim::World& world, Verdict& verdict);

  /// Call this when an application has sent this value.
  void commanded(SignalIndex signal, std::int64_t value, const SentCommand& command);
  /// Call this when an application has sent this message about motions to the present process of
  /// the daemon.
  void commanded(const SentMotion& motion, Time now) { motions_.commanded(motion, now); }
  /// Call this with a forged value, which must never appear on the wire.
  void forged(SignalIndex signal, std::int64_t value);
  /// Call this when this sender has given up its outputs.
  void released(SenderBit sender, Time now) { holders_.released(sender, now); }
  /// Call this when the ordered stop begins.
  void begin_stop() { motions_.begin_stop(); }
  /// Call this if a fault of a program or of the daemon begins that may last until this time.
  void disturbed(Time until) { motions_.disturbed(until); }
  /// Call this when the daemon is a new process: no sender holds the outputs, and nothing was sent
  /// so far.
  void begin_anew();
  /// Call this when the master begins a cycle.
  void begin_cycle(Time now) {
    limits_.begin_cycle(now);
    motions_.begin_cycle(now);
  }
  /// Call this with each frame on the wire.
  void heard(const Frame& frame) {
    limits_.heard(frame);
    motions_.heard(frame);
  }
  /// Call this with the frames that the master passes to the interface.
  void sent(std::span<const Frame> frames, Time now);
  /// Returns the number of positions on the wire that an application had commanded.
  std::uint64_t moves() const noexcept { return moves_; }
  /// Returns the time at which a position of this sender, or of its motions, was last on the wire.
  Time last_move(SenderBit sender) const noexcept { return holders_.last_move(sender); }
  const MotionJudge& motions() const noexcept { return motions_; }

 private:
  struct Known {
    Time until = -never;  ///< end of the time to live, plus the time to the wire
    Time computed_from{};
    Time held_until{};  ///< until then the sender certainly holds the node
    SenderBit senders = 0;
  };
  struct Output {
    std::unordered_map<std::uint64_t, Known> known;
    std::uint64_t last = 0;
    Time when = -never;  ///< time at which `last` was sent
  };

  void judge(SignalIndex signal, std::uint64_t value, Time now);
  void judge_holder(const Signal& signal, const Known& known, Time now);
  bool by_motion(SignalIndex signal, std::uint64_t value, bool changed, Time now) const noexcept;
  void report_stale_output(const Signal& signal, std::uint64_t value, const Known* known, Time now);
  Output& output(SignalIndex signal) { return outputs_[signal - plan_.layout.inputs]; }

  const BusPlan& plan_;
  Verdict& verdict_;
  std::vector<Output> outputs_;
  HolderJudge holders_;
  LimitJudge limits_;
  MotionJudge motions_;
  std::uint64_t moves_ = 0;
};

}  // namespace takt::soak
