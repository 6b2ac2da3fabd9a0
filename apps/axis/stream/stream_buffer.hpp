#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <takt/motion_stream_t.hpp>
#include <vector>

namespace takt {

/// Keeps the points of a stream for taktd, and determines which of them to send in each cycle. It
/// knows the time of the stream from the reports of taktd. Each message repeats the points that are
/// not reached yet, so that a message that was lost does no harm.
///
/// The stream begins when the points reach `lead` ahead, or with finish().
class StreamBuffer {
 public:
  /// Seconds for which points are sent in advance.
  static constexpr double lead = 0.4;
  /// Longest time between two points in seconds. taktd takes no point more than 5 s in advance.
  static constexpr double longest_step = 4.0;
  /// Largest number of points that wait at taktd, which has room for 64.
  static constexpr std::int64_t most_waiting = 60;

  /// The stream begins at rest at these positions. `period` is that of SYNC in seconds.
  StreamBuffer(const std::vector<double>& positions, double period);

  /// Appends a point. Returns what is wrong with it, or an empty text. A point at time 0 replaces
  /// the point at which the stream begins.
  std::string add(motion_point_t point);
  /// Call this if no further points come for the time being. The stream then begins with the points
  /// that are there.
  void finish() noexcept { starts_ = true; }
  /// Takes a report of this cycle: the stream runs, and its points end in `time_left` seconds.
  void observe(std::int64_t cycle, double time_left) noexcept;
  /// Fills in the points of the message that is due in this cycle. Returns false if none is due.
  bool fill(std::int64_t cycle, motion_stream_t& message);

  /// Returns true if all points are sent or will be sent soon, so that further points may be added.
  bool has_room() const noexcept;
  /// Returns true if there is at least one point besides that at which the stream begins.
  bool has_points() const noexcept { return end() > 1; }

 private:
  enum class Due : std::uint8_t { nothing, new_points, repetition };

  std::int64_t end() const noexcept { return first_ + static_cast<std::int64_t>(points_.size()); }
  double time_of(std::int64_t number) const noexcept {
    return points_[static_cast<std::size_t>(number - first_)].time;
  }
  /// Returns the number of points before this one that are not reached yet.
  std::int64_t waiting_before(std::int64_t number) const noexcept;
  /// Returns true if the point with this number may be sent now, after all points before it.
  bool is_open(std::int64_t number) const noexcept;
  void forget_reached();
  Due due(std::int64_t cycle) const noexcept;

  double period_;
  bool starts_ = false;
  std::deque<motion_point_t> points_;  // points, beginning with the newest one that is reached
  std::int64_t first_ = 0;             // number of the first of these points
  std::int64_t next_ = 0;              // number of the first point that was never sent
  std::int64_t sent_cycle_ = 0;        // cycle of the newest message
  double passed_ = 0.0;                // time of the stream in the cycle of the newest report
  std::int64_t passed_cycle_ = 0;
};

}  // namespace takt
