#include "apps/takt/soak/judge/motion/motion_judge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "apps/takt/soak/evidence/frame_values.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr unsigned failed_cycles = 3;   // after these, the master knows that a drive is disabled
constexpr unsigned silent_cycles = 8;   // after these, the master knows that a drive is silent
constexpr unsigned hold_tolerance = 5;  // a lease may end this much early
// Number of cycles in which a late frame may be followed by an early one.
constexpr unsigned cycles_after_late = 3;
constexpr unsigned most_cycles_of_frame = 2;  // one frame may be missing
constexpr Time short_rest = 150ms;  // time without a change after which an axis is judged to rest
constexpr Time long_rest = 100ms;   // time without a change after which no motion runs

}  // namespace

MotionJudge::MotionJudge(const BusPlan& plan, Verdict& verdict, HolderJudge& holders)
    : plan_{plan},
      verdict_{verdict},
      holders_{holders},
      orders_{plan},
      groups_{plan, verdict},
      paths_{plan, orders_, verdict},
      axes_(orders_.axes().size()),
      most_cycles_{most_cycles_of_way(plan.cycle.period)} {}

void MotionJudge::commanded(const SentMotion& sent, Time now) {
  if (sent.command.kind == "alive") {
    orders_.commanded(sent, now);
    return paths_.commanded(sent, false, now);
  }
  std::vector<std::size_t> named;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const std::string& node = plan_.nodes[orders_.axes()[i].node_index].name;
    if (std::ranges::find(sent.command.goals, node, &motion_goal_t::node) ==
        sent.command.goals.end()) {
      continue;
    }
    named.push_back(i);
    groups_.forget(i);
  }
  const bool stand = std::ranges::all_of(named, [&](std::size_t i) {
    return axes_[i].value && axes_[i].enabled && axes_[i].doubt == 0 &&
           now - axes_[i].when >= long_rest && now - orders_.newest(i) >= MotionOrders::longest_way;
  });
  const bool rest = stand && std::ranges::none_of(named, [&](std::size_t i) {
                      return std::ranges::any_of(orders_.orders(i), [](const OrderedMotion& order) {
                        return order.follows || order.creeps;
                      });
                    });
  orders_.commanded(sent, now);
  paths_.commanded(sent, rest, now);
  if (stand && sent.command.kind == "move" && sent.command.synchronisation == "none") {
    watch(sent, now);
  }
}

void MotionJudge::watch(const SentMotion& sent, Time now) {
  std::vector<GroupJudge::Member> members;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const auto orders = orders_.orders(i);
    if (orders.empty() || orders.back().sent != now || orders.back().sender != sent.sender) {
      continue;
    }
    members.push_back({.axis = i,
                       .from = *axes_[i].value,
                       .target = static_cast<double>(*orders.back().target),
                       .bounds = orders.back().bounds});
  }
  if (members.size() > 1) groups_.watch(members);
}

void MotionJudge::begin_anew() {
  orders_.begin_anew();
  groups_.forget_all();
  paths_.forget_all();
  for (Axis& axis : axes_) {
    axis.value.reset();
    axis.last_way.reset();
    axis.doubt = state_doubt;
    axis.judged_rest = true;
  }
}

/// Evaluates a cycle. A SYNC that is missing or late delays the motions, or ends them.
void MotionJudge::end_cycle(Time now) {
  std::vector<bool> follows;
  for (const Axis& axis : axes_) {
    follows.push_back(axis.enabled && axis.doubt == 0 && axis.silent_cycles <= 1);
  }
  const std::uint64_t syncs = syncs_ - std::exchange(syncs_at_cycle_, syncs_);
  const bool regular = late_cycles_ == 0 && (!plan_.cycle.sync || syncs == 1);
  paths_.end_cycle(follows, regular, now);
}

void MotionJudge::begin_cycle(Time now) {
  if (now - last_cycle_ > plan_.cycle.period * 3 / 2) {
    groups_.forget_all();
    late_cycles_ = cycles_after_late + 1;
  }
  end_cycle(now);
  ++cycles_without_sync_;
  if (late_cycles_ != 0) --late_cycles_;
  last_cycle_ = now;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    if (axis.doubt != 0) --axis.doubt;
    axis.disabled_cycles = axis.enabled ? 0 : axis.disabled_cycles + 1;
    judge_failure(i, now);
    if (!axis.value) continue;
    if (!axis.judged_rest && now - axis.when >= short_rest) judge_rest(i);
    if (now - axis.when >= long_rest) orders_.stood(i, axis.when, now);
  }
}

/// Notes that a drive is disabled or silent, but only after some cycles, because the master may not
/// know of a failure in the first cycles after it.
void MotionJudge::judge_failure(std::size_t axis, Time now) {
  const PdoRow& row = plan_.pdos.tpdos[plan_.layout.signals[orders_.axes()[axis].statusword].row];
  const bool every_cycle = row.cyclic() && row.transmission == 1;
  const bool silent = every_cycle && axes_[axis].silent_cycles == silent_cycles;
  if (axes_[axis].disabled_cycles != failed_cycles && !silent) return;
  orders_.failed(axis, now);
  groups_.forget(axis);
}

/// Checks that an axis that rests at the target of a program was moved by this program.
void MotionJudge::judge_rest(std::size_t axis) {
  Axis& own = axes_[axis];
  own.judged_rest = true;
  const OrderedMotion* cause = nullptr;
  for (const OrderedMotion& order : orders_.orders(axis)) {
    const bool reached = order.target && static_cast<double>(*order.target) == *own.value;
    if (!reached || order.sent > own.when) continue;
    if (cause != nullptr && cause->sender != order.sender) return;
    cause = &order;
  }
  if (cause == nullptr) return;
  ++arrivals_;
  holders_.moved(
      orders_.axes()[axis].node_index,
      {.sender = cause->sender,
       .computed_from = cause->computed_from,
       .held_until = cause->computed_from + cause->timeout - hold_tolerance * plan_.cycle.period},
      own.when);
  if (!cause->creeps) orders_.arrived(axis, *cause);  // a slow motion may still run
}

/// Takes a SYNC. If SYNC was missing in more than one period before, the motions have ended at
/// once.
void MotionJudge::sync_heard() noexcept {
  ++syncs_;
  if (cycles_without_sync_ > 2) late_cycles_ = cycles_after_late + 1;
  cycles_without_sync_ = 0;
  if (!plan_.cycle.sync_followed) return;
  for (Axis& axis : axes_) ++axis.silent_cycles;
}

void MotionJudge::heard(const Frame& frame) {
  if (plan_.cycle.sync && frame.id == plan_.cycle.sync_cob_id) sync_heard();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    if (const auto word = input_in(plan_, frame, orders_.axes()[i].statusword)) {
      axis.enabled = is_enabled(*word);
      axis.silent_cycles = 0;
      if (!axis.enabled) axis.doubt = state_doubt;
    }
    // A frame of a babbling node may also contain another mode.
    const auto mode = orders_.axes()[i].mode;
    const auto told = mode ? input_in(plan_, frame, *mode) : std::nullopt;
    if (told && *told != cyclic_synchronous_position) axis.doubt = state_doubt;
  }
}

void MotionJudge::sync_sent() {
  for (Axis& axis : axes_) ++axis.silent_cycles;
}

void MotionJudge::sent(SignalIndex target, std::int64_t value, const Cause& cause, Time now) {
  const auto found = orders_.axis_of(target);
  if (!found) return;
  Axis& axis = axes_[*found];
  const auto counts = static_cast<double>(value);
  paths_.sent(*found, counts, cause.by_set_point);
  const auto syncs = static_cast<unsigned>(std::min<std::uint64_t>(syncs_ - axis.syncs, 1000));
  axis.syncs = syncs_;
  // Without a SYNC since the last frame, a repeated value has had no effect.
  if (plan_.cycle.sync && syncs == 0 && axis.value == counts) return;
  if (cause.begins) axis.doubt = state_doubt;
  groups_.sent(*found, counts, now);
  const bool follows = axis.enabled && axis.doubt == 0;
  std::optional<Way> way;
  if (axis.value) {
    way = Way{.length = counts - *axis.value,
              .cycles = cycles_between(axis.sent_at, now, plan_.cycle.period, most_cycles_) +
                        (late_cycles_ != 0 ? 1U : 0U)};
  }
  axis.sent_at = now;
  const bool moves = axis.value != counts;
  // If two frames in a row were not sent, the motion has ended at once.
  const bool was_sent = axis.last_way && axis.last_way->cycles <= most_cycles_of_frame;
  const bool ends = !moves && was_sent && late_cycles_ == 0 && !stops_;
  const bool judged = follows && (moves || ends) && !cause.by_set_point;
  if (way && judged) judge_way(*found, *way, syncs, now);
  axis.last_way = follows ? way : std::nullopt;
  if (!moves) return;
  axis.value = counts;
  axis.when = now;
  axis.judged_rest = !follows;
  if (const SenderBit mover = orders_.mover(*found, now); mover != 0 && !cause.by_set_point) {
    holders_.note_move(mover, now);
  }
}

/// Checks the distance of a set-point. Between two SYNCs, an axis moves at most as far as its
/// velocity limit allows in one period, however late the second SYNC is. One count is added,
/// because the values are rounded to counts.
void MotionJudge::judge_way(std::size_t axis, const Way& way, unsigned syncs, Time now) {
  const auto bounds = orders_.bounds(axis, now);
  if (!bounds) return;
  const double period = std::chrono::duration<double>(plan_.cycle.period).count();
  const unsigned cycles = plan_.cycle.sync ? std::max(syncs, 1U) : way.cycles;
  const double most = bounds->velocity * period * cycles * (1 + 1e-6) + 1;
  if (std::abs(way.length) > most) {
    return report_violation(axis, "a motion keeps its limits",
                            fmt::format("target position moves by {:.0f} counts in {} cycles; the "
                                        "velocity of the motion allows {:.1f} counts",
                                        way.length, cycles, most));
  }
  const auto& last = axes_[axis].last_way;
  const double bend = bounds->acceleration * period * period;
  if (!last || !is_too_sharp(bend, way, *last)) return;
  report_violation(
      axis, "a motion keeps its limits",
      fmt::format(
          "target position moves by {:.0f} counts in {} cycles, after {:.0f} "
          "counts in {} cycles; the acceleration is at most {:.3f} counts per cycle squared",
          way.length, way.cycles, last->length, last->cycles, bend));
}

bool MotionJudge::explains(SignalIndex output, Time now) const noexcept {
  const auto axis = orders_.axis_of(output);
  return axis && orders_.may_move(*axis, now);
}

bool MotionJudge::was_led(SignalIndex target) const noexcept {
  const auto axis = orders_.axis_of(target);
  return axis && orders_.was_commanded(*axis);
}

void MotionJudge::report_violation(std::size_t axis, const char* invariant,
                                   const std::string& what) {
  verdict_.report_violation(invariant,
                            plan_.nodes[orders_.axes()[axis].node_index].name + ": " + what);
}

}  // namespace takt::soak
