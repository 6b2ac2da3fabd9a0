#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Detects that the front thread did not run (stopped, swapped out, starved) by comparing the clock
/// with the thread's own schedule. Messages that waited in the transports meanwhile must be
/// discarded. All calls come from the front thread.
class FrontGap {
 public:
  explicit FrontGap(Time period) noexcept;

  /// Notes that the thread runs at `now`. Returns true if the thread should have run long before.
  bool ran(Time now) noexcept;
  /// Notes that the thread may sleep until `due`.
  void sleeps_until(Time due) noexcept { due_ = due; }
  /// Notes that the transports had no message left.
  void found_empty() noexcept { backlog_ = Backlog::none; }

  /// Returns the length of the newest gap, in which the front thread did not run.
  Time length() const noexcept { return length_; }
  /// Returns the end of the newest gap; 0 if there was none.
  Time end() const noexcept { return end_; }
  /// Returns true if commands that arrive now may have waited during the gap: until the transports
  /// were found empty, but at most for 1 s. The thread of a transport also needs a moment to hand
  /// over messages from the kernel's buffers.
  bool discards_commands(Time now) const noexcept;
  /// Returns true if requests that arrive now may have waited too long. Short gaps do not harm
  /// requests.
  bool discards_requests(Time now) const noexcept;
  /// Returns true if a gap of this length harms requests, and not only commands.
  static bool harms_requests(Time length) noexcept;

  /// A gap that was long enough to harm requests.
  struct LongGap {
    Time length{};
    Time end{};  ///< 0 if there was none
  };
  const LongGap& newest_long() const noexcept { return newest_long_; }

 private:
  enum class Backlog : std::uint8_t { none, possible };

  Time slack_;
  Time last_{never};
  Time due_{};
  Time length_{};
  Time end_{};
  LongGap newest_long_;
  Backlog backlog_ = Backlog::none;
};

}  // namespace takt
