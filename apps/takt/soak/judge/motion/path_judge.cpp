#include "apps/takt/soak/judge/motion/path_judge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

// Longest time from the cycle of a message until the daemon knows it.
constexpr Time longest_message = 40ms;
// A leader within this part of the limits of the axis is judged. Up to 0.8, an axis does not fall
// behind.
constexpr double part_for_leader = 0.7;
constexpr double part_for_phase = 0.1;  // part of the velocity for catching up
constexpr int phase_ins = 6;            // number of stopping times until the velocities are equal
constexpr double end_margin = 1000.0;   // distance from the end of the range in counts

}  // namespace

PathJudge::PathJudge(const BusPlan& plan, const MotionOrders& orders, Verdict& verdict)
    : plan_{plan}, orders_{orders}, verdict_{verdict}, axes_(orders.axes().size()) {}

void PathJudge::forget_all() {
  for (Axis& axis : axes_) axis = {};
}

void PathJudge::disturbed(Time until) {
  forget_all();
  calm_from_ = std::max(calm_from_, until);
}

/// A message that is refused is no sign of life. Therefore only messages that are never refused
/// count.
void PathJudge::commanded(const SentMotion& sent, bool stands, Time now) {
  const auto hear = [&](std::optional<Watch>& watch) {
    if (!watch || watch->sender != sent.sender) return;
    watch->heard = std::max(watch->heard, sent.computed_from);
  };
  if (sent.command.kind == "alive") {
    for (Axis& axis : axes_) hear(axis.watch);
    return;
  }
  for (const motion_goal_t& goal : sent.command.goals) {
    const auto axis = find(goal.node, goal.axis);
    if (!axis) continue;
    std::optional<Watch>& watch = axes_[*axis].watch;
    if (sent.command.kind == "points" && watch && watch->sender == sent.sender) {
      auto* const stream = std::get_if<Stream>(&watch->motion);
      if (stream != nullptr && stream->id == sent.command.id && sent.stream != nullptr) {
        stream->path.take(*sent.stream, now);
        hear(watch);
        continue;
      }
    }
    watch.reset();
    if (sent.command.goals.size() == 1 && now >= calm_from_) begin(sent, *axis, stands, now);
  }
}

void PathJudge::begin(const SentMotion& sent, std::size_t axis, bool stands, Time now) {
  const OrderedMotion* const order = order_of(axis, sent, now);
  if (order == nullptr || orders_.axes()[axis].turn.length > 0.0) return;
  Watch watch{.sender = sent.sender,
              .heard = sent.computed_from,
              .timeout = order->timeout,
              .bounds = order->bounds,
              .motion = Following{.gear = GearWatch{{}, now}}};
  if (sent.gear != nullptr) {
    auto gear = following(sent, axis, now);
    if (!gear) return;
    watch.motion = *gear;
  } else if (sent.stream != nullptr && sent.command.kind == "stream" && stands) {
    const Signal& target = plan_.layout.signals[orders_.axes()[axis].target];
    const Time period = plan_.cycle.period;
    Stream stream{.id = sent.command.id,
                  .path = StreamWatch{{.scale = target.scale,
                                       .offset = target.offset,
                                       .period = std::chrono::duration<double>(period).count(),
                                       .longest_begin = static_cast<unsigned>(
                                           MotionOrders::longest_way / period)}}};
    stream.path.take(*sent.stream, now);
    watch.motion = std::move(stream);
  } else {
    return;
  }
  axes_[axis].watch = std::move(watch);
}

/// For a measured leader, the master uses an estimate of the position, which the judge does not
/// know.
std::optional<PathJudge::Following> PathJudge::following(const SentMotion& sent, std::size_t axis,
                                                         Time now) const {
  const motion_gear_t& gear = *sent.gear;
  const auto leader = find(gear.leader, gear.leader_axis);
  if (!leader || !gear.signal.empty() || gear.numerator.size() != 1) return std::nullopt;
  if (orders_.axes()[*leader].turn.length > 0.0) return std::nullopt;
  const Signal& own = plan_.layout.signals[orders_.axes()[axis].target];
  const Signal& other = plan_.layout.signals[orders_.axes()[*leader].target];
  const double divisor = gear.denominator.front() == 0.0 ? 1.0 : gear.denominator.front();
  const double ratio = gear.numerator.front() / divisor;
  const OrderedMotion& order = *order_of(axis, sent, now);
  GearWatch::Task task{.ratio = ratio * other.scale / own.scale,
                       .phase_in = phase_ins * MotionOrders::stop_time(order.bounds, order.fastest),
                       .catch_up = part_for_phase * order.bounds.velocity};
  if (gear.phase == "at") {
    task.phase = (ratio * other.offset + gear.goals.front().position - own.offset) / own.scale;
  }
  return Following{.leader = *leader,
                   .message = order.message,
                   .ratio = std::abs(task.ratio),
                   .gear = GearWatch{task, now + MotionOrders::longest_way}};
}

void PathJudge::sent(std::size_t axis, double counts, bool by_set_point) {
  axes_[axis].counts = counts;
  axes_[axis].by_set_point = by_set_point;
}

void PathJudge::end_cycle(const std::vector<bool>& follows, bool regular, Time now) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (!axes_[i].watch) continue;
    const PathVerdict verdict = regular ? judge(i, follows, now) : PathVerdict::unknown;
    if (verdict == PathVerdict::on) continue;
    if (verdict == PathVerdict::off && !axes_[i].by_set_point) report(i);
    streams_ += verdict == PathVerdict::done;
    axes_[i].watch.reset();
  }
  for (Axis& axis : axes_) {
    axis.last = std::exchange(axis.counts, std::nullopt);
    axis.by_set_point = false;
  }
}

PathVerdict PathJudge::judge(std::size_t axis, const std::vector<bool>& follows, Time now) {
  Watch& watch = *axes_[axis].watch;
  const bool is_heard = now + longest_message < watch.heard + watch.timeout;
  if (!follows[axis] || !axes_[axis].counts || !is_heard) return PathVerdict::unknown;
  if (auto* const stream = std::get_if<Stream>(&watch.motion)) {
    return stream->path.judge(*axes_[axis].counts, now);
  }
  auto& following = std::get<Following>(watch.motion);
  if (!follows[following.leader]) return PathVerdict::unknown;
  return judge(axis, following, now);
}

PathVerdict PathJudge::judge(std::size_t axis, Following& following, Time now) {
  const Axis& own = axes_[axis];
  const Axis& leader = axes_[following.leader];
  if (!leader.counts || !is_far_from_ends(axis, own.watch->bounds)) return PathVerdict::unknown;
  const bool alone = !own.by_set_point &&
                     std::ranges::all_of(orders_.orders(axis), [&](const OrderedMotion& order) {
                       return order.message == following.message;
                     });
  const PathVerdict verdict =
      following.gear.judge({.leader = *leader.counts,
                            .own = *own.counts,
                            .within = can_follow(*own.watch, following, now),
                            .alone = alone},
                           now);
  if (!following.counted && following.gear.is_locked()) {
    following.counted = true;
    ++gears_;
  }
  return verdict;
}

bool PathJudge::can_follow(const Watch& watch, const Following& following, Time now) const {
  const Axis& leader = axes_[following.leader];
  if (leader.last == leader.counts) return true;
  const auto most = orders_.bounds(following.leader, now);
  if (!most || leader.by_set_point) return false;
  const auto is_within = [&](double of_leader, double own) {
    return following.ratio * of_leader <= part_for_leader * own;
  };
  return is_within(most->velocity, watch.bounds.velocity) &&
         is_within(most->acceleration, watch.bounds.acceleration) &&
         is_within(most->jerk, watch.bounds.jerk);
}

/// Returns false near an end of the range, where an axis stops.
bool PathJudge::is_far_from_ends(std::size_t axis, const MotionBounds& bounds) const {
  const MotionAxis& own = orders_.axes()[axis];
  const Signal& target = plan_.layout.signals[own.target];
  const double rise = bounds.acceleration / bounds.jerk;
  const double margin =
      end_margin + bounds.velocity * (bounds.velocity / bounds.acceleration + 2 * rise);
  return std::ranges::all_of(plan_.limits.lines, [&](const LimitLine& line) {
    const bool mine = line.kind == LimitKind::position && line.node_index == own.node_index &&
                      line.axis == own.number + 1;
    const auto is_far = [&](const std::optional<double>& end) {
      return !end || std::abs((*end - target.offset) / target.scale - *axes_[axis].counts) > margin;
    };
    return !mine || (is_far(line.low) && is_far(line.high));
  });
}

/// Returns the motion that this message has just ordered.
const OrderedMotion* PathJudge::order_of(std::size_t axis, const SentMotion& sent, Time now) const {
  const auto orders = orders_.orders(axis);
  if (orders.empty() || orders.back().sent != now || orders.back().sender != sent.sender) {
    return nullptr;
  }
  return &orders.back();
}

std::optional<std::size_t> PathJudge::find(std::string_view node, int number) const {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const MotionAxis& axis = orders_.axes()[i];
    if (plan_.nodes[axis.node_index].name == node && axis.number + 1 == std::max(number, 1)) {
      return i;
    }
  }
  return std::nullopt;
}

void PathJudge::report(std::size_t axis) {
  const std::string& node = plan_.nodes[orders_.axes()[axis].node_index].name;
  const std::string where = "target position " +
                            std::to_string(static_cast<long long>(*axes_[axis].counts)) + " of " +
                            node;
  if (std::holds_alternative<Stream>(axes_[axis].watch->motion)) {
    return verdict_.report_violation("a stream keeps to its path",
                                     where + " is not on the polynomial through its points");
  }
  verdict_.report_violation("a gear keeps its ratio",
                            where + " is not that of its leader times the ratio, plus the phase");
}

}  // namespace takt::soak
