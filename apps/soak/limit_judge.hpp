#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "apps/soak/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/world.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Holds target positions on the wire against `limits:` of the network file: each is within the
/// range, and no further from the one before it than the step and the velocity allow for the
/// cycles since that one was new. Where the drive does not follow set-points, or the master has
/// just begun to send them, they may follow the true position instead. From outside the range they
/// may come back.
class LimitJudge {
 public:
  LimitJudge(const BusPlan& plan, sim::World& world, Verdict& verdict);

  /// The master takes what its interface has kept since the cycle before.
  void begin_cycle(Time now);
  /// A set-point of so many bits is handed to the interface. `begins`: none was for some cycles.
  void sent(SignalIndex signal, std::uint64_t bits, bool begins, Time now);
  /// A position of this device is on the wire: somebody may have forged it, the master can't know.
  void heard(const Frame& frame);
  /// It is one of the newest positions on the wire.
  bool is_actual(SignalIndex signal, std::uint64_t bits) const noexcept;
  /// Set-points that were held against a limit.
  std::uint64_t judged() const noexcept { return judged_; }

 private:
  struct Seen {
    Time when{};
    std::int64_t position = 0;
  };
  struct Place {
    const OutputLimit* limit = nullptr;
    std::int64_t value = 0;
    Time when{};              ///< `value` was new
    std::deque<Seen> actual;  ///< positions on the wire since cycles_[0]; the newest is the last
  };

  double allowed(const Place& place, double cycles) const noexcept;
  bool near_axis(const Place& place, const Signal& signal, std::int64_t value);
  void judge_range(const Place& place, const Signal& signal, std::int64_t value, bool near);
  void blame(const Signal& signal, std::int64_t value, const std::string& what);

  const BusPlan& plan_;
  sim::World& world_;
  Verdict& verdict_;
  std::vector<Place> places_;     // by output
  std::array<Time, 6> cycles_{};  // begins of the newest; the oldest is the first
  std::uint64_t judged_ = 0;
};

}  // namespace takt
