#include "master/gateway/bridge.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "master/lcm/channel_names.hpp"
#include "master/lcm/random_number.hpp"

namespace takt {
namespace {

// Number of image periods for which due states of the bus wait for an image, at most
// `longest_wait`. One state follows each image.
constexpr int most_images = 5;
constexpr Time longest_wait = std::chrono::milliseconds{20};
constexpr unsigned most_behind = 8;  // further images of a backlog go out without typed messages
constexpr std::uint64_t not_yet = ~0ULL;

}  // namespace

Channels::Channels(const std::string& bus)
    : image{channel_name(bus, "IMAGE")},
      layout{channel_name(bus, "LAYOUT")},
      speed_axes{channel_name(bus, "SPEED_AXES")},
      command{channel_name(bus, "COMMAND")},
      motion{channel_name(bus, "MOTION")},
      motion_command{channel_name(bus, "MOTION_COMMAND")},
      motion_gear{channel_name(bus, "MOTION_GEAR")},
      motion_stream{channel_name(bus, "MOTION_STREAM")},
      status{channel_name(bus, "STATUS")},
      sync{channel_name(bus, "SYNC")},
      pdos{channel_name(bus, "PDOS")},
      timing{channel_name(bus, "TIMING")},
      event{channel_name(bus, "EVENT")},
      request{channel_name(bus, "REQUEST")},
      reply{channel_name(bus, "REPLY")},
      transfer{channel_name(bus, "TRANSFER")},
      transfer_state{channel_name(bus, "TRANSFER_STATE")} {}

Bridge::Bridge(MasterRun& master, Transport& transport, const Clocks& clocks, BridgeOptions options,
               NoticeSink announce)
    : master_{master},
      transport_{transport},
      clocks_{clocks},
      options_{std::move(options)},
      announce_{std::move(announce)},
      channels_{master.plan().name},
      image_messages_{master.plan(), options_.session},
      layout_messages_{layout_messages(master.plan(), options_.session)},
      speed_messages_{speed_messages(master.plan(), options_.session)},
      status_messages_{master.plan(), {options_.session, options_.interface, options_.realtime}},
      timing_messages_{options_.session},
      commands_{master.plan(),
                {.session = options_.session, .observe = options_.observe},
                [this](SignalIndex signal, std::int64_t value, std::uint32_t time_to_live) {
                  outputs_staged_ |= master_.set(signal, value, time_to_live);
                },
                [this](const Notice& notice) { this->announce(notice); }},
      motions_{master.plan(), commands_,
               [this](const motion::MotionMessage& message) { return master_.submit(message); },
               [this](const Notice& notice) { this->announce(notice); }},
      requests_{master.plan(),
                {.session = options_.session, .observe = options_.observe},
                [this](const Request& request) { return master_.submit(request); }},
      transfers_{master.plan(),
                 {.session = options_.session, .observe = options_.observe},
                 master.transfers(),
                 {.submit = [this](const Request& request) { return master_.submit(request); },
                  .state =
                      [this](transfer_state_t state) {
                        publish(channels_.transfer_state, state, clocks_.now());
                      }}},
      outages_{master.plan()},
      wall_minus_monotonic_{clocks_.wall_offset()},
      image_wait_{std::min(most_images * master.plan().cycle.period, longest_wait)},
      gap_{master.plan().cycle.period},
      instance_{random_number()} {
  if (options_.typed) typed_.emplace(master.plan(), options_.session);
  master_.status(snapshot_);
}

std::int64_t Bridge::wall_microseconds(Time monotonic) const noexcept {
  return (monotonic + wall_minus_monotonic_) / std::chrono::microseconds{1};
}

void Bridge::notice_gap() {
  const Time now = clocks_.now();
  if (!gap_.ran(now)) return;
  skip_images_ = true;
  first_cycle_ = not_yet;
  ++gaps_;
  if (!gap_.discards_requests(now)) return;
  ++long_gaps_;
  warn("front_gap", fmt::format("taktd's front thread did not run for {} ms: taktd discards the "
                                "commands and requests that waited in this time",
                                gap_.length() / std::chrono::milliseconds{1}));
}

std::uint64_t Bridge::cycle_at(Time now) const noexcept {
  const Time period = master_.plan().cycle.period;
  if (images_ == 0 || period <= Time{0} || now <= sync_time_) return cycle_;
  return cycle_ + static_cast<std::uint64_t>((now - sync_time_) / period);
}

bool Bridge::serve() {
  notice_gap();
  const bool some = publish_images();
  serve_motions();
  notice_gap();
  take_messages();
  serve_requests();
  take_events();
  publish_states(some);
  notice_gap();  // the thread may not have run for a while since it looked for messages
  gap_.sleeps_until(first_state().next);
  return some;
}

Time Bridge::next_message() const noexcept {
  if (has_unsent_reports() || transfers_left_) return Time{};
  return first_state().next + image_wait_;
}

const Bridge::PeriodicState& Bridge::first_state() const noexcept {
  return *std::ranges::min_element(states_, {}, &PeriodicState::next);
}

/// Images have precedence: a state that goes out just before an image would delay it. Therefore one
/// state follows this image, and the other states follow the next images.
void Bridge::publish_states(bool after_image) {
  const Time now = clocks_.now();
  const auto publish = [&](PeriodicState& state) {
    state.next = now + state.period;
    (this->*state.publish)(now);
  };
  if (after_image) {
    PeriodicState& first = *std::ranges::min_element(states_, {}, &PeriodicState::next);
    if (now >= first.next) publish(first);
    return;
  }
  for (PeriodicState& state : states_) {
    if (now >= state.next + image_wait_) publish(state);
  }
}

bool Bridge::publish_images() {
  ImageView image;
  bool some = false;
  unsigned behind = 0;
  if (std::exchange(skip_images_, false) && master_.take_newest(image)) {
    wall_minus_monotonic_ = clocks_.wall_offset();
    publish_image(image, true);
    some = true;
  }
  while (master_.take(image)) {
    if (!some) wall_minus_monotonic_ = clocks_.wall_offset();
    publish_image(image, behind++ < most_behind);
    some = true;
  }
  return some;
}

void Bridge::publish_image(const ImageView& image, bool typed) {
  for (const image_t& part : image_messages_.fill(image, wall_minus_monotonic_)) {
    publish(channels_.image, part);
  }
  if (typed_ && typed) typed_->publish(image, wall_minus_monotonic_, transport_);
  sync_to_lcm_.record(clocks_.now() - image.sync_time);
  cycle_ = image.cycle;
  sync_time_ = image.sync_time;
  if (first_cycle_ == not_yet && sync_time_ >= gap_.end()) first_cycle_ = cycle_;
  if (guest_ != nullptr) guest_->see(image);
  marks_.assign(image.pdos.begin(), image.pdos.end());
  ++images_;
}

void Bridge::publish_outputs() {
  // Uses the time at which the age was checked, because this thread may not have run since then.
  if (std::exchange(outputs_staged_, false)) master_.publish_outputs(judged_);
}

/// Copies the status if the bus thread has renewed it since the last call.
void Bridge::read_status() {
  const std::uint64_t version = master_.status_version();
  if (std::exchange(status_version_, version) != version) master_.status(snapshot_);
}

void Bridge::take_messages() {
  read_status();
  transport_.serve([this](std::string_view channel, Bytes data) { on_message(channel, data); });
  if (transport_.drained()) gap_.found_empty();
  publish_outputs();
}

void Bridge::on_message(std::string_view channel, Bytes data) {
  if (channel == channels_.command) on_command(data);
  if (channel == channels_.motion_command) on_motion<motion_command_t>(channel, data);
  if (channel == channels_.motion_gear) on_motion<motion_gear_t>(channel, data);
  if (channel == channels_.motion_stream) on_motion<motion_stream_t>(channel, data);
  if (channel == channels_.request) on_request(data);
  if (channel == channels_.transfer) on_transfer(data);
  if (typed_) on_typed(channel, data);
}

void Bridge::on_typed(std::string_view channel, Bytes data) {
  const auto command = typed_->command(channel, data);
  if (!command) return;
  if (!*command) return report_damaged(std::string{channel}, command->error());
  take_command(**command, typed_->node_of(channel));
}

void Bridge::take_command(const command_t& command, std::optional<std::size_t> only_node) {
  const Time now = clocks_.now();
  if (waited(command.cycle, now)) return commands_.discard();
  take_at(command, now, only_node);
}

bool Bridge::waited(std::int64_t cycle, Time now) const noexcept {
  if (gap_.discards_commands(now)) return true;
  return cycle >= 1 && static_cast<std::uint64_t>(cycle) < first_cycle_;
}

bool Bridge::take_at(const command_t& command, Time now, std::optional<std::size_t> only_node) {
  if (!outputs_staged_) judged_ = now;
  const CommandContext context = context_at(now, only_node);
  const bool taken = commands_.take(command, context);
  if (command.release != 0) tell_released(context);
  return taken;
}

CommandContext Bridge::context_at(Time now, std::optional<std::size_t> only_node) const noexcept {
  return {.cycle = cycle_at(now), .now = now, .nodes = snapshot_.nodes, .only_node = only_node};
}

void Bridge::on_command(Bytes data) {
  const auto command = decode<command_t>(data);
  if (!command) return report_damaged(channels_.command, command.error());
  take_command(*command);
}

bool Bridge::command(const std::string& sender, std::span<const SignalIndex> signals,
                     std::span<const std::int64_t> values) {
  command_t command{};
  command.schema = message_schema;
  command.session = options_.session;
  command.instance = instance_;
  command.sender = sender;
  notice_gap();  // the thread may not have run for a while since it looked for this line
  const Time now = clocks_.now();
  command.num_values = static_cast<std::int32_t>(signals.size());
  for (const SignalIndex signal : signals) {
    command.signals.push_back(static_cast<std::int32_t>(signal));
  }
  command.values.assign(values.begin(), values.end());
  if (gap_.discards_commands(now)) {
    commands_.discard();
    return false;
  }
  // The cycle by the clock goes back by one if an image comes late, but the cycles of commands must
  // never go back.
  const std::uint64_t cycle = cycle_at(now);
  own_cycle_ = std::clamp(own_cycle_, cycle, cycle + 1);
  command.cycle = static_cast<std::int64_t>(own_cycle_);
  const bool taken = take_at(command, now);
  publish_outputs();
  return taken;
}

/// Publishes the speed axes before the layout, so that a program that has the layout has both.
void Bridge::publish_layout(Time now) {
  for (speed_axes_t& part : speed_messages_) publish(channels_.speed_axes, part, now);
  for (layout_t& part : layout_messages_) publish(channels_.layout, part, now);
}

void Bridge::publish_status(Time now) {
  GatewayStatus gateway{.image_overruns = master_.image_overruns(),
                        .event_overruns = events_lost(),
                        .commands_taken = commands_.taken(),
                        .commands_refused = commands_.refused(),
                        .holders = {},
                        .emcys = &emcy_log_,
                        .stop_text = stop_text_};
  for (std::size_t i = 0; i < master_.plan().nodes.size(); ++i) {
    gateway.holders.emplace_back(commands_.holder(i, cycle_at(now)));
  }
  for (status_t& part : status_messages_.fill(snapshot_, gateway, now)) {
    publish(channels_.status, part, now);
  }
  publish(channels_.sync, sync_message(master_.plan(), snapshot_.bus), now);
}

void Bridge::publish_pdos(Time now) {
  for (pdo_status_t& part : pdo_messages(master_.plan(), snapshot_, marks_, cycle_)) {
    publish(channels_.pdos, part, now);
  }
}

void Bridge::publish_timing(Time now) {
  publish(channels_.timing, timing_messages_.fill(master_.timing(), sync_to_lcm_, cycle_), now);
}

}  // namespace takt
