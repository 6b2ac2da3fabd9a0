#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "apps/takt/soak/judge/motion/gear_watch.hpp"
#include "apps/takt/soak/judge/motion/motion_orders.hpp"
#include "apps/takt/soak/judge/motion/stream_watch.hpp"

namespace takt::soak {

/// Compares the target positions of axes with the path of their stream, or with the axis that leads
/// them. It judges an axis only while nothing happens that may end the motion or delay it: each
/// cycle has its SYNC and its frames, the drives follow, the program is alive, and no other command
/// comes.
class PathJudge {
 public:
  PathJudge(const BusPlan& plan, const MotionOrders& orders, Verdict& verdict);

  /// Call this after MotionOrders has taken the message. `stands` is true if the axes of the
  /// message were at rest, and no older motion may begin.
  void commanded(const SentMotion& sent, bool stands, Time now);
  /// Call this when an event may delay or end motions until this time.
  void disturbed(Time until);
  void forget_all();
  void forget(std::size_t axis) { axes_[axis].watch.reset(); }
  /// Call this with each target position, in counts.
  void sent(std::size_t axis, double counts, bool by_set_point);
  /// Call this at the end of a cycle. `follows` has an element for each axis, and `regular` is true
  /// if the cycle has had one SYNC in time.
  void end_cycle(const std::vector<bool>& follows, bool regular, Time now);

  /// Returns the number of streams that were judged up to their ends.
  std::uint64_t streams() const noexcept { return streams_; }
  /// Returns the number of gears that were seen to be locked.
  std::uint64_t gears() const noexcept { return gears_; }

 private:
  struct Stream {
    std::int32_t id = 0;
    StreamWatch path;
  };
  struct Following {
    std::size_t leader = 0;
    std::uint64_t message = 0;
    double ratio = 1.0;  // counts of the axis in a count of the leader, without sign
    GearWatch gear;
    bool counted = false;
  };
  struct Watch {
    SenderBit sender = 0;
    Time heard{};  // SYNC time of the newest image that the sender has seen
    Time timeout{};
    MotionBounds bounds{};
    std::variant<Stream, Following> motion;
  };
  struct Axis {
    std::optional<Watch> watch{};
    std::optional<double> counts{};  // value that was sent in this cycle
    std::optional<double> last{};    // value in the previous cycle
    bool by_set_point = false;
  };
  void begin(const SentMotion& sent, std::size_t axis, bool stands, Time now);
  std::optional<Following> following(const SentMotion& sent, std::size_t axis, Time now) const;
  PathVerdict judge(std::size_t axis, const std::vector<bool>& follows, Time now);
  PathVerdict judge(std::size_t axis, Following& following, Time now);
  bool can_follow(const Watch& watch, const Following& following, Time now) const;
  bool is_far_from_ends(std::size_t axis, const MotionBounds& bounds) const;
  const OrderedMotion* order_of(std::size_t axis, const SentMotion& sent, Time now) const;
  std::optional<std::size_t> find(std::string_view node, int number) const;
  void report(std::size_t axis);

  const BusPlan& plan_;
  const MotionOrders& orders_;
  Verdict& verdict_;
  std::vector<Axis> axes_;
  Time calm_from_{};
  std::uint64_t streams_ = 0;
  std::uint64_t gears_ = 0;
};

}  // namespace takt::soak
