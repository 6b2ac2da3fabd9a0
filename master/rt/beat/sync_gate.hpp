#pragma once
#include <algorithm>

#include "eds_parser/table/waits.hpp"
#include "eds_parser/values/time.hpp"
#include "master/rt/port.hpp"

namespace takt {

/// Keeps SYNCs and outputs from piling up in the queue of an interface that is bus-off or gets
/// no acknowledgement: they would all go out at once, too old, when the bus returns. While the
/// echo of the newest SYNC is outstanding, the gate holds the next SYNC; from time to time it lets
/// one pass, in case only the echo was lost. For ports without echo, only bus-off closes the gate.
/// An interface that goes down loses its queue, so the gate is open when the interface comes back.
/// Bus thread only.
class SyncGate {
 public:
  explicit SyncGate(Time period) noexcept : tolerance_{period / 4} {}

  /// Returns true if the newest SYNC has not been seen on the wire.
  bool doubtful(const PortCondition& condition) const noexcept {
    return condition.last_sync_echo > Time{0} && condition.last_sync_echo + tolerance_ < last_sent_;
  }

  /// Returns true if the loop may hand the frames of this cycle to the interface.
  bool open(const PortCondition& condition, Time now) noexcept {
    if (condition.interface_down) last_sent_ = Time{0};
    if (condition.interface_down || (!condition.bus_off && !doubtful(condition))) {
      holding_ = false;
      pause_ = waits::held_sync_first;
      return true;
    }
    if (!holding_) {
      holding_ = true;
      try_at_ = now + pause_;
      return false;
    }
    if (condition.bus_off || now < try_at_) return false;
    pause_ = std::min(2 * pause_, waits::held_sync_longest);
    try_at_ = now + pause_;
    return true;
  }

  /// Notes that a SYNC was handed over.
  void sent(Time now) noexcept { last_sent_ = now; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(last_sent_, try_at_, pause_, holding_);
  }

 private:
  Time tolerance_;  // permitted difference between time stamps of the kernel and the clock of the
                    // port
  Time last_sent_{};
  Time try_at_{};
  Time pause_ = waits::held_sync_first;
  bool holding_ = false;
};

}  // namespace takt
