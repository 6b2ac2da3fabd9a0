#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "apps/soak/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/world.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Holds every limited output against `limits:` of the network file: range, step, velocity,
/// acceleration and torque. It reads the frames that the devices get and the TPDOs on the wire, and
/// uses nothing that the master has computed. A way counts from the value that was sent before,
/// over the cycles since that value was new, and modulo the turn of the axis. While the drive does
/// not follow set-points, a position may also go on from where the axis is. Where a frame can mean
/// two things (a command may be repeated without a change), the judge assumes what is allowed.
class LimitJudge {
 public:
  LimitJudge(const BusPlan& plan, sim::World& world, Verdict& verdict);

  /// The master begins a cycle and reads the frames that have come since the last one.
  void begin_cycle(Time now);
  /// A value of an output is handed to the interface. `begins`: it was not sent in the last cycles.
  void sent(SignalIndex signal, std::uint64_t bits, bool begins, Time now);
  /// A frame is on the wire. It counts whoever has sent it, because the master cannot know.
  void heard(const Frame& frame);
  /// The daemon is a new process: nothing was sent so far.
  void begin_anew();
  /// Whether this target is one of the newest actual positions on the wire.
  bool is_actual(SignalIndex signal, std::uint64_t bits) const noexcept;
  /// How many values were held against a limit.
  std::uint64_t judged() const noexcept { return judged_; }

 private:
  struct Seen {
    Time when{};
    double position = 0;
  };
  /// The way to a value: its length in counts, and the most cycles that it may have taken.
  struct Way {
    double length = 0;
    unsigned cycles = 1;
  };
  struct Place {
    const OutputLimit* limit = nullptr;
    std::optional<SignalIndex> controlword{};  ///< of the same axis, where it is an output
    std::optional<double> value{};             ///< sent last
    Time when{};                               ///< `value` was new
    std::optional<Way> last_way{};             ///< to `value`, while the drive followed
    std::int64_t mode = 0;                     ///< 6060 as it was sent, else 6061 as it was heard
    bool enables = false;                      ///< the controlword that was sent last
    bool enabled = true;                       ///< the statusword that was heard last
    unsigned doubt = 0;                        ///< cycles in which the master may not know better
    std::deque<Seen> actual{};                 ///< on the wire since cycles_[0], newest last
  };

  void note_order(SignalIndex signal, std::uint64_t bits);
  void note_input(SignalIndex signal, std::uint64_t bits);
  bool follows(const Place& place) const noexcept;
  bool in_profile(const Place& place) const noexcept;
  double length(const Place& place, double from, double to) const noexcept;
  Way way_to(const Place& place, double value, Time now) const noexcept;
  double reach(const Place& place, double cycles) const noexcept;
  bool near_axis(const Place& place, double value);
  void judge_range(const Place& place, double value);
  void judge_way(const Place& place, double value, const Way& way);
  void judge_bend(const Place& place, double value, const Way& way);
  bool too_sharp(const Place& place, const Way& way) const noexcept;
  void blame(const Place& place, double value, LimitKind kind, const std::string& what);
  const Signal& signal_of(const Place& place) const noexcept {
    return plan_.layout.signals[place.limit->signal];
  }

  const BusPlan& plan_;
  sim::World& world_;
  Verdict& verdict_;
  double most_cycles_;            // without a command, that count for one way
  std::vector<Place> places_;     // by output
  std::array<Time, 6> cycles_{};  // when the newest began; the oldest is the first
  std::uint64_t judged_ = 0;
};

}  // namespace takt
