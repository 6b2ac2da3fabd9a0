#pragma once
#include <algorithm>
#include <cstdint>
#include <string_view>
#include <takt/motion_command_t.hpp>

namespace takt {

/// The newest messages that one axis has taken. A copy of an older one, or one that has come in
/// another order, must not move the axis. LeaseTable refuses those of an earlier cycle than the
/// newest one; this class orders those of the same cycle. Front thread.
class MotionSequence {
 public:
  void stopped(const motion_command_t& stop) noexcept {
    const bool same = stop_.instance == stop.instance;
    const std::int64_t cycle = same ? std::max(stop_.cycle, stop.cycle) : stop.cycle;
    stop_ = {.instance = stop.instance, .cycle = cycle, .utime = stop.utime};
  }
  void moved(const motion_command_t& move) noexcept {
    move_ = {.instance = move.instance, .cycle = move.cycle, .utime = move.utime, .id = move.id};
  }

  /// Returns why a move or jog is refused; empty if it is not. `now` is the present cycle: a later
  /// one cannot judge, because the clock goes back if SYNC stood still.
  std::string_view objection(const motion_command_t& move, std::int64_t now) const noexcept {
    if (stop_.instance == move.instance && stop_.cycle <= now + 1 && move.cycle <= stop_.cycle) {
      return "it is not newer than the stop of its sender: both are from the same image, or the "
             "stop is from a later one";
    }
    if (move_.instance == move.instance && move_.cycle == move.cycle && move.utime < move_.utime) {
      return "a newer motion of its sender from the same image has overtaken it";
    }
    if (move.kind == "move_by" && has_come(move)) return copy;
    return {};
  }
  /// Returns true if this message was the newest motion before, or has all of its numbers.
  bool has_come(const motion_command_t& move) const noexcept {
    return move_.instance == move.instance && move_.cycle == move.cycle &&
           move_.utime == move.utime && move_.id == move.id;
  }
  static constexpr std::string_view copy = "it has come before: a copy must not move again";

 private:
  struct Message {
    std::int64_t instance = 0;  ///< 0: none has come
    std::int64_t cycle = 0;
    std::int64_t utime = 0;
    std::int32_t id = 0;
  };
  Message stop_;
  Message move_;
};

}  // namespace takt
