#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "apps/takt/soak/evidence/way.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/bus/world.hpp"
#include "master/wire/frame.hpp"

namespace takt::soak {

/// Checks every limited output against `limits:` of the network file: range, step, velocity,
/// acceleration and torque. If a drive adds an offset to a target, the limits hold for the sum. The
/// judge reads the frames that the devices receive and the TPDOs on the wire, and uses nothing that
/// the master has computed. A distance ("way") is measured from the value sent before, over the
/// cycles since that value was new, and modulo the turn of the axis. While the drive does not
/// follow set-points, a position may also continue from the actual position of the axis. If a frame
/// can mean two things (a command may be repeated without a change), the judge assumes the
/// permitted one.
class LimitJudge {
 public:
  LimitJudge(const BusPlan& plan, sim::World& world, Verdict& verdict);

  /// Call this when the master begins a cycle, in which it reads all frames since the last one.
  void begin_cycle(Time now);
  /// Call this when the master passes a value of an output to the interface. `begins` is true if
  /// the output was not sent in the last cycles.
  void sent(SignalIndex signal, std::uint64_t bits, bool begins);
  /// Judges the values that were sent. Call this when the master has passed all its frames.
  void judge(Time now);
  /// Call this with each frame on the wire. The sender does not matter, because the master cannot
  /// know it.
  void heard(const Frame& frame);
  /// Call this when a new process of the daemon begins, which has sent nothing so far.
  void begin_anew();
  /// Returns true if this target equals one of the newest actual positions on the wire.
  bool is_actual(SignalIndex signal, std::uint64_t bits) const noexcept;
  /// Returns the number of values that were checked against a limit.
  std::uint64_t judged() const noexcept { return judged_; }

 private:
  struct Seen {
    Time when{};
    double position = 0;
  };
  /// The frames of an output, or of its offset, that were sent since the newest judge().
  enum class Change : std::uint8_t { none, value, begins };
  struct Place {
    const OutputLimit* limit = nullptr;
    std::optional<SignalIndex> controlword{};  ///< controlword of the same axis, if it is an output
    std::optional<double> value{};             ///< value sent last
    double target = 0;                         ///< the part of `value` that is no offset
    double offset = 0;                         ///< the offset in `value`, in its own counts
    Time when{};                               ///< time at which `value` was first sent
    std::optional<Way> last_way{};  ///< distance to `value`; empty if the drive did not follow
    std::int64_t mode = 0;          ///< 6060 as sent, otherwise 6061 as received
    bool ramped = false;            ///< `value` was sent in a mode in which the drive has ramps
    bool enables = false;           ///< the last controlword sent enables operation
    bool enabled = true;            ///< the last statusword received is enabled
    unsigned doubt = 0;             ///< cycles in which the master may not know the state
    unsigned mode_doubt = 0;        ///< cycles in which the master may not know the mode
    Change change = Change::none;
    std::deque<Seen> actual{};  ///< actual values since cycles_[0], newest last
  };

  void note_order(SignalIndex signal, std::uint64_t bits);
  void note_input(SignalIndex signal, std::uint64_t bits);
  bool follows(const Place& place) const noexcept;
  static void note_mode(Place& place, std::uint64_t bits) noexcept;
  std::optional<std::int64_t> mode_of(const Place& place) const noexcept;
  bool in_force(const Place& place) const noexcept;
  std::optional<double> limited_value(const Place& place) const noexcept;
  bool is_own(const Place& place) const noexcept;
  void judge_place(Place& place, Change change, Time now);
  bool in_profile(const Place& place) const noexcept;
  bool ramps(const Place& place) const noexcept;
  double length(const Place& place, double from, double to) const noexcept;
  Way way_to(const Place& place, double value, Time now) const noexcept;
  double reach(const Place& place, double cycles) const noexcept;
  bool near_axis(const Place& place, double value);
  void judge_range(const Place& place, double value);
  void judge_way(const Place& place, double value, const Way& way);
  void judge_bend(const Place& place, double value, const Way& way);
  void report_violation(const Place& place, double value, LimitKind kind, const std::string& what);
  const Signal& signal_of(const Place& place) const noexcept {
    return plan_.layout.signals[place.limit->signal];
  }

  const BusPlan& plan_;
  sim::World& world_;
  Verdict& verdict_;
  double most_cycles_;            // greatest number of cycles that counts for one distance
  std::vector<Place> places_;     // one for each output
  std::vector<Place*> limited_;   // places that have a limit
  std::vector<double> sent_;      // newest value of each output
  std::array<Time, 6> cycles_{};  // start times of the newest cycles, oldest first
  std::uint64_t judged_ = 0;
};

}  // namespace takt::soak
