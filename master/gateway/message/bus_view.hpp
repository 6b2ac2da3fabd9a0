#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "master/lcm/messages.hpp"
#include "master/units/units.hpp"

namespace takt {

/// The state of one bus according to its messages. It joins the parts of messages and forgets old
/// sessions.
class BusView {
 public:
  void take(const status_t& status);
  void take(const layout_t& layout);
  void take(const image_t& image);
  void take(const timing_t& timing) { timing_ = timing; }
  void take(const pdo_status_t& pdos);
  void take(const sync_status_t& sync);
  void take(const speed_axes_t& axes);
  void take(const motion_t& motions);
  void take(event_t event);

  /// Returns the newest status with all nodes, joined from its parts; empty until all parts of one
  /// status have arrived.
  const std::optional<status_t>& status() const noexcept { return status_; }
  const std::optional<timing_t>& timing() const noexcept { return timing_; }
  /// Returns the newest state of all PDOs, joined in the same way.
  const std::optional<pdo_status_t>& pdos() const noexcept { return pdos_; }
  const std::optional<sync_status_t>& sync() const noexcept { return sync_; }
  /// Returns the state of the motions of all axes; empty while the daemon runs no motions.
  const std::optional<motion_t>& motions() const noexcept { return motions_; }
  /// Returns the speed axes, whose positions are those of signals().
  std::span<const speed_axis_t> speed_axes() const noexcept;
  const std::deque<event_t>& events() const noexcept { return events_; }

  /// Signals of the layout; empty until all parts have arrived.
  const std::vector<signal_t>& signals() const noexcept { return signals_; }
  /// Returns the values in the order of signals(); empty before the first complete image.
  const std::vector<std::int64_t>& values() const noexcept { return values_; }
  bool stale(std::size_t signal) const noexcept { return stale_[signal]; }
  const Units& units() const noexcept { return units_; }
  std::int64_t cycle() const noexcept { return cycle_; }
  std::int64_t session() const noexcept { return session_; }
  /// Returns the number of images whose parts all arrived.
  std::uint64_t images() const noexcept { return images_; }
  /// Returns true if the messages come from two daemons with the same bus name.
  bool two_daemons() const noexcept { return two_daemons_; }

 private:
  void new_session(std::int64_t session);
  bool is_of_this_session(std::int64_t session);
  void finish_layout();

  std::optional<status_t> status_;
  std::optional<status_t> status_parts_;  // incomplete
  std::optional<timing_t> timing_;
  std::optional<sync_status_t> sync_;
  std::optional<pdo_status_t> pdos_;
  std::optional<pdo_status_t> pdo_parts_;  // incomplete
  std::optional<motion_t> motions_;
  std::optional<motion_t> motion_parts_;  // incomplete
  std::optional<speed_axes_t> speed_axes_;
  std::optional<speed_axes_t> speed_parts_;  // incomplete
  std::deque<event_t> events_;
  std::int64_t layout_hash_ = 0;
  std::map<std::int32_t, signal_t> layout_parts_;  // incomplete
  std::vector<signal_t> signals_;
  Units units_;
  std::vector<std::int64_t> values_;
  std::vector<bool> stale_;
  std::vector<std::int64_t> next_values_;  // incomplete
  std::vector<bool> next_stale_;
  std::int16_t next_part_ = 0;
  std::int64_t next_cycle_ = 0;
  std::int64_t cycle_ = 0;
  std::int64_t session_ = 0;
  std::int64_t earlier_session_ = 0;
  std::uint64_t images_ = 0;
  bool two_daemons_ = false;
};

/// All buses that send messages, by the bus part of their channels.
class BusViews {
 public:
  /// Takes a message of any channel. Returns an empty string, or a sentence if the bytes cannot be
  /// decoded.
  std::string take(std::string_view channel, Bytes data);
  const std::map<std::string, BusView, std::less<>>& buses() const noexcept { return buses_; }

 private:
  std::map<std::string, BusView, std::less<>> buses_;
};

}  // namespace takt
