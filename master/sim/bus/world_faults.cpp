#include <algorithm>

#include "eds_parser/values/little_endian.hpp"
#include "master/sim/bus/hosted_device.hpp"
#include "master/sim/bus/world.hpp"

namespace takt::sim {
namespace {

/// A fault of a device that has no values: a flag switches it on and off.
struct FlagFault {
  FaultKind kind;
  bool DeviceFaults::* flag;
};

constexpr FlagFault flag_faults[] = {
    {FaultKind::mute_pdo, &DeviceFaults::mute_pdo},
    {FaultKind::no_bootup, &DeviceFaults::no_bootup},
    {FaultKind::no_heartbeat, &DeviceFaults::no_heartbeat},
    {FaultKind::self_start, &DeviceFaults::self_start},
    {FaultKind::no_start, &DeviceFaults::no_start},
    {FaultKind::preop_only, &DeviceFaults::preop_only},
    {FaultKind::fixed_mapping, &DeviceFaults::fixed_mapping},
};

void override_value(HostedDevice& hosted, const Fault& fault, bool begins) {
  Object* object = fault.object ? hosted.device.objects().find(*fault.object) : nullptr;
  if (object == nullptr) return;
  if (!begins) {
    for (const Object& before : hosted.overridden) {
      if (before.key == object->key) *object = before;
    }
    return;
  }
  hosted.overridden.push_back(*object);
  if (object->is_bytes()) {
    object->bytes = object->power_on_bytes = object->factory_bytes = fault.value;
  } else {
    object->set(from_little_endian(fault.value));
    object->power_on = object->factory = object->value;
  }
}

DeviceFaults::Answer answer_of(FaultKind kind) noexcept {
  using enum DeviceFaults::Answer;
  switch (kind) {
    case FaultKind::refuse_object:
      return refuse;
    case FaultKind::refuse_write:
      return refuse_write;
    case FaultKind::ignore_write:
      return ignore_write;
    default:
      return mute;
  }
}

void set_access(DeviceFaults& faults, const Fault& fault, bool begins) {
  if (!fault.object) return;
  faults.remove(*fault.object);
  if (begins) {
    faults.add({*fault.object, answer_of(fault.kind), static_cast<Abort>(fault.abort_code)});
  }
}

SenderFaults changed(SenderFaults old, const Fault& fault, bool begins) {
  const double probability = begins ? fault.probability : 0.0;
  switch (fault.kind) {
    case FaultKind::loss:
      old.loss = probability;
      break;
    case FaultKind::duplicate:
      old.duplicate = probability;
      break;
    case FaultKind::error_frames:
      old.error = probability;
      break;
    default:
      old.delay = begins ? fault.time : Time{};
      break;
  }
  return old;
}

}  // namespace

void World::apply(const Fault& fault, bool begins) {
  switch (fault.kind) {
    case FaultKind::loss:
    case FaultKind::duplicate:
    case FaultKind::delay:
    case FaultKind::error_frames:
      return apply_to_wire(fault, begins);
    case FaultKind::babble:
      return set_babble(fault, begins);
    case FaultKind::stall_master:
    case FaultKind::interface_down:
      return apply_to_ports(fault, begins);
    case FaultKind::bus_off:
      if (!fault.node) return apply_to_ports(fault, begins);
      break;
    default:
      break;
  }
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (fault.node && devices_[i]->device.node() != *fault.node) continue;
    apply_to_device(i, fault, begins);
    if (devices_[i]->device.state() != DeviceState::off) after_call(i);
  }
  report_bus_changes();
}

void World::apply_to_wire(const Fault& fault, bool begins) noexcept {
  for (BusNodeIndex i = 0; i < bus_.size(); ++i) {
    if (fault.node && node_of(i) != fault.node->value()) continue;
    bus_.node(i).faults = changed(bus_.node(i).faults, fault, begins);
  }
}

void World::set_babble(const Fault& fault, bool begins) noexcept {
  bus_.set_powered(babbler_, begins, now_);
  next_babble_ = begins ? now_ : never;
  babble_period_ = fault.time;
  babble_ = {.id = fault.cob_id};
  for (const std::byte byte : fault.value) {
    if (babble_.length == 8) break;
    babble_.data[babble_.length++] = std::to_integer<std::uint8_t>(byte);
  }
  timers_.set(devices_.size(), next_babble_);
}

void World::babble_again() noexcept {
  bus_.queue(babbler_, babble_, now_);
  timers_.set(devices_.size(), babble_period_ == Time{} ? never : now_ + babble_period_);
}

void World::apply_to_ports(const Fault& fault, bool begins) noexcept {
  for (const auto& port : ports_) {
    if (fault.kind == FaultKind::stall_master && begins) port->stall(fault.at, fault.until);
    if (fault.kind == FaultKind::interface_down) port->set_interface_down(begins, now_);
    if (fault.kind == FaultKind::bus_off && begins) bus_.set_bus_off(port->node(), now_);
  }
}

void World::apply_to_device(std::size_t index, const Fault& fault, bool begins) {
  HostedDevice& hosted = *devices_[index];
  Device& device = hosted.device;
  DeviceFaults& faults = device.faults();
  const Time local = hosted.clock.local(now_);
  for (const auto& [kind, flag] : flag_faults) {
    if (kind == fault.kind) faults.*flag = begins;
  }
  switch (fault.kind) {
    case FaultKind::power_off:
      return set_power(index, !begins);
    case FaultKind::drift:
      return hosted.clock.set_drift(begins ? fault.ppm : 0, now_);
    case FaultKind::mute_sdo:
      if (!fault.object) faults.mute_sdo = begins;
      return set_access(faults, fault, begins);
    case FaultKind::slow_sdo:
      faults.sdo_delay = begins ? fault.time : Time{};
      return;
    case FaultKind::refuse_object:
    case FaultKind::refuse_write:
    case FaultKind::ignore_write:
      return set_access(faults, fault, begins);
    case FaultKind::override_value:
      override_value(hosted, fault, begins);
      return device.look_at_records();
    case FaultKind::late_bootup:
      faults.bootup_delay = begins ? fault.time : Time{};
      return;
    case FaultKind::no_guarding:
      faults.guarding = begins ? GuardingResponder::Fault::mute : GuardingResponder::Fault::none;
      return;
    case FaultKind::stuck_toggle:
      faults.guarding =
          begins ? GuardingResponder::Fault::stuck_toggle : GuardingResponder::Fault::none;
      return;
    case FaultKind::bootup_storm:
      faults.storm_period =
          begins ? std::max(fault.time, Time{std::chrono::microseconds{100}}) : Time{};
      return device.start_storm(local);
    case FaultKind::lss_silent:
    case FaultKind::lss_no_store:
      if (LssSlave* const lss = device.lss()) {
        (fault.kind == FaultKind::lss_silent ? lss->faults().silent : lss->faults().refuses_store) =
            begins;
      }
      return;
    case FaultKind::device_error:
      if (begins) device.fail(fault.emcy_code, local);
      return;
    case FaultKind::reset:
      if (begins) device.reset_node(local);
      return;
    case FaultKind::bus_off:
      if (begins) bus_.set_bus_off(static_cast<BusNodeIndex>(index), now_);
      return;
    default:
      return;
  }
}

}  // namespace takt::sim
