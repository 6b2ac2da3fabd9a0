#include "apps/takt/soak/judge/homing_judge.hpp"

#include <chrono>
#include <cmath>
#include <fmt/format.h>

#include "apps/takt/soak/evidence/frame_values.hpp"
#include "apps/takt/soak/evidence/way.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr Time report_time = 60ms;  // time from a frame until programs have received a report of it
constexpr Time longest_silence = 1500ms;
constexpr unsigned known_cycles = 3;      // age of the position that the master knows
constexpr double most_cycles = 1000;      // largest number of cycles that count for one distance
constexpr std::uint64_t homing_mode = 6;  // 6061
constexpr std::int8_t is_homed = 2;       // axis_motion_t::homing
constexpr std::uint32_t boot_up = 0x700;

/// Bits 12 (homing attained) and 10 (target reached) without bit 13 (homing error).
bool has_homed(std::uint64_t statusword) noexcept { return (statusword & 0x3400) == 0x1400; }

}  // namespace

HomingJudge::HomingJudge(const BusPlan& plan, Verdict& verdict, double velocity)
    : plan_{plan},
      verdict_{verdict},
      velocity_{velocity},
      signals_{motion_axes(plan)},
      axes_(signals_.size()) {}

void HomingJudge::begin_anew(Time now) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    lose(i, now);
    axes_[i].target.reset();
  }
}

void HomingJudge::lose(std::size_t axis, Time now) {
  Axis& own = axes_[axis];
  if (own.homed_since) own.unhomed_since = now;
  own.homed_since.reset();
}

void HomingJudge::heard(const Frame& frame, Time now) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const NodePlan& node = plan_.nodes[signals_[i].node_index];
    if (frame.id == CobId::base(boot_up + node.id.value()) && bits_of(frame, 0, 8) == 0) {
      lose(i, now);
      axes_[i] = {.unhomed_since = axes_[i].unhomed_since};
    }
    take_inputs(i, frame, now);
    if (const auto target = output_in(plan_, frame, signals_[i].target)) {
      take_target(i, static_cast<std::int32_t>(*target), now);
    }
  }
}

/// Notes the state of a drive. When a drive begins to follow set-points, the newest one that it has
/// received must be near its actual position.
void HomingJudge::take_inputs(std::size_t axis, const Frame& frame, Time now) {
  const MotionAxis& signals = signals_[axis];
  Axis& own = axes_[axis];
  const auto statusword = input_in(plan_, frame, signals.statusword);
  const auto position = input_in(plan_, frame, signals.position);
  const auto mode = signals.mode ? input_in(plan_, frame, *signals.mode) : std::nullopt;
  if (!statusword && !position && !mode) return;
  if (now - own.heard > longest_silence) lose(axis, now);
  own.heard = now;
  if (statusword) own.statusword = *statusword;
  if (position) own.position = static_cast<std::int32_t>(*position);
  const bool leaves_homing = mode && own.mode == homing_mode;
  if (mode) own.mode = *mode;
  const bool is_on = is_enabled(own.statusword);
  if (own.mode == homing_mode && is_on && has_homed(own.statusword) && !own.homed_since) {
    own.homed_since = now;
    ++runs_;
  }
  const bool obeyed = own.obeys;
  own.obeys = is_on && own.mode == cyclic_synchronous_position;
  if (obeyed || !own.obeys || !own.target) return;
  if (leaves_homing) ++changes_;
  judge_jump(axis, own.position, *own.target, known_cycles);
}

void HomingJudge::take_target(std::size_t axis, double counts, Time now) {
  Axis& own = axes_[axis];
  if (own.obeys && own.target) {
    judge_jump(axis, *own.target, counts,
               cycles_between(own.sent_at, now, plan_.cycle.period, most_cycles));
  }
  own.target = counts;
  own.sent_at = now;
}

double HomingJudge::step_of(std::size_t axis) const noexcept {
  const double size = std::abs(plan_.layout.signals[signals_[axis].target].scale);
  return velocity_ / size * std::chrono::duration<double>(plan_.cycle.period).count();
}

void HomingJudge::judge_jump(std::size_t axis, double from, double to, unsigned cycles) {
  const double most = step_of(axis) * (cycles + 1) + 2;
  if (std::abs(to - from) <= most) return;
  report_violation(axis, "no set-point jumps",
                   fmt::format("its target position goes from {:.0f} to {:.0f} counts in {} cycles",
                               from, to, cycles));
}

void HomingJudge::reported(const motion_t& motions, Time now) {
  for (const axis_motion_t& motion : motions.axes) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const NodePlan& node = plan_.nodes[signals_[i].node_index];
      const bool named = node.id.value() == motion.node_id && signals_[i].number + 1 == motion.axis;
      if (!named || motion.homing != is_homed || axes_[i].homed_since) continue;
      if (now - axes_[i].unhomed_since < report_time) continue;
      report_violation(i, "an axis is homed only after a good run",
                       "it is reported as homed, but its drive has shown no successful homing run "
                       "since its node booted or taktd started");
    }
  }
}

void HomingJudge::arrived(std::size_t axis, Time begin) {
  const Axis& own = axes_[axis];
  const bool was_homed = own.homed_since || own.unhomed_since + report_time > begin;
  if (was_homed || !signals_[axis].needs_homing) return;
  report_violation(axis, "no absolute motion without homing",
                   "it has moved to a position, but it is not homed");
}

void HomingJudge::report_violation(std::size_t axis, const char* invariant,
                                   const std::string& what) {
  verdict_.report_violation(invariant, plan_.nodes[signals_[axis].node_index].name + ": " + what);
}

}  // namespace takt::soak
