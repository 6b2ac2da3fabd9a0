#include "master/sim/service/device_heartbeat.hpp"

#include <algorithm>

namespace takt::sim {
namespace {

constexpr std::uint16_t heartbeat_lost = 0x8130;

constexpr std::uint8_t node_of(std::uint64_t entry) noexcept {
  const auto node = static_cast<std::uint8_t>(entry >> 16);
  return (entry & 0xFFFF) == 0 || node > 127 ? 0 : node;
}

}  // namespace

void HeartbeatProducer::start(Time now) noexcept {
  const std::uint64_t period = period_ == nullptr ? 0 : period_->value;
  next_ = period == 0 ? never : now + std::chrono::milliseconds{period};
}

void HeartbeatProducer::on_time(Time now, std::uint8_t state, bool mute,
                                Transmitter& out) noexcept {
  if (now < next_) return;
  if (!mute) out.send(make_frame(CobId::base(0x700u + node_.value()), {state}), now);
  const Time period = std::chrono::milliseconds{period_->value};
  next_ = period == Time{} ? never : std::max(next_ + period, now + Time{1});
}

HeartbeatConsumer::HeartbeatConsumer(ObjectStore& store, EmcyProducer& emcy) : emcy_{emcy} {
  for (const Object& object : store.range(0x1016, 0x1016)) {
    if (object.key.sub != 0) watches_.push_back({.entry = &object});
  }
}

void HeartbeatConsumer::configure() noexcept {
  for (Watch& watch : watches_) {
    const std::uint8_t node = node_of(watch.entry->value);
    const Time timeout = std::chrono::milliseconds{watch.entry->value & 0xFFFF};
    if (node == watch.node && timeout == watch.timeout) continue;
    watch = {.entry = watch.entry, .node = node, .timeout = timeout};
  }
  update_deadline();
}

void HeartbeatConsumer::forget() noexcept {
  for (Watch& watch : watches_) watch.deadline = never;
  update_deadline();
}

void HeartbeatConsumer::on_heartbeat(std::uint8_t node, std::uint8_t state, Time now) noexcept {
  for (Watch& watch : watches_) {
    if (watch.node != node) continue;
    const bool bootup = (state & 0x7F) == 0;
    watch.deadline = bootup ? never : now + watch.timeout;
    if (!bootup) emcy_.clear(heartbeat_lost, node);
  }
  update_deadline();
}

bool HeartbeatConsumer::on_time(Time now) noexcept {
  if (now < deadline_) return false;
  bool any = false;
  for (Watch& watch : watches_) {
    if (watch.deadline > now) continue;
    watch.deadline = never;
    any = true;
    emcy_.raise(heartbeat_lost, ErrorBit::communication, {watch.node});
  }
  update_deadline();
  return any;
}

void HeartbeatConsumer::update_deadline() noexcept {
  deadline_ = never;
  for (const Watch& watch : watches_) {
    if (watch.node != 0) deadline_ = std::min(deadline_, watch.deadline);
  }
}

Abort HeartbeatConsumer::check_write(const Object& object, std::uint64_t raw) const noexcept {
  const std::uint8_t node = node_of(raw);
  if (object.key.index != 0x1016 || object.key.sub == 0 || node == 0) return Abort::none;
  for (const Watch& watch : watches_) {
    if (watch.entry != &object && watch.node == node) return Abort::incompatible;
  }
  return Abort::none;
}

}  // namespace takt::sim
