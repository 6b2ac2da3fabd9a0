#pragma once
#include "eds_parser/table/time.hpp"

namespace takt {

/// Finds out that the front thread did not run (stopped, swapped out, starved), by its own
/// timetable. What waited in the transports meanwhile is to be discarded. Front thread.
class FrontGap {
 public:
  explicit FrontGap(Time period) noexcept;

  /// The thread runs at `now`. True: it should have run long before.
  bool ran(Time now) noexcept;
  /// It may sleep until `due`.
  void sleeps_until(Time due) noexcept { due_ = due; }

  /// Length of the newest gap: how long the front thread did not run.
  Time length() const noexcept { return length_; }
  /// Commands that come now may have waited over the gap. A transport's own thread needs a moment
  /// to hand over what was in the kernel's buffers.
  bool discards_commands(Time now) const noexcept { return now < discard_until_; }
  /// So may requests; short gaps do them no harm.
  bool discards_requests(Time now) const noexcept;

 private:
  Time slack_;
  Time last_{never};
  Time due_{};
  Time length_{};
  Time discard_until_{};
};

}  // namespace takt
