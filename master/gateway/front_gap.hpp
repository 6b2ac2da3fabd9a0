#pragma once
#include "eds_parser/table/time.hpp"

namespace takt {

/// Detects that the front thread did not run (stopped, swapped out, starved) by comparing the clock
/// with the thread's own schedule. Messages that waited in the transports meanwhile must be
/// discarded. Front thread.
class FrontGap {
 public:
  explicit FrontGap(Time period) noexcept;

  /// Notes that the thread runs at `now`. Returns true if it should have run long before.
  bool ran(Time now) noexcept;
  /// Notes that the thread may sleep until `due`.
  void sleeps_until(Time due) noexcept { due_ = due; }

  /// Length of the newest gap, in which the front thread did not run.
  Time length() const noexcept { return length_; }
  /// Returns true if commands that arrive now may have waited during the gap. The thread of a
  /// transport needs a moment to hand over messages from the kernel's buffers.
  bool discards_commands(Time now) const noexcept { return now < discard_until_; }
  /// Returns true if requests that arrive now may have waited too long. Short gaps do not harm
  /// requests.
  bool discards_requests(Time now) const noexcept;

 private:
  Time slack_;
  Time last_{never};
  Time due_{};
  Time length_{};
  Time discard_until_{};
};

}  // namespace takt
