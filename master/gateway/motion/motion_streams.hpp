#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <takt/motion_stream_t.hpp>
#include <utility>
#include <vector>

#include "master/gateway/motion/motion_job.hpp"
#include "master/motion/beat/stream_player.hpp"
#include "master/rt/exchange/motion_board.hpp"

namespace takt {

/// The streams that run or are about to begin. This class checks their points, and hands them to
/// the bus thread as fast as it takes them. All calls come from the front thread.
class MotionStreams {
 public:
  /// Points may be at most this far in the future, in s.
  static constexpr double longest_ahead = 5.0;
  /// Largest number of cycles from one point to the next, times the number of axes. It bounds the
  /// time that the check of a point takes.
  static constexpr double longest_step = 20'000;

  /// `period` is the period of the cycle in s.
  MotionStreams(double period, SubmitMotion submit) : period_{period}, submit_{std::move(submit)} {}

  /// Adds the stream of `job`, whose orders are on their way. The stream begins at its first point,
  /// which has the time `first_time`.
  void begin(const MotionJob& job, double first_time);
  /// Returns true if the stream with this id of this sender runs, or is about to begin.
  bool runs(std::int64_t instance, std::int32_t id) const noexcept {
    return find(instance, id) != nullptr;
  }
  /// Returns true if this stream has these axes, in this order.
  bool has_axes(std::int64_t instance, std::int32_t id,
                std::span<const std::size_t> axes) const noexcept;
  /// Takes the points of a message for a stream that runs, and skips points that the stream already
  /// has. If a point is refused, the points before it are taken, all later points are refused too,
  /// and the result gives the reason. `cycle` is the present cycle. `reported` is the cycle of the
  /// newest report: the bus thread holds at most the points that were left in that cycle.
  std::optional<MotionRefusal> add(const motion_stream_t& message, std::uint64_t cycle,
                                   std::uint64_t reported);
  /// Drops the streams that have ended and those that did not begin in their cycle.
  void observe(const MotionSnapshot& snapshot);
  /// Notes that an order has ended or was refused.
  void on_end(std::uint32_t order) {
    std::erase_if(streams_, [&](const Stream& stream) { return stream.order == order; });
  }
  /// Hands over the points that the bus thread could not take before.
  void serve();

 private:
  struct Stream {
    std::int32_t id = 0;
    std::int64_t instance = 0;
    std::uint32_t order = 0;
    std::uint64_t begin = 0;  ///< first cycle, see AxisReport::began
    double first_time = 0.0;  ///< time of the first point as the messages give it, in s
    std::vector<motion::AxisGoal> goals{};  ///< the axes and their limits
    /// Whole turns between the points and the motion, indexed by axis.
    std::vector<double> turns{};
    std::vector<motion::StreamPoint> last{};  ///< newest point, indexed by axis
    std::int64_t next = 1;                    ///< number of the next point
    std::deque<double> times{};               ///< times of the points that the bus thread may hold
    std::vector<motion::MotionMessage> filling{};  ///< message for the next points, indexed by axis
    std::deque<motion::MotionMessage> waiting{};   ///< messages that wait for the bus thread
  };

  const Stream* find(std::int64_t instance, std::int32_t id) const noexcept;
  /// Returns the time of the stream in a cycle, in s.
  double time_of(const Stream& stream, std::uint64_t cycle) const noexcept {
    return static_cast<double>(cycle - std::min(cycle, stream.begin)) * period_;
  }
  std::optional<MotionRefusal> defect_of(const Stream& stream,
                                         std::span<const motion::StreamPoint> next) const;
  std::optional<MotionRefusal> add_point(Stream& stream, const motion_point_t& point, double now);
  static void close(Stream& stream);
  void hand_over(Stream& stream);

  double period_;
  SubmitMotion submit_;
  std::vector<Stream> streams_;  ///< at most one for each axis
};

}  // namespace takt
