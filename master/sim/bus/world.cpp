#include "master/sim/bus/world.hpp"

#include <algorithm>
#include <bit>
#include <span>

#include "master/sim/bus/hosted_device.hpp"

namespace takt::sim {
namespace {

constexpr std::uint32_t shortest_segment_bits = 112;  // eight data bytes, few stuff bits

/// Returns the fault of this kind with the default values that it has as a quirk of a device.
Fault quirk(FaultKind kind, NodeId node) {
  Fault fault{.kind = kind, .node = node};
  if (kind == FaultKind::late_bootup) fault.time = std::chrono::seconds{2};
  if (kind == FaultKind::bootup_storm) fault.time = std::chrono::milliseconds{20};
  return fault;
}

}  // namespace

World::World(std::span<const DeviceTable> devices, const WorldOptions& options)
    : random_{options.seed},
      first_bitrate_{options.bitrate},
      one_bit_rate_{options.one_bit_rate},
      bus_{options.bitrate, random_.fork(1)},
      timers_{devices.size() + 1},
      schedule_{options.faults} {
  words_ = devices.size() / 64 + 1;
  takers_.assign(2048 * words_, 0);
  for (const DeviceTable& table : devices) {
    // The time between segments is the shortest frame time, so the wire is always slightly slower
    // than the device.
    devices_.push_back(std::make_unique<HostedDevice>(
        table, random_.fork(100 + table.node.value()),
        DeviceTimes{.segment = bus_.bit_time(shortest_segment_bits)}));
    bus_.attach({.order = QueueOrder::priority, .capacity = 576});
  }
  babbler_ = bus_.attach({.order = QueueOrder::fifo, .capacity = 4});
  bus_.set_powered(babbler_, false, Time{});
  bus_.set_analyser(devices.empty());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    for (const std::string& text : devices[i].quirks) {
      if (const auto kind = fault_kind(text)) {
        apply_to_device(i, quirk(*kind, devices[i].node), true);
      }
    }
    bus_.set_powered(static_cast<BusNodeIndex>(i), false, Time{});
    const auto spread = static_cast<std::uint64_t>(options.power_on_spread.count());
    const Time at{spread == 0 ? 0 : static_cast<Time::rep>(random_.next() % spread)};
    timers_.set(i, at);
  }
}

World::~World() = default;

Time World::next_event() const noexcept {
  return std::min({bus_.next_event(), timers_.earliest(), schedule_.next()});
}

void World::advance_to(Time until) noexcept {
  while (step_until(until)) {
  }
}

bool World::advance_until_frame(RemotePort& port, Time until) noexcept {
  while (!port.has_frames()) {
    if (!step_until(until)) return false;
  }
  return true;
}

/// Processes the next event. Returns false if there is none until this time. At equal times, faults
/// come first, then the devices, then the bus, so that a frame offered at this time takes part in
/// the arbitration at this time.
bool World::step_until(Time until) noexcept {
  const Time others = std::min(timers_.earliest(), schedule_.next());
  const Time at = std::min(others, bus_.next_event());
  if (at > until || at == never) {
    now_ = std::max(now_, until);
    return false;
  }
  now_ = std::max(now_, at);
  if (others <= at) {
    act(at);
  } else {
    if (bus_.step(now_)) on_wire_end(bus_.wire());
    report_bus_changes();
  }
  return true;
}

/// Lets the next fault, device or babbler act.
void World::act(Time at) noexcept {
  if (schedule_.next() <= at) {
    const FaultSchedule::Edge edge = schedule_.take();
    apply(schedule_.fault(edge.fault), edge.begins);
  } else if (const std::size_t index = timers_.first(); index == devices_.size()) {
    babble_again();
  } else {
    run_device(index);
  }
}

void World::run_device(std::size_t index) noexcept {
  HostedDevice& hosted = *devices_[index];
  if (hosted.device.state() == DeviceState::off) {
    timers_.set(index, never);
    set_power(index, true);
    return;
  }
  const Time local = hosted.clock.local(now_);
  hosted.device.on_time(local);
  after_call(index);
  if (timers_.earliest() <= now_ && timers_.first() == index) {
    timers_.set(index, now_ + std::chrono::microseconds{1});  // time must advance in each step
  }
}

bool World::fits_bus(const Device& device) const noexcept {
  const std::uint32_t own = device.bit_rate() == 0 ? first_bitrate_ : device.bit_rate() * 1000;
  return !one_bit_rate_ || own == bus_.bitrate();
}

void World::after_call(std::size_t index) noexcept {
  HostedDevice& hosted = *devices_[index];
  Device& device = hosted.device;
  if (!fits_bus(device)) device.out().clear();
  for (const Transmission& item : device.out().pending()) {
    bus_.queue(static_cast<BusNodeIndex>(index), item.frame, hosted.clock.world(item.ready),
               hosted.clock.world(item.expires));
  }
  device.out().clear();
  timers_.set(index, hosted.clock.world(device.deadline()));
  if (device.take_routes_changed()) route(index);
}

void World::route(std::size_t index) noexcept {
  HostedDevice& hosted = *devices_[index];
  const std::uint64_t bit = std::uint64_t{1} << (index % 64);
  const std::size_t word = index / 64;
  for (const CobId id : hosted.ids) takers_[id.id() * words_ + word] &= ~bit;
  hosted.ids.clear();
  hosted.device.visit_ids([&](CobId id) {
    if (id.is_extended()) return;
    hosted.ids.push_back(id);
    takers_[id.id() * words_ + word] |= bit;
  });
}

void World::on_wire_end(const WireFrame& wire) noexcept {
  if (observer_ != nullptr) observer_->on_wire(wire);
  if (wire.result == WireResult::sent) {
    for (const auto& port : ports_) port->on_wire(wire);
    deliver_to_devices(wire);
  }
  if (wire.sender == babbler_ && babble_period_ == Time{} && next_babble_ != never) {
    bus_.queue(babbler_, babble_, now_);
  }
}

void World::deliver_to_devices(const WireFrame& wire) noexcept {
  if (wire.frame.id.is_extended()) {
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      if (i != wire.sender) deliver(i, wire.frame);
    }
    return;
  }
  const std::span takers{takers_.data() + wire.frame.id.id() * words_, words_};
  for (std::size_t word = 0; word < takers.size(); ++word) {
    for (std::uint64_t bits = takers[word]; bits != 0; bits &= bits - 1) {
      const std::size_t index = word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
      if (index != wire.sender) deliver(index, wire.frame);
    }
  }
}

void World::deliver(std::size_t index, const Frame& frame) noexcept {
  HostedDevice& hosted = *devices_[index];
  if (!bus_.node(static_cast<BusNodeIndex>(index)).on_bus()) return;
  if (!fits_bus(hosted.device)) return;
  if (hosted.device.on_frame(frame, hosted.clock.local(now_))) after_call(index);
}

void World::report_bus_changes() noexcept {
  for (BusNodeIndex i = bus_.take_change(); i != VirtualBus::nobody; i = bus_.take_change()) {
    if (i >= devices_.size()) continue;
    HostedDevice& hosted = *devices_[i];
    const Time local = hosted.clock.local(now_);
    if (bus_.node(i).bus_off) {
      hosted.device.on_bus_off(local);
    } else {
      hosted.device.on_bus_recovered(local);
    }
    after_call(i);
  }
}

RemotePort& World::attach(RemotePortOptions options) {
  const BusNodeIndex node = bus_.attach({.order = QueueOrder::fifo,
                                         .capacity = options.tx_queue,
                                         .restart = options.restart,
                                         .relays = options.relays});
  ports_.push_back(std::make_unique<RemotePort>(bus_, node, options, random_.fork(10'000u + node)));
  return *ports_.back();
}

Device* World::device(NodeId node) noexcept {
  for (const auto& hosted : devices_) {
    if (hosted->device.node() == node) return &hosted->device;
  }
  return nullptr;
}

std::uint8_t World::node_of(BusNodeIndex sender) const noexcept {
  return sender < devices_.size() ? devices_[sender]->device.node().value() : 0;
}

void World::power(NodeId node, bool on) noexcept {
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (devices_[i]->device.node() == node) set_power(i, on);
  }
}

void World::set_power(std::size_t index, bool on) noexcept {
  HostedDevice& hosted = *devices_[index];
  bus_.set_powered(static_cast<BusNodeIndex>(index), on, now_);
  if (on) {
    hosted.device.power_on(hosted.clock.local(now_));
  } else {
    hosted.device.power_off();
  }
  after_call(index);
}

void World::add(const Fault& fault) { schedule_.add(fault); }

}  // namespace takt::sim
