#include "apps/axis/axes_state.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace takt {
namespace {

using std::chrono::nanoseconds;

/// Longest wait for a message between two checks of the time.
constexpr std::chrono::milliseconds axes_tick{5};
/// Longest time between signs of life. A shorter timeout of the motions shortens this time.
constexpr std::chrono::milliseconds longest_silence{50};
constexpr int signs_in_timeout = 4;
/// Longest wait for the speed axes of a layout, which are published once a second.
constexpr std::chrono::milliseconds layout_time{1500};
/// The bus is silent if no image comes for longer than each of three times: `image_time`,
/// `image_periods` periods, and the timeout.
constexpr std::chrono::seconds image_time{2};
constexpr int image_periods = 20;
constexpr std::size_t most_kept_events = 64;
/// Range of motion_command_t::timeout_ms.
constexpr std::chrono::milliseconds shortest_timeout{1};
constexpr std::chrono::seconds longest_timeout{10};

}  // namespace

Axes::State::State(std::unique_ptr<Transport> lcm, AxesOptions given)
    : group{std::move(lcm), {.bus = given.bus, .sender = given.sender}},
      options{std::move(given)},
      request_id_{surroundings().random_number()},
      id_{static_cast<std::int32_t>(surroundings().random_number() & 0x3FFF'FFFF)} {}

bool Axes::State::all(const AxisCondition& is) const { return std::ranges::all_of(axes, is); }
bool Axes::State::any(const AxisCondition& is) const { return std::ranges::any_of(axes, is); }

Done Axes::State::find() {
  if (options.timeout < shortest_timeout || options.timeout > longest_timeout) {
    return obstacle(Obstacle::Kind::wrong_use, "the timeout is outside 1 ms to 10 s");
  }
  const auto until = Clock::now() + options.longest;
  while (group.wait(axes_tick) != Input::fresh) {
    if (options.interrupted && options.interrupted()) {
      return obstacle(Obstacle::Kind::interrupted, "interrupted");
    }
    if (Clock::now() < until) continue;
    return obstacle(Obstacle::Kind::no_bus,
                    fmt::format("no image of {} has come: is taktd running, with the same LCM URL?",
                                group.bus().empty() ? "a bus" : "bus " + group.bus()));
  }
  last_image_ = Clock::now();
  session_ = group.input().session();
  const auto first = Clock::now();
  while (lacks_speed_axes() && Clock::now() - first < layout_time) {
    if (Done done = step(Interruption::obeyed); !done) return done;
  }
  return find_speed_axes() ? Done{} : find_position_axes();
}

Done Axes::State::find_position_axes() {
  const AxisControl& known = group.axes();
  std::string all_names;
  const auto add_name = [&](const std::string& name) {
    all_names += (all_names.empty() ? "" : ", ") + name;
  };
  for (Index i = 0; i < known.size(); ++i) {
    if (is_speed_axis(known.name(i))) continue;
    add_name(known.name(i));
    if (options.names.empty()) axes.push_back(i);
  }
  for (const speed_axis_t& words : group.speed_axes()) add_name(words.node);
  if (std::ranges::any_of(options.names, [&](const auto& name) { return is_speed_axis(name); })) {
    return obstacle(Obstacle::Kind::wrong_use,
                    fmt::format("bus {} does not have all of these axes as speed axes, or one is "
                                "named twice; use one Axes for speed axes and one for axes with "
                                "positions; the axes are: {}",
                                group.bus(), all_names));
  }
  for (const std::string& name : options.names) {
    Index i = 0;
    while (i < known.size() && known.name(i) != name) ++i;
    if (i < known.size() && std::ranges::find(axes, i) == axes.end()) {
      axes.push_back(i);
      continue;
    }
    return obstacle(Obstacle::Kind::wrong_use,
                    fmt::format("bus {} has no axis '{}', or it is named twice; the axes are: {}",
                                group.bus(), name, all_names.empty() ? "none" : all_names));
  }
  for (const Index axis : axes) {
    const AxisSignals& signals = known.signals(axis);
    names.push_back(known.name(axis));
    units.push_back(group.input().signals()[signals.position.value_or(*signals.controlword)].unit);
  }
  commanded_ = axes;
  if (!axes.empty()) return {};
  return obstacle(
      Obstacle::Kind::wrong_use,
      fmt::format("bus {} has no axis: no node has 6040 and 6041 in its PDOs, or the words of an "
                  "inverter",
                  group.bus()));
}

bool Axes::State::is_speed_axis(const std::string& name) const {
  const std::vector<speed_axis_t>& known = group.speed_axes();
  return std::ranges::find(known, name, &speed_axis_t::node) != known.end();
}

/// The message about speed axes comes with the layout, but this program may have subscribed between
/// these two messages.
bool Axes::State::lacks_speed_axes() const {
  if (!group.speed_axes().empty()) return false;
  const AxisControl& known = group.axes();
  const auto has_position = [&](Index axis) {
    return known.signals(axis).target_position.has_value();
  };
  for (const std::string& name : options.names) {
    Index i = 0;
    while (i < known.size() && known.name(i) != name) ++i;
    if (i == known.size() || !has_position(i)) return true;
  }
  Index positions = 0;
  for (Index i = 0; i < known.size(); ++i) positions += has_position(i) ? 1 : 0;
  return positions == 0;
}

Done Axes::State::step(Interruption interruption) {
  const Input input = group.wait(axes_tick);
  for (event_t& event : group.take_events()) {
    // Notes are dropped, except for the event about a requested stop: it is the reason why a motion
    // has ended.
    if (event.severity == 0 && event.kind != "motion_stopped") continue;
    if (events_.size() == most_kept_events) events_.erase(events_.begin());
    events_.push_back(std::move(event));
  }
  if (input == Input::restarted || !is_current()) return restarted();
  const auto now = Clock::now();
  if (input == Input::fresh) {
    last_image_ = now;
    send_outputs();
    if (stream_) serve_stream();
  }
  keep_alive();
  const auto silence = now - last_image_;
  if (silence >
      std::max<nanoseconds>({image_time, options.timeout, image_periods * group.period()})) {
    return obstacle(Obstacle::Kind::no_bus,
                    fmt::format("no image of bus {} has come for {:.1f} s", group.bus(),
                                std::chrono::duration<double>(silence).count()));
  }
  const bool asks = interruption == Interruption::obeyed && options.interrupted;
  if (asks && options.interrupted()) return obstacle(Obstacle::Kind::interrupted, "interrupted");
  return {};
}

/// Signs of life keep only motions alive. If this program commands outputs directly, the time to
/// live of its commands is therefore set to the timeout of the motions.
void Axes::State::send_outputs() {
  give_up_after_silence();
  if (speed) {
    send_speeds();
  } else {
    has_begun_ |= has_motion_ && course() != Course::unanswered && course() != Course::refused;
    // Signs of life keep a drive enabled only after a motion of this drive has begun.
    const bool waits = sending_ == Sending::alive && !has_begun_;
    const bool lasts = waits || !held_.empty() || any([this](Index axis) {
                         return !is_in_mode_of_motions(axis) || !group.axes().in_mode(axis);
                       });
    const auto cycles = options.timeout / std::max<nanoseconds>(group.period(), nanoseconds{1000});
    group.set_time_to_live(lasts ? static_cast<std::int32_t>(cycles)
                                 : AxisGroupOptions{}.time_to_live);
    if (waits || sending_ == Sending::controls) group.send_controls(commanded_);
  }
  send_held();
}

void Axes::State::give_up_after_silence() {
  const auto now = Clock::now();
  const auto silence = now - std::exchange(last_values_, now);
  if ((held_.empty() && !has_set_points_) || silence <= options.timeout) return;
  held_.clear();
  end_set_points();
  lost_text_ = fmt::format("this program was silent for {} ms, so its set-points were discarded",
                           silence / std::chrono::milliseconds{1});
}

/// The axes may have other places in the layout of the new run, so that this object can't command
/// them any more.
Done Axes::State::restarted() {
  session_ = 0;
  sending_ = Sending::nothing;
  held_.clear();
  has_set_points_ = false;
  profile_targets_.reset();
  return obstacle(Obstacle::Kind::restarted, "taktd has restarted");
}

bool Axes::State::is_current() const noexcept {
  return session_ != 0 && group.input().session() == session_;
}

void Axes::State::keep_alive() {
  const auto due = std::min<nanoseconds>(longest_silence, options.timeout / signs_in_timeout);
  if (speed || sending_ == Sending::nothing || Clock::now() - last_sent_ < due) return;
  last_sent_ = Clock::now();
  motion_command_t command{};
  command.kind = "alive";
  command.timeout_ms = static_cast<std::int32_t>(options.timeout.count());
  if (jog_goes_on_ && course() == Course::runs) command.goals = goals();
  group.send_motion(command);
}

std::optional<Done> Axes::State::wait_until(const Condition& reached, nanoseconds longest,
                                            Interruption interruption) {
  const auto begin = Clock::now();
  while (true) {
    const Done done = step(interruption);
    if (!done) return done;
    if (reached()) return Done{};
    if (Clock::now() - begin >= longest) return std::nullopt;
  }
}

Done Axes::State::run(nanoseconds time) {
  if (const Done done = wait_until([] { return false; }, time).value_or(Done{}); !done) return done;
  const std::string lost = std::exchange(lost_text_, {});
  return lost.empty() ? Done{} : obstacle(Obstacle::Kind::stopped, lost);
}

std::string Axes::State::event_text(std::string_view kind, std::string_view part) const {
  for (auto event = events_.rbegin(); event != events_.rend(); ++event) {
    if (event->kind == kind && event->text.find(part) != std::string::npos) return event->text;
  }
  return {};
}

}  // namespace takt
