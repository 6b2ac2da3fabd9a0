#pragma once
#include <algorithm>
#include <cstdint>
#include <string_view>
#include <takt/motion_command_t.hpp>

namespace takt {

/// The newest messages that one axis has taken. A copy of an older message, or a message that
/// arrives in another order, must not move the axis. LeaseTable refuses messages of an earlier
/// cycle than the newest one; this class orders the messages of the same cycle. All calls come from
/// the front thread.
class MotionSequence {
 public:
  void stopped(const motion_command_t& stop) noexcept {
    const bool same = stop_.instance == stop.instance;
    const std::int64_t cycle = same ? std::max(stop_.cycle, stop.cycle) : stop.cycle;
    stop_ = {.instance = stop.instance, .cycle = cycle, .utime = stop.utime};
    newest_stop_ = {.instance = stop.instance, .cycle = stop.cycle, .utime = stop.utime};
  }
  /// Returns true if the newest stop was the same message. A copy of a stop must not stop a motion
  /// that has begun since.
  bool is_copy(const motion_command_t& stop) const noexcept {
    return newest_stop_.instance == stop.instance && newest_stop_.cycle == stop.cycle &&
           newest_stop_.utime == stop.utime;
  }
  void moved(const motion_command_t& move) noexcept {
    move_ = {.instance = move.instance, .cycle = move.cycle, .utime = move.utime, .id = move.id};
  }

  /// Notes that a stream has begun.
  void streamed(const motion_command_t& stream) noexcept {
    stream_ = {.instance = stream.instance, .id = stream.id};
  }

  /// Returns why a message must not move the axis after a stop; an empty text if it may. `now` is
  /// the present cycle. A stop of a later cycle does not count, because the cycle by the clock goes
  /// back after SYNC was missing.
  std::string_view stop_objection(const motion_command_t& move, std::int64_t now) const noexcept {
    if (stop_.instance == move.instance && stop_.cycle <= now + 1 && move.cycle <= stop_.cycle) {
      return "it is not newer than the stop of its sender: both are from the same image, or the "
             "stop is from a later one";
    }
    return {};
  }
  /// Returns why a message must not begin a motion; an empty text if it may. A `move_by`, a gear or
  /// the start of a stream must be newer than each motion from the same image, because a copy of it
  /// would move the axis again.
  std::string_view objection(const motion_command_t& move, std::int64_t now) const noexcept {
    if (const std::string_view why = stop_objection(move, now); !why.empty()) return why;
    if (move_.instance != move.instance || move_.cycle != move.cycle) return {};
    if (move.utime < move_.utime) {
      return "a newer motion of its sender from the same image has already come";
    }
    const bool moves_again = move.kind == "move_by" || move.kind == "stream" || move.kind == "gear";
    if (moves_again && move.utime == move_.utime) {
      return "it may be a copy, which must not move the axis again: its utime is not later than "
             "that of the last motion of its sender from the same image";
    }
    return {};
  }
  /// Returns true if this is the stream that has begun last. Its further points must not begin it
  /// again.
  bool has_streamed(const motion_command_t& stream) const noexcept {
    return stream_.instance == stream.instance && stream_.id == stream.id;
  }

 private:
  struct Message {
    std::int64_t instance = 0;  ///< 0 means that no message has come
    std::int64_t cycle = 0;
    std::int64_t utime = 0;
    std::int32_t id = 0;
  };
  Message stop_;         ///< the cycle of this stop is the latest cycle of all stops of the sender
  Message newest_stop_;  ///< the stop that came last
  Message move_;
  Message stream_;  ///< only the instance and the id are set
};

}  // namespace takt
