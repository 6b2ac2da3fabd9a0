#include "master/sim/device/device.hpp"

#include <algorithm>

namespace takt::sim {
namespace {

constexpr std::uint16_t pdos_a_direction = 512;
constexpr std::uint16_t sdo_servers = 128;
constexpr Time fast_tick = std::chrono::milliseconds{1};   // period for event-driven TPDOs
constexpr Time slow_tick = std::chrono::milliseconds{10};  // between updates of a model

/// Returns true if the frame belongs to the exchange of process data, which changes no deadline of
/// a service.
bool is_exchange(const Route& route, const Frame& frame) noexcept {
  return !frame.rtr && (route.kind == RouteKind::sync || route.kind == RouteKind::rpdo);
}

}  // namespace

Device::Device(const DeviceTable& table, Random random, DeviceTimes times)
    : node_{table.node},
      address_{table.node},
      times_{times},
      delays_{random.fork(1)},
      dummy_usage_{table.dummy_usage},
      store_{table},
      emcy_{store_, table.node},
      sync_{store_, emcy_},
      sync_producer_{store_},
      time_{store_},
      heartbeat_{store_, table.node},
      watch_{store_, emcy_},
      guarding_{store_, emcy_, table.node},
      storage_{store_},
      program_{store_},
      multiplexed_{store_, table.node} {
  for (std::uint16_t n = 1; n <= pdos_a_direction; ++n) {
    if (PdoRecord::exists(store_, PdoDirection::transmit, n)) {
      tpdos_.emplace_back(PdoRecord{store_, PdoDirection::transmit, n});
    }
    if (PdoRecord::exists(store_, PdoDirection::receive, n)) {
      rpdos_.emplace_back(PdoRecord{store_, PdoDirection::receive, n});
    }
  }
  live_tpdos_.reserve(tpdos_.size());
  live_rpdos_.reserve(rpdos_.size());
  const auto has_quirk = [&table](std::string_view quirk) {
    return std::ranges::find(table.quirks, quirk) != table.quirks.end();
  };
  if (has_quirk("lss") || has_quirk("no_node_id")) {
    lss_.emplace(store_, has_quirk("no_node_id") ? LssSlave::none : node_.value());
  }
  for (std::uint16_t n = 0; n < sdo_servers && (n == 0 || store_.has_index(0x1200u + n)); ++n) {
    Dictionary& dictionary = *this;
    sdo_.emplace_back(dictionary, node_, faults_.sdo).set_times(times_.sdo, times_.segment);
  }
  routes_.reserve(5 + sdo_.size() + watch_.watches().size() + tpdos_.size() + rpdos_.size());
  model_ = make_model(table, store_, emcy_, random);
  const DeviceTraits traits = model_->traits();
  for (Tpdo& tpdo : tpdos_) tpdo.set_traits(traits);
  sync_.set_may_produce(traits.produces_sync);
  answers_rpdos_ = traits.answers_255;
}

Device::~Device() = default;

void Device::power_on(Time now) noexcept {
  if (state_ != DeviceState::off) return;
  if (lss_) lss_->power_on();
  reset_node(now);
}

void Device::power_off() noexcept {
  stop_pdos();
  heartbeat_.stop();
  for (SdoServer& server : sdo_) server.reset();
  watch_.forget();
  guarding_.reset();
  sync_.reset();
  sync_producer_.stop();
  time_.reset();
  state_ = DeviceState::off;
  boots_at_ = next_storm_ = tick_ = deadline_ = service_deadline_ = never;
  routes_.clear();
  routes_changed_ = true;
}

void Device::reset_node(Time now) noexcept {
  begin_reset(times_.startup, now);
  store_.reset(0x2000, 0x9FFF);
  model_->reset(now);
  finish_call(now);
}

void Device::reset_communication(Time now) noexcept {
  if (state_ == DeviceState::operational) model_->connection_lost(now);
  begin_reset(times_.communication_reset, now);
}

void Device::begin_reset(Time startup, Time now) noexcept {
  stop_pdos();
  state_ = DeviceState::initialising;
  heartbeat_.stop();
  for (SdoServer& server : sdo_) server.reset();
  sync_.reset();
  sync_producer_.stop();
  take_address();
  store_.reset(0x1000, 0x1FFF);
  emcy_.reset();
  watch_.forget();
  watch_.configure();
  guarding_.reset();
  tick_ = next_storm_ = never;
  boots_at_ = now + startup + faults_.bootup_delay;
  routes_.clear();
  routes_changed_ = true;
}

/// Ends Initialising: sends the boot-up message and enters PRE-OPERATIONAL. CiA 301, 7.3.2.2.
void Device::boot(Time now) noexcept {
  boots_at_ = never;
  if (speaks_only_lss()) return build_routes();
  send_bootup(now);
  state_ = DeviceState::preoperational;
  heartbeat_.start(now);
  sync_producer_.start(now);
  build_routes();
  if (faults_.storm_period > Time{}) next_storm_ = now + faults_.storm_period;
  if (faults_.self_start) enter(DeviceState::operational, now);
}

void Device::start_storm(Time now) noexcept {
  if (state_ == DeviceState::off || boots_at_ != never) return;
  next_storm_ = faults_.storm_period > Time{} ? now : never;
  finish_call(now);
}

void Device::send_bootup(Time now) noexcept {
  if (!faults_.no_bootup) out_.send(make_frame(CobId::base(0x700u + address_.value()), {0}), now);
}

bool Device::on_frame(const Frame& frame, Time now) noexcept {
  const std::span<const Route> found = routes_.of(frame.id);
  if (found.empty()) return false;
  if (found.size() > 1) return share(found, frame, now);
  const Route route = found.front();  // a copy, because a handler may rebuild the routes
  if (keep_until_sync(route, frame, now)) return false;
  dispatch(route, frame, now);
  is_exchange(route, frame) ? finish_exchange(now) : finish_call(now);
  return true;
}

/// Gives the frame to several services.
bool Device::share(std::span<const Route> routes, const Frame& frame, Time now) noexcept {
  std::array<Route, 8> taken;  // copies, because a handler may rebuild the routes
  const std::size_t count = std::min(routes.size(), taken.size());
  std::copy_n(routes.begin(), count, taken.begin());
  bool exchange = true;
  for (std::size_t i = 0; i < count; ++i) {
    exchange = exchange && is_exchange(taken[i], frame);
    dispatch(taken[i], frame, now);
  }
  exchange ? finish_exchange(now) : finish_call(now);
  return true;
}

void Device::dispatch(const Route& route, const Frame& frame, Time now) noexcept {
  if (frame.rtr) return on_request(route, now);
  switch (route.kind) {
    case RouteKind::nmt:
      return on_nmt(frame, now);
    case RouteKind::sync:
      if (communicates()) on_sync(frame, now);
      return;
    case RouteKind::sdo:
      return ask(sdo_[route.index], frame, now);
    case RouteKind::rpdo:
      return on_rpdo(rpdos_[route.index], frame, now);
    case RouteKind::heartbeat:
      if (communicates() && frame.length == 1) {
        watch_.on_heartbeat(static_cast<std::uint8_t>(frame.id.id() & 0x7F), frame.data[0], now);
      }
      return;
    case RouteKind::lss:
      return on_lss(frame, now);
    case RouteKind::time:
      if (communicates()) time_.on_frame(frame, now);
      return;
    case RouteKind::tpdo_request:
    case RouteKind::guarding:
      return;
  }
}

/// Handles a remote frame.
void Device::on_request(const Route& route, Time now) noexcept {
  if (route.kind == RouteKind::tpdo_request && !faults_.mute_pdo) {
    model_->advance(now);
    tpdos_[route.index].on_request(now + times_.pdo, out_);
  }
  if (route.kind == RouteKind::guarding) {
    guarding_.on_request(static_cast<std::uint8_t>(state_), faults_.guarding, now, out_);
  }
}

void Device::on_nmt(const Frame& frame, Time now) noexcept {
  if (frame.length != 2 || (lss_ && lss_->switching())) return;
  const bool for_it = frame.data[1] == address_.value() && !speaks_only_lss();
  if (frame.data[1] != 0 && !for_it) return;
  if (speaks_only_lss() && frame.data[0] < 129) return;
  switch (frame.data[0]) {
    case 1:
      if (!faults_.no_start) enter(DeviceState::operational, now);
      return;
    case 2:
      return enter(DeviceState::stopped, now);
    case 128:
      return enter(DeviceState::preoperational, now);
    case 129:
      return reset_node(now);
    case 130:
      return reset_communication(now);
    default:
      return;
  }
}

void Device::enter(DeviceState state, Time now) noexcept {
  if (state_ == state) return;
  const DeviceState old = std::exchange(state_, state);
  if (old == DeviceState::operational) {
    stop_pdos();
    sync_.reset();  // outside OPERATIONAL the device does not report a missing SYNC
    model_->advance(now);
    model_->connection_lost(now);
  }
  if (state == DeviceState::operational) start_pdos(now);
  if (state == DeviceState::stopped) {
    for (SdoServer& server : sdo_) server.reset();
    sync_.reset();
    sync_producer_.stop();
    watch_.forget();
  }
  if (old == DeviceState::stopped) sync_producer_.start(now);
}

void Device::on_time(Time now) noexcept {
  if (lss_) lss_->on_time(now);
  if (now >= boots_at_) boot(now);
  if (now >= next_storm_) {
    send_bootup(now);
    next_storm_ = faults_.storm_period > Time{} ? now + faults_.storm_period : never;
  }
  if (now >= tick_) look_at_inputs(now);
  heartbeat_.on_time(now, static_cast<std::uint8_t>(state_), faults_.no_heartbeat, out_);
  if (communicates()) {
    if (watch_.on_time(now) || guarding_.on_time(now)) communication_error(now);
    make_sync(now);
    if (sync_.on_time(now)) model_->sync_lost(now);
    program_.on_time(now);
    for (SdoServer& server : sdo_) {
      if (now >= server.deadline()) server.on_time(now, out_);
    }
  }
  if (state_ == DeviceState::operational) {
    for (Rpdo* const rpdo : live_rpdos_) rpdo->on_time(now, emcy_);
    run_tpdos(now);
  }
  finish_call(now);
}

/// Reacts to a communication error as 0x1029:01 says. CiA 301, 7.5.2.32.
void Device::communication_error(Time now) noexcept {
  model_->advance(now);
  model_->connection_lost(now);
  switch (store_.number({0x1029, 1}, 0)) {
    case 0:
      if (state_ == DeviceState::operational) enter(DeviceState::preoperational, now);
      return;
    case 2:
      return enter(DeviceState::stopped, now);
    default:
      return;
  }
}

void Device::on_bus_off(Time now) noexcept {
  if (!communicates()) return;
  communication_error(now);
  finish_call(now);
}

void Device::on_bus_recovered(Time now) noexcept {
  emcy_.announce(0x8140);
  finish_call(now);
}

void Device::fail(std::uint16_t emcy_code, Time now) noexcept {
  if (state_ == DeviceState::off) return;
  model_->advance(now);
  model_->fail(emcy_code, now);
  look_at_inputs(now);
  finish_call(now);
}

/// Ends every call: sends waiting EMCYs and computes the next deadline.
void Device::finish_call(Time now) noexcept {
  service_deadline_ = std::min({boots_at_, next_storm_, heartbeat_.deadline()});
  if (lss_) service_deadline_ = std::min(service_deadline_, lss_->deadline());
  if (communicates()) {
    service_deadline_ = std::min({service_deadline_, watch_.deadline(), guarding_.deadline(),
                                  program_.deadline(), sync_producer_.deadline()});
    for (const SdoServer& server : sdo_) {
      service_deadline_ = std::min(service_deadline_, server.deadline());
    }
  }
  finish_exchange(now);
}

/// Ends a call that has processed only SYNC and RPDOs, which do not change the deadlines of
/// services.
void Device::finish_exchange(Time now) noexcept {
  emcy_.on_time(now, communicates(), out_);
  if (lss_ && lss_->switching()) out_.clear();
  deadline_ = service_deadline_;
  if (!communicates()) {
    tick_ = never;
    return;
  }
  plan_tick();
  deadline_ = std::min({deadline_, tick_, sync_.deadline(), emcy_.deadline()});
  if (state_ != DeviceState::operational) return;
  for (const Rpdo* const rpdo : live_rpdos_) deadline_ = std::min(deadline_, rpdo->deadline());
  for (const Tpdo* const tpdo : live_tpdos_) deadline_ = std::min(deadline_, tpdo->deadline());
}

void Device::plan_tick() noexcept {
  const Time change = model_->next_change();
  if (change == never) {
    tick_ = never;
    return;
  }
  const bool events =
      multiplexed_.wants_events() || std::ranges::any_of(live_tpdos_, &Tpdo::wants_events);
  tick_ = std::max(change, last_look_ + (events ? fast_tick : slow_tick));
}

void Device::ask(SdoServer& server, const Frame& frame, Time now) noexcept {
  if (!communicates() || faults_.mute_sdo) return;
  const auto delay = static_cast<std::uint64_t>(faults_.sdo_delay.count());
  const Time late{delay == 0 ? 0 : static_cast<Time::rep>(delays_.next() % delay)};
  server.set_times(times_.sdo + late, times_.segment);
  server.on_frame(frame, now, out_);
}

}  // namespace takt::sim
