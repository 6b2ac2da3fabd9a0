#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "master/motion/beat/axis_report.hpp"
#include "master/motion/beat/gear_player.hpp"
#include "master/motion/beat/motion_order.hpp"
#include "master/motion/beat/profile_player.hpp"
#include "master/motion/beat/stream_player.hpp"

namespace takt::motion {

/// Number of cycles since the newest message of the sender of a motion (`sender`), and since its
/// newest message that names the axis (`jog`).
struct Silence {
  CycleNumber sender = 0;
  CycleNumber jog = 0;
};

/// Numbers of the signals of measured leaders; empty if there is none.
using LeaderSignals = std::array<std::optional<std::uint16_t>, 2>;

/// Runs the motions of one axis, cycle by cycle. Its states:
///
/// | from             | to        | when                                                      |
/// |------------------|-----------|-----------------------------------------------------------|
/// | unpowered        | standing  | the drive is enabled: it stands at its commanded position |
/// | standing, moving | moving    | an order begins in its cycle                              |
/// | moving           | standing  | the profile or the points have ended at rest              |
/// | moving           | stopping  | stop()                                                    |
/// | stopping         | standing  | the axis is at rest                                       |
/// | moving, stopping | standing  | abandon()                                                 |
/// | any other         | unpowered | the drive is certainly not enabled any longer             |
///
/// A cycle calls observe(), then stop() if the group stops, then begin() or refuse() if an order is
/// due, then run(). No call allocates memory. The number of instructions of each call is bounded;
/// stop() takes the most.
class AxisRunner {
 public:
  /// The largest difference between the start of an order and the commanded state that counts as
  /// rounding. It is relative to the limits of velocity and acceleration. For the position, it is
  /// relative to the position or to 1, whichever is larger.
  static constexpr double start_tolerance = 1e-9;

  /// `period` is in s. Until a motion begins, the axis is the only one in its group.
  AxisRunner(double period, std::uint8_t axis) noexcept
      : period_{period}, axis_{axis}, group_{axis} {}

  /// Takes an order, which waits for its first cycle and replaces another order that waits. Returns
  /// a refusal if the order is unsound, is the second one since the last run(), or begins a stream
  /// while the axis follows one.
  Outcome wait(const MotionOrder& order) noexcept;
  /// Returns the order that waits.
  const MotionOrder* waiting() const noexcept { return waiting_ ? &*waiting_ : nullptr; }
  /// Returns the order that waits if its first cycle is this one or has passed.
  const MotionOrder* due(CycleNumber cycle) const noexcept;
  /// Returns Outcome::none if the order that is due may begin.
  Outcome objection(CycleNumber cycle) noexcept;
  void begin(CycleNumber cycle) noexcept;
  void refuse(Outcome why) noexcept;
  /// Appends points to the stream of the order that waits or runs.
  void add_points(const StreamPoints& points) noexcept;

  /// Takes the condition of the drive. Returns the cause if the axis makes its group stop.
  StopCause observe(CycleNumber cycle, const AxisInput& input, const Silence& silence) noexcept;
  /// Starts the shortest stop from the commanded state of the previous cycle. It also ends an order
  /// that waits. An axis that does not move keeps its state.
  void stop(const Stop& stop) noexcept;
  /// Ends the motion, and an order that waits, at once. The axis is then at rest at its commanded
  /// position.
  void abandon(const Stop& stop) noexcept;
  /// Makes the axis the only one in its group until its next motion. The axis is no longer kept
  /// alive.
  void leave_group() noexcept;
  /// Makes the sender count as silent from now on.
  void forget_sender() noexcept { sender_ = no_sender; }
  /// Notes that the sender has named the axis.
  void renew_jog(const LifeSign& sign) noexcept {
    const bool is_older = named_.sender == sign.sender && named_.cycle > sign.cycle;
    if (!is_older) named_ = sign;
  }
  /// Returns the number of cycles since this sender has named the axis.
  CycleNumber jog_silence(std::uint8_t sender, CycleNumber cycle) const noexcept {
    if (sender != named_.sender) return std::numeric_limits<CycleNumber>::max();
    return cycle - std::min(named_.cycle, cycle);
  }
  /// Ends the gear of the axis: it keeps its velocity until the next motion begins.
  void release_gear() noexcept {
    if (has_gear()) gear_.release();
  }
  /// Returns true if the axis follows a leader.
  bool has_gear() const noexcept {
    return report_.state == AxisState::moving && source_ == Source::gear;
  }
  /// Returns true if the axis follows a leader, and its gear was not released.
  bool has_leader() const noexcept { return has_gear() && gear_.phase() != GearPhase::released; }
  /// Returns the gear that the axis follows.
  const GearTask& gear() const noexcept { return gear_.task(); }
  /// Returns the signals of measured leaders: for the gear that the axis follows, and for the order
  /// that is due. Only begin() or refuse() decides which of them follow() needs.
  LeaderSignals leader_signals(CycleNumber cycle) const noexcept;
  /// Makes the next step of the gear, before run(). If the axis must stop, its stop begins at once,
  /// and the function returns the cause.
  StopCause follow(const LeaderState& leader, const LeaderSample& sample) noexcept;
  /// Runs one cycle. The report contains the commanded state.
  const AxisReport& run(CycleNumber cycle) noexcept;
  /// Forgets the orders that have ended. Call this before the orders of the next cycle are taken.
  void forget_ended() noexcept { report_.ended.clear(); }

  std::uint8_t group() const noexcept { return group_; }
  /// Returns true if the axis follows a stream of points.
  bool is_streaming() const noexcept {
    return report_.state == AxisState::moving && source_ == Source::points;
  }
  /// Returns true if the last run() has ended the stream of the axis at its last point.
  bool has_done_stream() const noexcept {
    const auto is_done = [](const EndedOrder& order) { return order.outcome == Outcome::done; };
    return source_ == Source::points && std::ranges::any_of(report_.ended.orders(), is_done);
  }
  /// Returns the time of the last point of the stream, in s.
  double end_of_points() const noexcept { return stream_.last().time; }
  /// Returns the number of points that wait in the stream.
  std::size_t points() const noexcept { return stream_.size(); }
  /// Returns the sender of the newest motion, or `no_sender`.
  std::uint8_t sender() const noexcept { return sender_; }
  /// Returns the id of the newest motion that began; 0 means none.
  std::uint32_t newest() const noexcept { return newest_; }
  /// Returns true if a drive with a motion has to stay enabled although no SYNC is sent. `silence`
  /// is the number of cycles since the newest message of the sender.
  bool outlives(CycleNumber silence) const noexcept {
    return newest_ != 0 && report_.state != AxisState::unpowered && silence <= timeout_;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(report_, source_, player_, stream_, gear_, geared_, range_.min, range_.max, named_,
          stop_limits_, timeout_, latest_stop_, max_following_error_, waiting_, newest_, last_run_,
          has_taken_, follows_, is_unsent_, passed_);
    state.position(group_, max_axes);
    state.position(sender_, max_axes + 1);
  }

 private:
  static constexpr std::uint8_t no_sender = max_axes;
  static constexpr double longest_stop = 60.0;  // s, for a gear that begins while the axis moves
  /// The source of the states of a motion.
  enum class Source : std::uint8_t { profile, points, gear };
  static constexpr Source source_of(Ending ending) noexcept {
    if (ending == Ending::points) return Source::points;
    return ending == Ending::gear ? Source::gear : Source::profile;
  }

  void wait_for_drive(CycleNumber cycle, bool is_unsent) noexcept;
  State commanded_at(CycleNumber cycle) noexcept;
  double time_at(CycleNumber cycle) const noexcept {
    return static_cast<double>(cycle - report_.began) * period_;
  }
  bool points_end_at_rest() const noexcept;
  bool can_stop_from(const State& state) const noexcept;
  Limits limits_of_gear(const MotionOrder& gear) const noexcept;
  bool can_stop_with(const MotionOrder& gear) const noexcept;
  StopCause cause_of_motion(CycleNumber cycle, const Silence& silence) const noexcept;
  void end_or_count_down(CycleNumber cycle) noexcept;
  void note(const Stop& stop) noexcept;
  void end(Outcome outcome) noexcept;
  void end(std::uint32_t id, Outcome outcome) noexcept {
    report_.ended.add({.id = id, .outcome = outcome});
  }

  double period_;
  std::uint8_t axis_;
  AxisReport report_;
  Source source_ = Source::profile;
  ProfilePlayer player_;
  StreamPlayer stream_;       ///< stream of the motion that runs, or of an order that waits
  GearPlayer gear_;           ///< gear of the motion that runs
  State geared_;              ///< the state of this cycle, while the axis follows a gear
  PositionRange range_;       ///< range of the gear
  LifeSign named_;            ///< the newest message that has named the axis
  CycleNumber last_run_ = 0;  ///< the cycle of the commanded state
  CycleNumber passed_ = 1;    ///< cycles by the clock since the last run()
  Limits stop_limits_;
  CycleNumber timeout_ = 0;
  CycleNumber latest_stop_ = 0;
  double max_following_error_ = 0.0;
  std::optional<MotionOrder> waiting_;
  std::uint32_t newest_ = 0;
  bool has_taken_ = false;  ///< an order was taken since the last run()
  bool follows_ = false;    ///< the drive follows set-points in this cycle
  bool is_unsent_ = false;  ///< the set-point of the previous beat was not sent
  std::uint8_t group_;
  std::uint8_t sender_ = 0;
};

}  // namespace takt::motion
