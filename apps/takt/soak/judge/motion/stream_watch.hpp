#pragma once
#include <optional>
#include <takt/motion_stream_t.hpp>
#include <vector>

#include "apps/takt/soak/judge/motion/path_verdict.hpp"
#include "eds_parser/values/time.hpp"

namespace takt::soak {

/// Compares the target positions of an axis with the path of a stream: in each cycle, the position
/// has to be that of the polynomial through the points. The cycle of the begin is not known. Each
/// cycle within `longest_begin` is possible until the positions show which one it is.
class StreamWatch {
 public:
  /// The conversion to counts of the axis, and the cycles.
  struct Frame {
    double scale = 1.0;
    double offset = 0.0;         ///< offset in the unit of the axis
    double period = 0.0;         ///< s
    unsigned longest_begin = 0;  ///< cycles in which the stream may begin
  };
  explicit StreamWatch(const Frame& frame) : frame_{frame} {}

  /// Takes the points of a message that was sent now. Points that are known are skipped.
  void take(const motion_stream_t& message, Time now);
  /// Judges the target position of the next cycle, in counts.
  PathVerdict judge(double counts, Time now);

 private:
  struct Point {
    double time = 0.0;
    double position = 0.0;
    double velocity = 0.0;
    std::optional<double> acceleration{};
    Time sent{};
  };

  double path(double time) const;
  double certain_end(Time now) const;
  double counts(double position) const { return (position - frame_.offset) / frame_.scale; }
  bool ends() const;

  Frame frame_;
  std::vector<Point> points_;
  unsigned cycle_ = 0;            // cycle that is judged next
  std::vector<unsigned> begins_;  // cycles in which the stream may have begun
  bool at_start_ = true;          // the axis has been at the first point so far
};

}  // namespace takt::soak
