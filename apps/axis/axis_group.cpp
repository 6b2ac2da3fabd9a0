#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <optional>
#include <poll.h>
#include <span>
#include <string_view>
#include <takt/axis.hpp>
#include <utility>

#include "apps/axis/node_holders.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/lcm/envelope/envelope.hpp"
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

class AxisGroup::State {
 public:
  State(std::unique_ptr<Transport> lcm, AxisGroupOptions options);

  Input wait(std::chrono::nanoseconds longest);
  bool send();
  bool release();
  void sign_with(EnvelopeKey key);
  void set_time_to_live(std::int32_t cycles) noexcept { options_.time_to_live = cycles; }
  std::vector<event_t> take_events() { return std::exchange(events_, {}); }

  AxisControl& axes() noexcept { return axes_; }
  const ImageInput& input() const noexcept { return input_; }
  const NodeHolder& holder(AxisControl::Index axis) const;
  const std::string& sender() const noexcept { return sender_; }
  const std::string& bus() const noexcept { return bus_; }
  std::chrono::nanoseconds period() const noexcept;
  std::chrono::nanoseconds age() const { return Clock::now() - arrival_; }

 private:
  using Clock = std::chrono::steady_clock;

  void serve();
  void take(std::string_view channel, std::span<const std::byte> data);
  void listen_to(std::string_view bus);
  void take_image(std::span<const std::byte> data);
  void take_layout(std::span<const std::byte> data);
  void take_status(std::span<const std::byte> data);
  void report_schema(std::int16_t schema);
  bool publish(command_t& command);
  bool is_stale() const;

  std::unique_ptr<Transport> lcm_;
  AxisGroupOptions options_;
  std::int64_t instance_;
  std::string sender_;
  std::string bus_;
  std::string heard_;  // first bus whose layout arrived; only if no bus was configured
  std::string image_channel_;
  std::string layout_channel_;
  std::string command_channel_;
  std::string secured_channel_;
  std::string event_channel_;
  std::string status_channel_;
  ImageInput input_;
  AxisControl axes_;
  NodeHolders holders_;
  bool fresh_ = false;
  bool new_layout_ = false;
  bool reported_stale_ = false;
  bool reported_schema_ = false;
  bool commands_ = false;  // something was sent since the last release
  Clock::time_point arrival_{};
  std::optional<EnvelopeSeal> seal_;  // empty if there is no key
  std::vector<event_t> events_;
  std::vector<std::byte> buffer_;
};

AxisGroup::State::State(std::unique_ptr<Transport> lcm, AxisGroupOptions options)
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

void AxisGroup::State::listen_to(std::string_view bus) {
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

void AxisGroup::State::take(std::string_view channel, std::span<const std::byte> data) {
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

void AxisGroup::State::take_image(std::span<const std::byte> data) {
  const auto part = decode<image_t>(data);
  if (part) {
    fresh_ |= input_.take(*part);
  } else if (part.error() == DecodeFault::schema_1) {
    report_schema(1);
  }
}

void AxisGroup::State::take_layout(std::span<const std::byte> data) {
  const auto part = decode<layout_t>(data);
  if (!part) return;
  if (part->schema != message_schema) return report_schema(part->schema);
  if (!input_.take(*part)) return;
  new_layout_ = true;
  holders_.clear();
}

void AxisGroup::State::take_status(std::span<const std::byte> data) {
  const auto part = decode<status_t>(data);
  const bool fits = part && part->schema == message_schema && input_.has_layout();
  if (fits && part->session == input_.session()) holders_.take(*part);
}

void AxisGroup::State::report_schema(std::int16_t schema) {
  if (std::exchange(reported_schema_, true) || events_.size() == most_events) return;
  event_t event{};
  event.schema = message_schema;
  event.kind = "other_schema";
  event.severity = 2;
  event.text = daemon_schema_text(schema);
  events_.push_back(std::move(event));
}

void AxisGroup::State::serve() {
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

Input AxisGroup::State::wait(std::chrono::nanoseconds longest) {
  const auto until = Clock::now() + longest;
  std::vector<pollfd> descriptors;
  while (true) {
    serve();
    if (std::exchange(new_layout_, false)) {
      axes_.set_layout(input_);
      fresh_ = reported_stale_ = false;
      return Input::restarted;
    }
    if (std::exchange(fresh_, false)) {
      arrival_ = Clock::now();
      reported_stale_ = false;
      axes_.on_image(input_);
      return Input::fresh;
    }
    if (!reported_stale_ && is_stale()) {
      reported_stale_ = true;
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

bool AxisGroup::State::send() {
  commands_ = true;
  command_t& command = axes_.command();
  command.release = 0;
  return publish(command);
}

bool AxisGroup::State::release() {
  if (!std::exchange(commands_, false)) return true;
  command_t command{};
  command.schema = message_schema;
  command.session = input_.session();
  command.cycle = input_.cycle();
  command.release = 1;
  return publish(command);
}

bool AxisGroup::State::publish(command_t& command) {
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

void AxisGroup::State::sign_with(EnvelopeKey key) {
  seal_.emplace(std::move(key), random_number());
}

const NodeHolder& AxisGroup::State::holder(AxisControl::Index axis) const {
  return holders_[axes_.signals(axis).node];
}

std::chrono::nanoseconds AxisGroup::State::period() const noexcept {
  return std::chrono::nanoseconds{input_.period_ns()};
}

bool AxisGroup::State::is_stale() const {
  return input_.has_image() && age() > options_.stale_cycles * period();
}

AxisGroup::AxisGroup(std::unique_ptr<Transport> lcm, AxisGroupOptions options)
    : state_{std::make_unique<State>(std::move(lcm), std::move(options))} {}

AxisGroup::~AxisGroup() { release(); }

void AxisGroup::sign_with(EnvelopeKey key) { state_->sign_with(std::move(key)); }
Input AxisGroup::wait(std::chrono::nanoseconds longest) { return state_->wait(longest); }
bool AxisGroup::send() { return state_->send(); }
bool AxisGroup::release() { return state_->release(); }
std::vector<event_t> AxisGroup::take_events() { return state_->take_events(); }

void AxisGroup::set_time_to_live(std::int32_t cycles) noexcept { state_->set_time_to_live(cycles); }

bool AxisGroup::load_targets(const Eigen::Ref<const Eigen::VectorXd>& positions) {
  axes().set_positions(positions);
  return send();
}

AxisControl& AxisGroup::axes() noexcept { return state_->axes(); }
const ImageInput& AxisGroup::input() const noexcept { return state_->input(); }
const std::string& AxisGroup::sender() const noexcept { return state_->sender(); }
const std::string& AxisGroup::bus() const noexcept { return state_->bus(); }
std::chrono::nanoseconds AxisGroup::period() const noexcept { return state_->period(); }
std::chrono::nanoseconds AxisGroup::age() const { return state_->age(); }

const NodeHolder& AxisGroup::holder(AxisControl::Index axis) const { return state_->holder(axis); }

}  // namespace takt
