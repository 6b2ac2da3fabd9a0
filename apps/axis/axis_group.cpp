#include "apps/axis/axis_group.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <poll.h>
#include <span>
#include <utility>

#include "master/lcm/channel_names.hpp"
#include "master/lcm/messages.hpp"
#include "master/lcm/random_number.hpp"

namespace takt {
namespace {

constexpr std::size_t most_events = 256;
/// Most rounds in which one call empties the queue, so that a flood of messages cannot hold the
/// caller.
constexpr int most_rounds = 16;
/// How often wait() checks whether the newest image is stale.
constexpr std::chrono::milliseconds longest_pause{1};

/// taktd accepts names of 1 to 64 bytes.
std::string sender_name(const std::string& program, std::int64_t instance) {
  constexpr std::size_t longest = 64;
  std::array<char, 10> digits{};
  std::snprintf(digits.data(), digits.size(), " %08x", static_cast<std::uint32_t>(instance));
  return program.substr(0, longest + 1 - digits.size()) + digits.data();
}

timespec to_timespec(std::chrono::nanoseconds time) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  return {.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()};
}

}  // namespace

AxisGroup::AxisGroup(std::unique_ptr<Transport> lcm, AxisGroupOptions options)
    : lcm_{std::move(lcm)},
      options_{std::move(options)},
      instance_{options_.instance != 0 ? options_.instance : random_number()},
      sender_{sender_name(options_.sender, instance_)},
      holders_{sender_} {
  if (options_.bus.empty()) {
    lcm_->subscribe(any_bus("LAYOUT"));
  } else {
    listen_to(options_.bus);
    lcm_->subscribe(layout_channel_);
  }
}

void AxisGroup::listen_to(std::string_view bus) {
  bus_ = bus;
  image_channel_ = channel_name(bus_, "IMAGE");
  layout_channel_ = channel_name(bus_, "LAYOUT");
  command_channel_ = channel_name(bus_, "COMMAND");
  secured_channel_ = channel_name(bus_, "SECURED");
  event_channel_ = channel_name(bus_, "EVENT");
  status_channel_ = channel_name(bus_, "STATUS");
  lcm_->subscribe(image_channel_);
  lcm_->subscribe(event_channel_);
  lcm_->subscribe(status_channel_);
}

void AxisGroup::take(std::string_view channel, std::span<const std::byte> data) {
  if (bus_.empty()) {
    heard_ = bus_of_channel(channel, "LAYOUT");
  } else if (channel == image_channel_) {
    take_image(data);
  } else if (channel == layout_channel_) {
    take_layout(data);
  } else if (channel == status_channel_) {
    take_status(data);
  } else if (channel == event_channel_ && events_.size() < most_events) {
    if (auto event = decode<event_t>(data)) events_.push_back(std::move(*event));
  }
}

void AxisGroup::take_image(std::span<const std::byte> data) {
  const auto part = decode<image_t>(data);
  if (part) {
    fresh_ |= input_.take(*part);
  } else if (part.error() == DecodeFault::schema_1) {
    tell_schema(1);
  }
}

void AxisGroup::take_layout(std::span<const std::byte> data) {
  const auto part = decode<layout_t>(data);
  if (!part) return;
  if (part->schema != message_schema) return tell_schema(part->schema);
  if (!input_.take(*part)) return;
  new_layout_ = true;
  holders_.clear();
}

void AxisGroup::take_status(std::span<const std::byte> data) {
  const auto part = decode<status_t>(data);
  const bool fits = part && part->schema == message_schema && input_.has_layout();
  if (fits && part->session == input_.session()) holders_.take(*part);
}

void AxisGroup::tell_schema(std::int16_t schema) {
  if (std::exchange(told_schema_, true) || events_.size() == most_events) return;
  event_t event{};
  event.schema = message_schema;
  event.kind = "other_schema";
  event.severity = 2;
  event.text = daemon_schema_text(schema);
  events_.push_back(std::move(event));
}

void AxisGroup::serve() {
  std::vector<pollfd> descriptors;
  int ready = 1;
  for (int i = 0; i < most_rounds && ready > 0; ++i) {  // empties the queue: only the newest counts
    input_.set_time(std::chrono::nanoseconds{Clock::now().time_since_epoch()}.count());
    lcm_->serve(
        [this](std::string_view channel, std::span<const std::byte> data) { take(channel, data); });
    descriptors.clear();
    lcm_->watch(descriptors);
    ready = ::poll(descriptors.data(), descriptors.size(), 0);
  }
  if (bus_.empty() && !heard_.empty()) listen_to(heard_);
}

Input AxisGroup::wait(std::chrono::nanoseconds longest) {
  const auto until = Clock::now() + longest;
  std::vector<pollfd> descriptors;
  while (true) {
    serve();
    if (std::exchange(new_layout_, false)) {
      axes_.set_layout(input_);
      fresh_ = told_stale_ = false;
      return Input::restarted;
    }
    if (std::exchange(fresh_, false)) {
      arrival_ = Clock::now();
      told_stale_ = false;
      axes_.on_image(input_);
      return Input::fresh;
    }
    if (!told_stale_ && is_stale()) {
      told_stale_ = true;
      return Input::stale;
    }
    const auto left = until - Clock::now();
    if (left <= left.zero()) return Input::nothing;
    descriptors.clear();
    lcm_->watch(descriptors);
    const auto pause = to_timespec(std::min<std::chrono::nanoseconds>(left, longest_pause));
    ::ppoll(descriptors.data(), descriptors.size(), &pause, nullptr);
  }
}

AxisGroup::~AxisGroup() { release(); }

bool AxisGroup::send() {
  commands_ = true;
  command_t& command = axes_.command();
  command.release = 0;
  return publish(command);
}

bool AxisGroup::release() {
  if (!std::exchange(commands_, false)) return true;
  command_t command{};
  command.schema = message_schema;
  command.session = input_.session();
  command.cycle = input_.cycle();
  command.release = 1;
  return publish(command);
}

bool AxisGroup::publish(command_t& command) {
  using std::chrono::microseconds;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  command.utime = std::chrono::duration_cast<microseconds>(now).count();
  command.instance = instance_;
  command.sender = sender_;
  command.time_to_live = options_.time_to_live;
  const Bytes message = encode(command, buffer_);
  if (!seal_) return lcm_->publish(command_channel_, message);
  return lcm_->publish(secured_channel_,
                       seal_->seal(command_channel_, message, command.session, now));
}

void AxisGroup::sign_with(EnvelopeKey key) { seal_.emplace(std::move(key), random_number()); }

bool AxisGroup::load_targets(const Eigen::Ref<const Eigen::VectorXd>& positions) {
  axes_.set_positions(positions);
  return send();
}

const NodeHolder& AxisGroup::holder(AxisControl::Index axis) const {
  return holders_[axes_.signals(axis).node];
}

std::chrono::nanoseconds AxisGroup::period() const noexcept {
  return std::chrono::nanoseconds{input_.period_ns()};
}

std::chrono::nanoseconds AxisGroup::age() const { return Clock::now() - arrival_; }

bool AxisGroup::is_stale() const {
  return input_.has_image() && age() > options_.stale_cycles * period();
}

std::vector<event_t> AxisGroup::take_events() { return std::exchange(events_, {}); }

}  // namespace takt
