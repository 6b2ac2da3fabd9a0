#pragma once
#include <cstdint>
#include <deque>
#include <string>
#include <takt/event_t.hpp>

namespace takt {

/// The reasons why taktd has stopped motions, from its newest events `motion_stopped`.
class StopReasons {
 public:
  /// Keeps the event if it has the reason of a stop.
  void take(const event_t& event);
  /// Returns what taktd has reported about the stop of this motion. If taktd has given several
  /// reasons, returns the first that is not a pause. Returns an empty text if no event has come.
  std::string of(std::int32_t id) const;
  /// Returns true if taktd has given a reason, and if each reason is that the sender of the motion
  /// was silent, that SYNC was missing, or that set-points were not sent. Only then may the motion
  /// begin again by itself.
  bool only_paused(std::int32_t id) const;

 private:
  std::deque<std::string> texts_;
};

}  // namespace takt
