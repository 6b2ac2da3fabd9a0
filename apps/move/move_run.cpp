#include "apps/move/move_run.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <utility>

#include "apps/axis/not_ready.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/move/held_axes.hpp"
#include "apps/move/set_points/sine.hpp"

namespace takt {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int exit_good = 0;
constexpr int exit_not_followed = 1;
constexpr int exit_no_daemon = 3;

/// Duration of the motion if there is no --for and the move leaves time for a sine, seconds.
constexpr double usual_seconds = 10.0;
/// Duration from full speed to standstill when the motion is held, seconds.
constexpr double hold_ramp = 0.2;
/// Largest number of set-points under way, in cycles: one for the next SYNC, one in the queues of
/// this machine, and one new.
constexpr double longest_lead = 3;
/// Longest time in which the bus may take no set-point although images arrive, seconds.
constexpr double longest_refusal = 1.0;
/// Longest wait for an image before the motion is checked again.
constexpr std::chrono::milliseconds tick{2};
/// Number of status_t (10 in a second) in sequence in which another program may hold an axis.
/// Before the motion, that program may have died, while its last command is valid for up to a
/// second.
constexpr int held_before_motion = 20;
constexpr int held_in_motion = 6;
/// Longest wait until all axes are enabled, seconds. A drive needs time for its brake and its DC
/// link.
constexpr double enable_seconds = 5.0;
/// Longest wait for axes that do not confirm that they are disabled, seconds for all axes together.
constexpr double disable_seconds = 2.0;
/// Last wait for axes that are not disabled after that time or after a second signal, seconds.
constexpr double last_seconds = 0.2;
constexpr int second_stop = 2;
constexpr int any_stops = 3;
/// Time to live of a set-point if this program stalls. The network file may configure a shorter
/// one.
constexpr std::chrono::milliseconds set_point_life{1000};

}  // namespace

MoveRun::MoveRun(AxisGroup& group, const MoveOptions& options,
                 const volatile std::sig_atomic_t& stop)
    : group_{group}, axes_{group.axes()}, options_{options}, stop_{stop}, beat_{group} {}

int MoveRun::run() {
  if (!hear_bus()) return exit_no_daemon;
  if (!fits()) return exit_wrong_use;
  begin();
  good_ = devices_answer();
  if (good_ && !fits_time()) return exit_wrong_use;
  good_ = good_ && enable() && move();
  if (commanding_ && !restarted_) disable();
  return sum_up();
}

bool MoveRun::hear_bus() {
  progress_.say("waiting for " + (options_.bus.empty() ? "a bus" : "bus " + options_.bus) +
                " on LCM");
  const auto until = Clock::now() + std::chrono::duration<double>(options_.wait_seconds);
  while (stop_ == 0 && Clock::now() < until) {
    if (group_.wait(std::chrono::milliseconds{50}) == Input::fresh) return true;
  }
  progress_.say(group_.bus().empty()
                    ? "no message of a daemon came: is taktd running, with the same LCM URL?"
                    : "bus " + group_.bus() + " sends no image");
  return false;
}

/// Returns true if there are axes that can be moved, and if the number of targets fits them.
bool MoveRun::fits() {
  if (axes_.size() == 0) {
    progress_.say("no axis with profile cia402 on bus " + group_.bus() +
                  ": no node has 6040 and 6041 in its PDOs");
    return false;
  }
  for (const AxisControl::Index i : numbers_of(axes_)) {
    if (axes_.signals(i).position && axes_.signals(i).target_position) continue;
    progress_.say(axes_.name(i) + " can't be moved: its PDOs do not contain both 6064 and 607A");
    return false;
  }
  const auto targets = static_cast<AxisControl::Index>(options_.to.size());
  if (targets <= 1 || targets == axes_.size()) return true;
  progress_.say(fmt::format("--to has {} values for {} axes: give one each, or one for all",
                            targets, axes_.size()));
  return false;
}

void MoveRun::begin() {
  const auto& signals = group_.input().signals();
  for (const AxisControl::Index i : numbers_of(axes_)) {
    const std::string& unit = signals[*axes_.signals(i).position].unit;
    sizes_.push_back(sizes_for(options_, unit));
    units_.push_back(unit.empty() ? "counts" : unit);
  }
  progress_.set_units(units_);
  following_ = Following{axes_.size()};
  group_.set_time_to_live(
      std::max(2 * options_.stale_cycles, static_cast<int>(set_point_life / group_.period())));
  progress_.say(fmt::format("bus {}: {} signals, {} axes, SYNC every {:g} ms", group_.bus(),
                            signals.size(), axes_.size(),
                            std::chrono::duration<double, std::milli>(group_.period()).count()));
}

bool MoveRun::hold_until(const std::function<bool()>& done, double seconds, int stops) {
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  while (!restarted_ && stop_ < stops && Clock::now() < until) {
    const Input input = group_.wait(tick);
    restarted_ = input == Input::restarted;
    if (input != Input::fresh) continue;
    progress_.states(group_);
    if (done()) return true;
    if (commanding_) group_.send();
  }
  return false;
}

bool MoveRun::devices_answer() {
  const auto answers = [this](AxisControl::Index axis) {
    return !axes_.stale(axis) && axes_.drive(axis).state() != State402::not_ready_to_switch_on;
  };
  const auto all_answer = [&] { return std::ranges::all_of(numbers_of(axes_), answers); };
  if (hold_until(all_answer, options_.wait_seconds)) return true;
  if (stop_ != 0) return false;
  for (const AxisControl::Index i : numbers_of(axes_)) {
    if (!answers(i)) progress_.say(axes_.name(i) + ": the device does not answer (did it boot?)");
  }
  return false;
}

bool MoveRun::enable() {
  commanding_ = true;
  axes_.set_mode(DriveMode::cyclic_position);
  axes_.reset_faults();
  axes_.set_goal(DriveGoal::enabled);
  const auto ready = [&] { return axes_.all_enabled() && axes_.in_mode() && holds_all(group_); };
  const auto decided = [&] {
    rest_where_others_hold(group_);
    return ready() || !held_by_others(group_, held_before_motion).empty();
  };
  if (hold_until(decided, enable_seconds) && ready()) {
    if (options_.point) hold_until([this] { return knows_beat(); }, enable_seconds);
    return !restarted_;
  }
  if (stop_ != 0 || axes_taken(1)) return false;
  for (const AxisControl::Index i : numbers_of(axes_)) {
    for (const std::string& line : why_not_ready(group_, i)) progress_.say(line);
  }
  return false;
}

Eigen::VectorXd MoveRun::target(Eigen::VectorXd from) const {
  if (options_.to.empty()) {
    for (AxisControl::Index i = 0; i < from.size(); ++i) {
      from(i) += sizes_[static_cast<std::size_t>(i)].distance;
    }
    return from;
  }
  if (options_.to.size() == 1) return Eigen::VectorXd::Constant(from.size(), options_.to.front());
  return Eigen::VectorXd::Map(options_.to.data(), from.size());
}

std::optional<SynchronisedMove> MoveRun::planned_move(const Eigen::VectorXd& from) {
  auto move = SynchronisedMove::plan(from, target(from), limits());
  if (!move) {
    progress_.say(
        "no move was found: the distance, --velocity, --acceleration and --jerk are too far apart, "
        "or a position is not a number");
  }
  return move;
}

/// Returns true if there is a plan for the move, and if the motion ends within --for. Otherwise no
/// axis is enabled.
bool MoveRun::fits_time() {
  MotionTime time{.sine = options_.sine ? 1.0 / options_.frequency : 0.0};
  if (options_.point) {
    const auto move = planned_move(axes_.positions());
    if (!move) return false;
    time.move = move->duration();
  }
  if (!options_.seconds) return true;
  const std::string why = too_long(time, *options_.seconds);
  if (!why.empty()) progress_.say(why);
  return why.empty();
}

bool MoveRun::move() {
  double left = options_.seconds.value_or(usual_seconds);
  if (options_.point) {
    const auto move = planned_move(axes_.target_positions());
    if (!move) return false;
    progress_.say(fmt::format("moving all axes together, {:.2f} s{}", move->duration(),
                              beat_.offered() ? ", by taktd" : ""));
    const double begin = bus_seconds();
    const bool good = beat_.offered() ? watch_beat(target(axes_.target_positions()))
                                      : follow("move", move->duration(),
                                               [&](double t) { return move->position(t); });
    if (!good) return false;
    left -= std::max(move->duration(), bus_seconds() - begin);
  }
  if (!options_.sine || stop_ != 0) return true;
  return swing(left);
}

bool MoveRun::swing(double seconds) {
  Eigen::VectorXd amplitude{axes_.size()};
  std::ranges::transform(sizes_, amplitude.begin(), &MoveSizes::amplitude);
  Sine sine{axes_.target_positions(),
            {.amplitude = amplitude, .frequency = options_.frequency, .duration = seconds}};
  std::string reduced;
  for (const AxisControl::Index i : numbers_of(axes_)) {
    const auto axis = static_cast<std::size_t>(i);
    const double within = sine.amplitude_within(sizes_[axis].limits);
    if (amplitude(i) <= within) continue;
    sine.set_amplitude(i, within);
    reduced += fmt::format("{}{} {:.4g} {}", reduced.empty() ? "" : ", ", axes_.name(i), within,
                           units_[axis]);
  }
  if (!reduced.empty()) progress_.say("amplitude reduced to stay within the limits: " + reduced);
  progress_.say(fmt::format("sine of {:g} Hz, {:.2f} s", options_.frequency, sine.duration()));
  return follow("sine", sine.duration(), [&](double t) { return sine.position(t); });
}

bool MoveRun::follow(const char* what, double duration, const Trajectory& trajectory) {
  PacedMotion motion{axes_.target_positions_in_counts(), hold_ramp, longest_lead * period()};
  last_cycle_ = group_.input().cycle();
  auto last_tick = Clock::now();
  while (motion.time() < duration && !(stop_ != 0 && motion.standing())) {
    const Input input = group_.wait(tick);
    const Hold hold = take_input(input);
    if (restarted_ || axes_lost() || axes_taken(held_in_motion)) return false;
    const std::chrono::duration<double> passed = Clock::now() - last_tick;
    const bool fresh = input == Input::fresh;
    if (!fresh && holding_ == Hold::no) continue;  // wait for the next image
    last_tick = Clock::now();
    if (fresh) motion.seen(axes_.sent_positions());
    const double step = fresh ? real_step() : std::min(passed.count(), longest_step());
    axes_.set_positions(trajectory(motion.step(step, hold)));
    motion.sent(axes_.target_positions_in_counts());
    group_.send();
    if (motion.refused() > longest_refusal) return not_taken();
    if (fresh) compare(what);
  }
  return sent_own(motion);
}

/// Returns true if the target positions that the newest image shows are those of this motion.
bool MoveRun::sent_own(const PacedMotion& motion) {
  bool own = true;
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    const auto axis = static_cast<AxisControl::Index>(i);
    if (motion.apart()(axis) <= sizes_[i].following_limit) continue;
    own = false;
    progress_.say(
        fmt::format("the image shows {:.4f} {} as the target position of {}, which this "
                    "program did not send",
                    axes_.sent_positions()(axis), units_[i], axes_.name(axis)));
  }
  return own;
}

void MoveRun::compare(const char* what) {
  following_.seen(group_.input().cycle(), axes_.positions());
  following_.sent(group_.input().cycle(), axes_.sent_positions());
  progress_.states(group_);
  progress_.positions(axes_, following_, what);
}

/// Returns the period of SYNC in seconds.
double MoveRun::period() const { return std::chrono::duration<double>(group_.period()).count(); }

/// Returns the longest step of the motion in seconds. It prevents a jump of the motion after a gap
/// in the images or a stall of this program.
double MoveRun::longest_step() const { return period() * options_.stale_cycles; }

/// Returns the bus time since the last image in seconds, at most longest_step().
double MoveRun::real_step() {
  const std::int64_t cycle = group_.input().cycle();
  const auto cycles = static_cast<double>(cycle - std::exchange(last_cycle_, cycle));
  return std::clamp(period() * cycles, 0.0, longest_step());
}

Hold MoveRun::take_input(Input input) {
  if (input == Input::restarted) {
    restarted_ = true;
    progress_.say("the daemon has restarted: its axes are disabled");
  }
  if (input == Input::fresh) stale_images_ = axes_.any_stale() ? stale_images_ + 1 : 0;
  const bool stale = input == Input::stale || stale_images_ > options_.stale_cycles ||
                     (holding_ == Hold::yes && input == Input::nothing);
  if (stale && holding_ == Hold::no) {
    ++holds_;
    progress_.say(
        fmt::format("the input is older than {} cycles: the motion holds", options_.stale_cycles));
  } else if (!stale && holding_ == Hold::yes) {
    progress_.say("the input is fresh again: the motion continues");
  }
  holding_ = stale ? Hold::yes : Hold::no;
  return stale || stop_ != 0 ? Hold::yes : Hold::no;
}

bool MoveRun::not_taken() {
  progress_.say(
      fmt::format("the images show for {:g} s that no set-point is sent: stopping (takt "
                  "status shows which program holds the axes)",
                  longest_refusal));
  return false;
}

bool MoveRun::axes_lost() {
  if (axes_.all_enabled()) return false;
  progress_.states(group_);
  progress_.say("an axis has left Operation enabled: stopping");
  return true;
}

/// Returns true if the newest `sequence` status_t show that another program holds an axis.
bool MoveRun::axes_taken(int sequence) {
  const std::string why = held_by_others(group_, sequence);
  if (!why.empty()) progress_.say(why);
  return !why.empty();
}

/// Returns true if there is nothing left to disable: the axis is disabled, or another program holds
/// it.
bool MoveRun::is_over(AxisControl::Index axis) const {
  return axes_.drive(axis).reached() || group_.holder(axis).is_other(held_in_motion);
}

void MoveRun::disable() {
  if (others_hold_all(group_, held_in_motion)) return;
  progress_.say("disabling the axes, one after the other");
  double left = disable_seconds;
  for (AxisControl::Index i = axes_.size() - 1; i >= 0 && left > 0.0; --i) {
    axes_.set_goal(i, DriveGoal::disabled);
    const auto begin = Clock::now();
    if (hold_until([&] { return is_over(i); }, left, second_stop)) continue;
    if (restarted_ || stop_ >= second_stop) break;
    left -= std::chrono::duration<double>(Clock::now() - begin).count();
  }
  axes_.set_goal(DriveGoal::disabled);
  const auto all_over = [this] {
    return std::ranges::all_of(numbers_of(axes_), [this](auto i) { return is_over(i); });
  };
  if (all_over() || hold_until(all_over, last_seconds, any_stops)) return;
  good_ = false;
  if (stop_ >= second_stop)
    progress_.say("stopped by a second signal, without waiting for the axes");
  for (AxisControl::Index i = axes_.size() - 1; i >= 0; --i) {
    if (is_over(i)) continue;
    progress_.say(axes_.name(i) + " does not confirm that it is disabled");
  }
}

/// Returns the names and limits of the axes that exceeded the allowed following error. The text is
/// empty if all axes followed.
std::string MoveRun::too_far() const {
  std::string text;
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    const auto axis = static_cast<AxisControl::Index>(i);
    if (following_.largest()(axis) <= sizes_[i].following_limit) continue;
    text += fmt::format("{}{} (limit {:g} {})", text.empty() ? "" : ", ", axes_.name(axis),
                        sizes_[i].following_limit, units_[i]);
  }
  return text;
}

std::string MoveRun::verdict() const {
  if (following_.samples() == 0) return "The axes never moved.";
  if (!too_far().empty()) return "The axes did NOT follow: " + too_far() + ".";
  return good_ ? "The axes followed."
               : "The motion did not reach its end; up to that point the axes followed.";
}

int MoveRun::sum_up() const {
  std::string text =
      fmt::format("\n{:<14}{:>16}{:>24}   unit\n", "axis", "position", "largest following error");
  for (const AxisControl::Index i : numbers_of(axes_)) {
    text += fmt::format("{:<14}{:>16.4f}{:>24.4f}   {}\n", axes_.name(i), axes_.positions()(i),
                        following_.largest()(i), units_[static_cast<std::size_t>(i)]);
  }
  text += fmt::format("{} images compared, held {} times. {}\n", following_.samples(), holds_,
                      verdict());
  Progress::print(text);
  const bool followed = following_.samples() > 0 && too_far().empty();
  return good_ && followed ? exit_good : exit_not_followed;
}

}  // namespace takt
