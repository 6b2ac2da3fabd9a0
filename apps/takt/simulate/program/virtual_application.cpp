#include "apps/takt/simulate/program/virtual_application.hpp"

#include <algorithm>
#include <chrono>

#include "eds_parser/values/ids.hpp"
#include "master/lcm/messages.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t application_room = 300;  // messages
constexpr std::int64_t stride = 16;            // counts per command; low bits identify the program
constexpr std::int64_t downwards = 8;          // the low bit that marks a falling position
// Largest magnitude of the push, per mille of the rated torque.
constexpr std::int64_t most_push = 100;
constexpr std::int64_t push_velocity = 4;  // counts per second for each unit of push
// Number of images between fault resets, which take several images.
constexpr std::uint64_t images_a_reset = 60;
constexpr std::uint16_t from_target_to_offset = 0x60B0 - 0x607A;
constexpr double turn_before = 2000;  // counts from a limit at which an axis turns back
// Longest time for which a program may receive images without using one. It needs the layout, which
// is published once a second.
constexpr Time longest_deafness = 3s;
constexpr Time longest_turn = 15s;  // longest turn with motions
constexpr Time longest_set_points = 4s;
constexpr Time leaving_time = 2s;       // time in which the motions of a program come to rest
constexpr Time talkative_time = 500ms;  // time in which the first motion has begun

}  // namespace

VirtualApplication::VirtualApplication(const BusPlan& plan, VirtualLcm& lcm,
                                       ApplicationOptions options, sim::Random random)
    : plan_{plan},
      options_{std::move(options)},
      random_{random},
      lcm_{lcm.join(application_room)},
      channels_{plan.name},
      commander_{plan, options_.nodes, options_.number} {}

void VirtualApplication::start() {
  running_ = true;
  stalled_until_ = {};
  instance_ = static_cast<std::int64_t>(random_.next() >> 2 | 1U);
  if (options_.instance) instance_ = options_.instance(instance_);
  time_to_live_ = 8 + random_.below(20);
  input_ = {};
  axes_ = {};
  courses_.clear();
  jump_ = 0;
  new_layout_ = fresh_ = false;
  heard_ = 0;
  turn_ = Turn::set_points;
  turn_ends_ = turn_began_ = {};
  lcm_.subscribe(channels_.image);
  lcm_.subscribe(channels_.layout);
}

void VirtualApplication::kill() {
  running_ = false;
  lcm_.close();
}

void VirtualApplication::end(Time now) {
  command_t& command = axes_.command();
  keep_own_outputs(command);
  command.instance = instance_;
  command.sender = options_.name;
  command.release = 1;
  if (!command.signals.empty()) lcm_.publish(channels_.command, encode(command, buffer_));
  if (options_.released) options_.released(now);
  kill();
}

std::string VirtualApplication::text() const {
  std::string words = "program " + std::to_string(options_.number);
  for (AxisControl::Index i = 0; i < axes_.size(); ++i) {
    words += ", " + axes_.name(i) + " (" + hex(axes_.statusword(i)) + ")";
  }
  return words;
}

std::size_t VirtualApplication::leads() const noexcept {
  if (!running_) return 0;
  return static_cast<std::size_t>(std::ranges::count_if(
      courses_, [](const Course& course) { return course.position.has_value(); }));
}

Time VirtualApplication::next() const noexcept {
  const Time arrival = lcm_.next_arrival();
  if (!running_ || arrival == never) return never;
  return std::max(arrival + reaction_, stalled_until_);
}

void VirtualApplication::act(Time now) {
  reaction_ = slowness_ + 20us + Time{random_.below(random_.chance(0.02) ? 5'000'000 : 300'000)};
  input_.set_time(now.count());
  hears_ = false;
  lcm_.serve([this](std::string_view channel, Bytes data) { take(channel, data); });
  if (std::exchange(new_layout_, false)) {
    axes_.set_layout(input_);
    axes_.set_goal(DriveGoal::enabled);
    courses_.assign(static_cast<std::size_t>(axes_.size()), {});
    find_offsets();
    fresh_ = false;
  }
  judge_hearing(now);
  if (!std::exchange(fresh_, false)) return;
  take_turns(now);
  follow_image();
  send(now);
}

/// Begins the next turn if the present one is over. Draws random numbers only if there are turns.
void VirtualApplication::take_turns(Time now) {
  const bool is_first = turn_began_ == Time{};
  if (options_.commanding == Commanding::set_points && turn_ == Turn::set_points) return;
  if (!commander_.has_axes() || (!is_first && now < turn_ends_)) return;
  const bool by_motions = options_.commanding == Commanding::motions ||
                          (options_.commanding == Commanding::by_turns &&
                           turn_ == Turn::set_points && (!is_first || random_.chance(0.7)));
  if (by_motions && turn_ != Turn::motions) {
    commander_.start(random_.fork(motions_ + 1));
    terse_ = random_.chance(0.5);
    turn_began_ = now;
  } else if (is_first) {
    turn_began_ = now;
  }
  const bool leaves = turn_ == Turn::motions && !by_motions;
  if (leaves) commander_.leave();
  turn_ = by_motions ? Turn::motions : leaves ? Turn::leaving : Turn::set_points;
  const Time longest = by_motions ? longest_turn : longest_set_points;
  turn_ends_ = now + (leaves ? leaving_time : random_.up_to(longest));
  courses_.assign(courses_.size(), {});
}

void VirtualApplication::take(std::string_view channel, Bytes data) {
  if (channel == channels_.layout) {
    if (const auto part = decode<layout_t>(data)) new_layout_ |= input_.take(*part);
  } else if (const auto part = decode<image_t>(data)) {
    hears_ = true;
    if (options_.hears && !options_.hears(*part)) return;
    if (!input_.take(*part)) return;
    fresh_ = true;
    sync_ = Time{part->sync_mono_ns};
  }
}

/// Checks that a program that receives images uses the newest of them, whatever messages come in
/// between. Images that waited while the program was stalled count once.
void VirtualApplication::judge_hearing(Time now) {
  if (fresh_) heard_ = 0;
  if (fresh_ || !hears_) return;
  if (heard_++ == 0) heard_since_ = now;
  const auto enough = static_cast<std::uint64_t>(longest_deafness / plan_.cycle.period);
  if (!options_.deaf || heard_ < enough || now - heard_since_ < longest_deafness) return;
  options_.deaf("program " + std::to_string(options_.number) + " has received images " +
                std::to_string(heard_) + " times in " + std::to_string((now - heard_since_) / 1ms) +
                " ms, but used no image");
}

void VirtualApplication::follow_image() {
  axes_.on_image(input_);
  // Set-points that follow motions begin at the positions to which the motions have moved the axes.
  if (turn_ != Turn::set_points) axes_.set_positions(axes_.sent_positions());
  const bool resets = ++images_ % images_a_reset == 0;
  for (AxisControl::Index i = 0; i < axes_.size(); ++i) {
    const DriveSequence& drive = axes_.drive(i);
    if (drive.in_fault()) {
      if (resets) axes_.reset_faults();
    } else if (drive.goal() == DriveGoal::disabled) {
      axes_.set_goal(i, DriveGoal::enabled);
    }
  }
}

void VirtualApplication::keep_own_outputs(command_t& command) const {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < command.signals.size(); ++i) {
    const auto signal = static_cast<std::size_t>(command.signals[i]);
    if (!options_.nodes[plan_.layout.signals[signal].node_index]) continue;
    command.signals[kept] = command.signals[i];
    command.values[kept++] = command.values[i];
  }
  command.signals.resize(kept);
  command.values.resize(kept);
  command.num_values = static_cast<std::int32_t>(kept);
}

std::int64_t VirtualApplication::next_position(AxisControl::Index axis, std::int64_t from) {
  Course& course = courses_[static_cast<std::size_t>(axis)];
  const auto signal = static_cast<SignalIndex>(*axes_.signals(axis).target_position);
  const auto at = static_cast<double>(from);
  for (const OutputLimit& limit : plan_.limits.outputs) {
    if (limit.signal != signal) continue;
    if (at > limit.high - turn_before) course.down = true;
    if (at < limit.low + turn_before) course.down = false;
  }
  const std::int64_t step = (from & -stride) / stride + (course.down ? -1 : 1);
  const std::int64_t jump = has_push(axis) ? 0 : jump_;
  course.position = step * stride + options_.number + (course.down ? downwards : 0);
  (offsets_[static_cast<std::size_t>(axis)] ? course.shift : *course.position) += jump;
  return *course.position;
}

/// Finds the output 60B0 of each axis that has a target position.
void VirtualApplication::find_offsets() {
  offsets_.clear();
  for (AxisControl::Index i = 0; i < axes_.size(); ++i) {
    auto& offset = offsets_.emplace_back();
    const auto target_position = axes_.signals(i).target_position;
    if (!target_position) continue;
    const Signal& target = plan_.layout.signals[*target_position];
    const auto index = static_cast<std::uint16_t>(target.object.index + from_target_to_offset);
    offset = plan_.layout.find(target.node_index, {index, 0}, true);
  }
}

/// Adds the position offset, which the axis library does not command.
void VirtualApplication::shift(AxisControl::Index axis, command_t& command) const {
  const auto offset = offsets_[static_cast<std::size_t>(axis)];
  if (!offset) return;
  command.signals.push_back(static_cast<std::int32_t>(*offset));
  command.values.push_back(courses_[static_cast<std::size_t>(axis)].shift);
  ++command.num_values;
}

bool VirtualApplication::has_push(AxisControl::Index axis) const {
  const AxisSignals& signals = axes_.signals(axis);
  return signals.target_velocity || signals.target_torque;
}

/// Splits the set-point into a target and an offset if the drive has both.
void VirtualApplication::put_shared(AxisSignals::Position target, AxisSignals::Position offset,
                                    std::int64_t value, command_t& command) {
  const auto put = [&](AxisSignals::Position signal, std::int64_t share) {
    if (!signal) return;
    const auto at = std::ranges::find(command.signals, static_cast<std::int32_t>(*signal));
    if (at == command.signals.end()) return;
    command.values[static_cast<std::size_t>(at - command.signals.begin())] = share;
  };
  put(target, offset ? value - value / 2 : value);
  put(offset, value / 2);
}

/// Sets target velocity and target torque if the drive has them.
void VirtualApplication::push(AxisControl::Index axis, command_t& command) {
  Course& course = courses_[static_cast<std::size_t>(axis)];
  if (course.push >= most_push) course.weaker = true;
  if (course.push <= -most_push) course.weaker = false;
  course.push += course.weaker ? -1 : 1;
  course.apart += jump_;
  const AxisSignals& signals = axes_.signals(axis);
  put_shared(signals.target_velocity, signals.velocity_offset,
             course.push * push_velocity + course.apart, command);
  put_shared(signals.target_torque, signals.torque_offset, course.push + course.apart, command);
}

void VirtualApplication::count_on(command_t& command) {
  for (AxisControl::Index i = 0; i < axes_.size(); ++i) {
    const auto target = axes_.signals(i).target_position;
    if (!target) continue;
    const auto at = std::ranges::find(command.signals, *target);
    const bool led =
        turn_ != Turn::set_points && commander_.leads(static_cast<SignalIndex>(*target));
    if (at == command.signals.end() || led) continue;
    Course& course = courses_[static_cast<std::size_t>(i)];
    if (axes_.drive(i).enabled()) {
      std::int64_t& value = command.values[static_cast<std::size_t>(at - command.signals.begin())];
      value = next_position(i, course.position.value_or(value));
      push(i, command);
    } else {
      course = {.position = {}, .down = course.down};
    }
    shift(i, command);
  }
  jump_ = 0;
}

/// Removes the outputs that the motions control.
void VirtualApplication::leave_motions(command_t& command, Time now) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < command.signals.size(); ++i) {
    const auto signal = static_cast<SignalIndex>(command.signals[i]);
    commander_.see(signal, command.values[i], now);
    if (commander_.leads(signal)) continue;
    command.signals[kept] = command.signals[i];
    command.values[kept++] = command.values[i];
  }
  command.signals.resize(kept);
  command.values.resize(kept);
  command.num_values = static_cast<std::int32_t>(kept);
}

/// A terse program commands outputs only until its axes are enabled and its first motion has begun.
bool VirtualApplication::has_to_command(Time now) const {
  if (turn_ != Turn::motions || !terse_ || now < turn_began_ + talkative_time) return true;
  for (AxisControl::Index i = 0; i < axes_.size(); ++i) {
    const AxisSignals& signals = axes_.signals(i);
    const bool mine = signals.target_position &&
                      commander_.leads(static_cast<SignalIndex>(*signals.target_position));
    if (mine && !axes_.drive(i).enabled()) return true;
  }
  return false;
}

/// `command` is the command of outputs of the same image.
void VirtualApplication::send_motion(const command_t& command, Time now) {
  auto message = commander_.next(now);
  if (!message) return;
  message->utime = now / 1us;
  message->schema = command.schema;
  message->session = command.session;
  message->cycle = command.cycle;
  message->instance = instance_;
  message->sender = options_.name;
  std::optional<motion_gear_t> gear;
  std::optional<motion_stream_t> stream;
  if (message->kind == "gear") gear = commander_.gear(*message);
  if (message->kind == "stream" || message->kind == "points") stream = commander_.stream(*message);
  if (options_.motion_commanded) {
    options_.motion_commanded({.command = *message,
                               .computed_from = sync_,
                               .points_until = commander_.points_until(),
                               .gear = gear ? &*gear : nullptr,
                               .stream = stream ? &*stream : nullptr});
  }
  ++motions_;
  if (gear) {
    lcm_.publish(channels_.motion_gear, encode(*gear, buffer_));
  } else if (stream) {
    lcm_.publish(channels_.motion_stream, encode(*stream, buffer_));
  } else {
    lcm_.publish(channels_.motion_command, encode(*message, buffer_));
  }
}

void VirtualApplication::send(Time now) {
  command_t& command = axes_.command();
  keep_own_outputs(command);
  if (command.signals.empty()) return;
  count_on(command);
  if (turn_ != Turn::set_points) {
    leave_motions(command, now);
    send_motion(command, now);
    if (command.signals.empty() || !has_to_command(now)) return;
  }
  command.utime = now / 1us;
  command.instance = instance_;
  command.sender = options_.name;
  command.time_to_live = static_cast<std::int32_t>(time_to_live_);
  if (options_.commanded) options_.commanded(command, sync_);
  ++sent_;
  lcm_.publish(channels_.command, encode(command, buffer_));
}

}  // namespace takt
