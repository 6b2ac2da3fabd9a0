#include "apps/takt/simulate/program/forger.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <concepts>

#include "master/lcm/messages.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t memory = 8192;  // number of commands that the forger remembers
// Age in which a command may still be valid; the forger repeats only older commands.
constexpr Time as_good_as_new = 2s;
constexpr std::int64_t low_bits = 15;  // bits of a position that identify its sender
constexpr std::int64_t nobody = 6;     // value of these bits that no program uses
constexpr std::int64_t fewest_away =
    50'000;  // shortest distance, in cycles, of a forged cycle from the true one
constexpr Time least_away = 10s;  // this distance as a time; no lease lasts longer than 1 s
constexpr std::int64_t never_reached = std::int64_t{1} << 62;  // cycle number

}  // namespace

Forger::Forger(const BusPlan& plan, VirtualLcm& lcm, Forged forged, sim::Random random)
    : plan_{plan},
      forged_{std::move(forged)},
      random_{random},
      lcm_{lcm.join(1000, Echo::unheard)},
      channels_{plan.name} {
  lcm_.subscribe(channels_.command);
  lcm_.subscribe(channels_.motion_command);
  lcm_.subscribe(channels_.motion_gear);
  lcm_.subscribe(channels_.image);
}

void Forger::act(Time now) {
  lcm_.serve([&](std::string_view channel, Bytes data) {
    if (channel == channels_.image) {
      image_.assign(data.begin(), data.end());
      return;
    }
    auto& memory_of = channel == channels_.command       ? heard_
                      : channel == channels_.motion_gear ? gears_
                                                         : motions_;
    memory_of.push_back({.when = now, .command = {data.begin(), data.end()}});
    if (memory_of.size() > memory) memory_of.pop_front();
  });
}

void Forger::publish(const std::string& channel, Bytes data) {
  ++sent_;
  lcm_.publish(channel, data);
}

/// If the program has received no message about motions, it forges none.
void Forger::act_up(Time now) {
  if (!gears_.empty() && random_.chance(0.2)) {
    return random_.chance(0.5) ? forge_motion<motion_gear_t>(gears_, channels_.motion_gear, now)
                               : replay_motions<motion_gear_t>(gears_, channels_.motion_gear, now);
  }
  if (!motions_.empty() && random_.chance(0.4)) {
    return random_.chance(0.5)
               ? forge_motion<motion_command_t>(motions_, channels_.motion_command, now)
               : replay_motions<motion_command_t>(motions_, channels_.motion_command, now);
  }
  switch (random_.below(4)) {
    case 0:
      return forge_image(now);
    case 1:
      return send_random_bytes();
    case 2:
      return replay(now);
    default:
      return forge_command(now);
  }
}

void Forger::replay(Time now) {
  const auto old = std::ranges::partition_point(
      heard_, [&](const Heard& heard) { return heard.when < now - as_good_as_new; });
  const auto many = static_cast<std::uint32_t>(old - heard_.begin());
  if (many == 0) return;
  const std::uint32_t first = random_.below(many);
  const std::uint32_t last = std::min(many, first + 1 + random_.below(60));
  const bool from_no_cycle = random_.chance(0.5);
  for (std::uint32_t i = first; i < last; ++i) {
    auto command = decode<command_t>(heard_[i].command);
    if (!command) continue;
    if (from_no_cycle) command->cycle = 0;
    if (random_.chance(0.1)) command->time_to_live = 0x7FFF'FFFF;
    publish(channels_.command, encode(*command, buffer_));
  }
}

template <class Message>
void Forger::replay_motions(const std::deque<Heard>& heard, const std::string& channel, Time now) {
  const auto old = std::ranges::partition_point(
      heard, [&](const Heard& one) { return one.when < now - as_good_as_new; });
  const auto many = static_cast<std::uint32_t>(old - heard.begin());
  if (many == 0) return;
  const std::uint32_t first = random_.below(many);
  const std::uint32_t last = std::min(many, first + 1 + random_.below(60));
  const bool from_no_cycle = random_.chance(0.5);
  for (std::uint32_t i = first; i < last; ++i) {
    auto motion = decode<Message>(heard[i].command);
    if (!motion) continue;
    if (from_no_cycle) motion->cycle = 0;
    publish(channel, encode(*motion, buffer_));
  }
}

/// Returns the true cycle, extrapolated by the clock from the newest image as in the daemon.
/// Returns std::nullopt if no image has come yet.
std::optional<std::int64_t> Forger::cycle_at(Time now) const {
  const auto image = decode<image_t>(image_);
  if (!image) return std::nullopt;
  return image->cycle + (now - Time{image->sync_mono_ns}) / plan_.cycle.period;
}

std::int64_t Forger::far_away() const noexcept {
  return std::max<std::int64_t>(fewest_away, least_away / plan_.cycle.period);
}

/// Returns cycles that are far from `cycle`, or none at all.
std::array<std::int64_t, 6> Forger::wrong_cycles(std::int64_t cycle) {
  return {0,
          -1,
          cycle + far_away() + random_.below(100'000),
          never_reached,
          std::int64_t{0x7FFF'FFFF'FFFF'FFFF},
          cycle - 2 * far_away()};
}

/// Sends the newest message with other targets, without limits, and with a wrong cycle or session.
template <class Message>
void Forger::forge_motion(const std::deque<Heard>& heard, const std::string& channel, Time now) {
  const auto cycle = cycle_at(now);
  if (heard.empty() || !cycle) return;
  auto motion = decode<Message>(heard.back().command);
  if (!motion) return;
  const auto wrong = wrong_cycles(*cycle);
  if (random_.chance(0.2)) {
    motion->session ^= static_cast<std::int64_t>(random_.next() >> 1 | 1U);
  } else {
    motion->cycle = wrong[random_.below(wrong.size())];
  }
  if (random_.chance(0.3)) motion->timeout_ms = 10'000;
  if constexpr (std::same_as<Message, motion_command_t>) {
    if (random_.chance(0.7)) motion->kind = "move";
  }
  for (motion_goal_t& goal : motion->goals) {
    goal.position = -goal.position;
    goal.max_velocity *= 2;
    goal.max_acceleration *= 2;
    goal.max_jerk = 0;
  }
  publish(channel, encode(*motion, buffer_));
}

void Forger::forge_command(Time now) {
  const auto cycle = cycle_at(now);
  if (heard_.empty() || !cycle) return;
  auto command = decode<command_t>(heard_.back().command);
  if (!command) return;
  const auto wrong = wrong_cycles(*cycle);
  const bool other_session = random_.chance(0.2);
  if (other_session) {
    command->session ^= static_cast<std::int64_t>(random_.next() >> 1 | 1U);
  } else {
    command->cycle = wrong[random_.below(wrong.size())];
  }
  if (random_.chance(0.3)) command->time_to_live = 0x7FFF'FFFF;
  for (std::size_t i = 0; i < command->signals.size(); ++i) {
    const auto signal = static_cast<SignalIndex>(command->signals[i]);
    if (plan_.layout.signals[signal].object.index != 0x607A) continue;
    // The value stays within every limit.
    command->values[i] = (command->values[i] & ~low_bits) | nobody;
    forged_(signal, command->values[i]);
  }
  publish(channels_.command, encode(*command, buffer_));
}

void Forger::forge_image(Time now) {
  const auto cycle = cycle_at(now);
  auto image = decode<image_t>(image_);
  if (!image || !cycle) return;
  const std::int64_t ahead = *cycle + far_away() + random_.below(1'000'000);
  image->cycle = random_.chance(0.5) ? never_reached : ahead;
  publish(channels_.image, encode(*image, buffer_));
}

void Forger::send_random_bytes() {
  std::vector<std::byte> bytes;
  if (!motions_.empty() && random_.chance(0.3)) {
    bytes = motions_.back().command;
    bytes.resize(random_.below(static_cast<std::uint32_t>(bytes.size())));
    return publish(channels_.motion_command, bytes);
  }
  if (!heard_.empty() && random_.chance(0.5)) {
    bytes = heard_.back().command;
    bytes.resize(random_.below(static_cast<std::uint32_t>(bytes.size())));
  } else {
    bytes.resize(random_.below(2000));
    std::ranges::generate(bytes, [&] { return std::byte(random_.below(256)); });
  }
  const std::array channels{&channels_.command, &channels_.request, &channels_.image,
                            &channels_.layout, &channels_.transfer};
  publish(*channels[random_.below(channels.size())], bytes);
}

}  // namespace takt
