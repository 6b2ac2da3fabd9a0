#pragma once
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <takt/axis.hpp>
#include <utility>
#include <vector>

#include "apps/move/set_points/following.hpp"
#include "apps/move/stop_reasons.hpp"

namespace takt {

/// Prints lines about a running motion on stdout, each with the time since the start: every change
/// of the state of an axis, and the positions a few times a second. Names and units come from the
/// bus, so every line is made safe for a terminal. Lines are lost if stdout is closed.
class Progress {
 public:
  void say(std::string_view text);
  /// Prints lines that begin without the time.
  static void print(std::string_view text);
  /// Prints the states that have changed since the last call, and the warnings and errors of taktd:
  /// at most one for each kind and node in two seconds.
  void states(AxisGroup& group);
  /// Returns true if states() has printed an event of this kind about the bus as a whole.
  bool has_said(const std::string& kind) const { return last_of_kind_.contains({0, kind}); }
  /// Returns why taktd has stopped motions, by the events that states() has taken.
  const StopReasons& stop_reasons() const noexcept { return stop_reasons_; }
  /// Prints the positions, at most four lines a second.
  void positions(const AxisControl& axes, const Following& following, std::string_view what);
  /// Sets the units, one for each axis.
  void set_units(std::vector<std::string> units) { units_ = std::move(units); }

 private:
  using Clock = std::chrono::steady_clock;
  bool reported_recently(const event_t& event);

  Clock::time_point start_ = Clock::now();
  Clock::time_point next_positions_{};
  std::vector<State402> reported_;
  std::map<std::pair<std::int16_t, std::string>, Clock::time_point> last_of_kind_;
  std::vector<std::string> units_;
  StopReasons stop_reasons_;
};

}  // namespace takt
