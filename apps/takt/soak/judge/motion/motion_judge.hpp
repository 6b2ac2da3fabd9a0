#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "apps/takt/soak/evidence/way.hpp"
#include "apps/takt/soak/judge/motion/group_judge.hpp"
#include "apps/takt/soak/judge/motion/holder_judge.hpp"
#include "apps/takt/soak/judge/motion/motion_orders.hpp"
#include "apps/takt/soak/judge/motion/path_judge.hpp"
#include "master/wire/frame.hpp"

namespace takt::soak {

/// Checks the target positions on the wire against the motions that programs have sent: an axis
/// keeps the limits of its motion, its motion comes to rest at the target of a program that holds
/// the node, a group begins in one cycle, and it ends if one of its drives does not follow any
/// longer; a stream and a gear are where PathJudge expects them. The judge uses what was sent over
/// LCM and the frames on the wire, and nothing that the master has computed.
class MotionJudge {
 public:
  MotionJudge(const BusPlan& plan, Verdict& verdict, HolderJudge& holders);

  /// Call this when a program has sent this message to the present process of the daemon.
  void commanded(const SentMotion& sent, Time now);
  /// Call this when a new process of the daemon begins.
  void begin_anew();
  /// Call this when the ordered stop begins: the master then commands the outputs itself.
  void begin_stop() {
    stops_ = true;
    paths_.disturbed(never);
  }
  /// Call this when a fault of a program or of the daemon begins that may last until this time.
  void disturbed(Time until) { paths_.disturbed(until); }
  /// Call this when the master begins a cycle.
  void begin_cycle(Time now);
  /// Call this with each frame on the wire.
  void heard(const Frame& frame);
  /// Call this when the master passes a SYNC to the interface.
  void sync_sent();

  /// The cause of a target position on the wire.
  struct Cause {
    bool begins = false;        ///< the output was not sent in the last cycles
    bool by_set_point = false;  ///< a set-point or the actual position explains the value
  };
  /// Call this when the master passes a target position to the interface.
  void sent(SignalIndex target, std::int64_t value, const Cause& cause, Time now);

  /// Returns true if a motion may explain the value of this output: a target position or a velocity
  /// offset.
  bool explains(SignalIndex output, Time now) const noexcept;
  /// Returns true if motions have set this target position in this run of the daemon.
  bool was_led(SignalIndex target) const noexcept;
  const MotionOrders& orders() const noexcept { return orders_; }
  /// Returns the number of motions that have come to rest at their targets.
  std::uint64_t arrivals() const noexcept { return arrivals_; }
  /// Returns the number of groups whose begin was seen.
  std::uint64_t groups() const noexcept { return groups_.judged(); }
  const PathJudge& paths() const noexcept { return paths_; }

 private:
  struct Axis {
    std::optional<double> value{};  ///< newest target position, in counts
    Time when{};                    ///< time at which `value` was first sent
    Time sent_at{};                 ///< time at which the last frame was sent
    std::optional<Way> last_way{};  ///< way of that frame; empty if the drive did not follow
    std::uint64_t syncs = 0;        ///< number of SYNCs on the wire until that frame
    bool enabled = false;           ///< the last statusword is that of an enabled drive
    unsigned doubt = 0;             ///< cycles in which the master may not know the state
    unsigned disabled_cycles = 0;   ///< cycles that have begun since the drive was disabled
    unsigned silent_cycles = 0;     ///< number of SYNCs since the last statusword of the drive
    bool judged_rest = true;        ///< the rest at `value` was judged
  };

  void watch(const SentMotion& sent, Time now);
  void judge_failure(std::size_t axis, Time now);
  void judge_rest(std::size_t axis);
  void judge_way(std::size_t axis, const Way& way, unsigned syncs, Time now);
  void end_cycle(Time now);
  void sync_heard() noexcept;
  void report_violation(std::size_t axis, const char* invariant, const std::string& what);

  const BusPlan& plan_;
  Verdict& verdict_;
  HolderJudge& holders_;
  MotionOrders orders_;
  GroupJudge groups_;
  PathJudge paths_;
  std::vector<Axis> axes_;
  double most_cycles_;  // greatest number of cycles that counts for one distance
  Time last_cycle_{};
  unsigned late_cycles_ = 0;  // a SYNC was left out in the last cycles
  unsigned cycles_without_sync_ = 0;
  std::uint64_t syncs_ = 0;  // number of SYNCs on the wire
  std::uint64_t syncs_at_cycle_ = 0;
  bool stops_ = false;  // the ordered stop has begun
  std::uint64_t arrivals_ = 0;
};

}  // namespace takt::soak
