#pragma once
#include <chrono>
#include <string_view>
#include <vector>

#include "apps/axis/axis_group.hpp"
#include "apps/move/following.hpp"

namespace takt {

/// Lines about a running motion on stdout, each with the time since the start: every change of an
/// axis' state, and the positions a few times a second.
class Progress {
 public:
  void say(std::string_view text);
  /// States that changed since the last call, and what the daemon told.
  void states(AxisGroup& group);
  /// At most four lines a second.
  void positions(const AxisControl& axes, const Following& following, std::string_view what);
  void set_unit(std::string_view unit) { unit_ = unit; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_positions_{};
  std::vector<State402> told_;
  std::string unit_;
};

}  // namespace takt
