#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "master/attach.hpp"
#include "master/master_run.hpp"
#include "master/sim/bus/sim_port.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::test {

/// A device whose TPDO1 returns the data of its RPDO1: 6040 and 607A. The PDOs are valid from the
/// start.
inline DeviceTable loopback_device(NodeId node, const PdoRow& tpdo, const PdoRow& rpdo) {
  using enum DataType;
  sim::SampleDevice device = sim::communicating(node);
  device.object(0x6040, 0, unsigned16, Access::rww, 0, true)
      .object(0x607A, 0, integer32, Access::rww, 0, true)
      .text(0x2020, 0, "", Access::rw);  // a domain
  const std::vector<std::uint32_t> mapping{0x6040'0010, 0x607A'0020};
  device.pdo(0x1400, rpdo.cob_id.id(), rpdo.transmission, mapping);
  device.pdo(0x1800, tpdo.cob_id.id(), tpdo.transmission, mapping);
  return device.build();
}

inline BootStep boot_step(BootAction action, Time timeout = std::chrono::milliseconds{200}) {
  return {.action = action,
          .object = {},
          .value = {},
          .timeout = timeout,
          .purpose = {},
          .eds_note = {}};
}

/// A short boot: reset, boot-up, device type, heartbeat of 20 ms, start.
inline BootPlan short_boot() {
  BootPlan plan;
  plan.steps.push_back(boot_step(BootAction::nmt));
  plan.steps.back().command = NmtCommand::reset_communication;
  plan.steps.push_back(boot_step(BootAction::await_bootup, std::chrono::milliseconds{500}));
  plan.steps.push_back(boot_step(BootAction::expect));
  plan.steps.back().object = {0x1000, 0};
  plan.steps.back().value = sim::little_endian(0x0002'0192, 4);
  plan.steps.push_back(boot_step(BootAction::write));
  plan.steps.back().object = {0x1017, 0};
  plan.steps.back().value = sim::little_endian(20, 2);
  plan.steps.push_back(boot_step(BootAction::nmt));
  plan.steps.back().command = NmtCommand::start;
  plan.steps.push_back(boot_step(BootAction::await_operational));
  return plan;
}

/// Records everything on the wire.
class Recorder final : public sim::BusObserver {
 public:
  void on_wire(const sim::WireFrame& frame) noexcept override {
    if (keep) frames.push_back(frame);
  }
  std::vector<sim::WireFrame> with(std::uint32_t id) const {
    std::vector<sim::WireFrame> found;
    std::ranges::copy_if(frames, std::back_inserter(found), [&](const sim::WireFrame& wire) {
      return wire.frame.id.id() == id && wire.result == sim::WireResult::sent;
    });
    return found;
  }

  std::vector<sim::WireFrame> frames;
  bool keep = true;
};

struct RigOptions {
  std::vector<DeviceTable> devices{};  ///< empty means loopback devices
  Time heartbeat_timeout = std::chrono::milliseconds{60};
  sim::WorldOptions world{};
  sim::RemotePortOptions port{};
  MasterRunOptions master{};
};

/// A complete master on the simulated bus, in virtual time.
class Rig {
 public:
  explicit Rig(BusPlan plan, RigOptions options = {}) {
    std::vector<DeviceTable> devices = options.devices;
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      NodePlan& node = plan.nodes[i];
      node.boot_plan = short_boot();
      read_limits(plan, i);
      node.heartbeat_timeout = options.heartbeat_timeout;
      node.reboot_delay = std::chrono::milliseconds{100};
      node.sdo_timeout = std::chrono::milliseconds{100};
      if (!options.devices.empty()) continue;
      devices.push_back(loopback_device(node.id, plan.pdos.tpdos[i], plan.pdos.rpdos[i]));
    }
    axes_ = plan.nodes.size();
    world = std::make_unique<sim::World>(devices, options.world);
    world->observe(&recorder);
    port = std::make_unique<sim::SimPort>(*world, options.port);
    master = std::make_unique<MasterRun>(std::move(plan), options.master);
    master->attach(*port);
    master->begin();
  }
  /// Attaches the master to another port; `other` forwards to `*port`.
  template <class P>
  void use(P& other) {
    master->attach(other);
    master->begin();
  }

  /// Runs one cycle, and then does the work of the front thread.
  void cycle() {
    master->cycle();
    for (Event event; master->take(event);) events.push_back(event);
    ImageView image;
    while (master->take(image)) {
      if (on_image) on_image(image);
      last_image.assign(image.values.begin(), image.values.end());
      last_stale.assign(image.stale_bits.begin(), image.stale_bits.end());
      last = image;
    }
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) cycle();
  }
  /// Runs until all nodes exchange PDOs. Returns false if this takes more than 2000 cycles.
  bool boot() {
    for (int i = 0; i < 2000; ++i) {
      cycle();
      if (all_ready()) return true;
    }
    return false;
  }
  bool all_ready() {
    StatusSnapshot snapshot;
    master->status(snapshot);
    return std::ranges::all_of(snapshot.nodes, [](const NodeStatus& node) {
      return node.boot == BootState::ready && node.nmt == NmtState::operational;
    });
  }
  BusStatus status() {
    StatusSnapshot snapshot;
    master->status(snapshot);
    return snapshot.bus;
  }
  NodeStatus node(std::size_t index) {
    StatusSnapshot snapshot;
    master->status(snapshot);
    return snapshot.nodes[index];
  }

  void command(std::size_t axis, std::int64_t controlword, std::int64_t target,
               std::uint32_t ttl = 0) {
    master->set(static_cast<SignalIndex>(2 * axes_ + axis), controlword, ttl);
    master->set(static_cast<SignalIndex>(3 * axes_ + axis), target, ttl);
    master->publish_outputs(world->now());
  }
  void command_all(std::int64_t controlword, std::int64_t target, std::uint32_t ttl = 0) {
    for (std::size_t axis = 0; axis < axes_; ++axis) command(axis, controlword, target, ttl);
  }
  long count(EventKind kind) const { return std::ranges::count(events, kind, &Event::kind); }
  bool stale(std::size_t signal) const {
    return ((last_stale[signal / 64] >> (signal % 64)) & 1) != 0;
  }

  Recorder recorder;
  std::unique_ptr<sim::World> world;
  std::unique_ptr<sim::SimPort> port;
  std::unique_ptr<MasterRun> master;
  std::function<void(const ImageView&)> on_image;
  std::vector<Event> events;
  std::vector<std::int64_t> last_image;
  std::vector<std::uint64_t> last_stale;
  ImageView last;

 private:
  /// Adds the steps that read the limits before the start, as the compiler of boots does.
  static void read_limits(BusPlan& plan, std::size_t node_index) {
    auto& steps = plan.nodes[node_index].boot_plan.steps;
    const auto read = [&](ObjectKey object) {
      BootStep step = boot_step(BootAction::read_limit);
      step.object = object;
      steps.insert(steps.end() - 2, step);
    };
    for (const DeviceLimit& limit : plan.limits.device) {
      if (limit.node_index != node_index) continue;
      read(limit.object);
      if (limit.bound == DeviceBound::range) read(upper_object(limit));
    }
  }

  std::size_t axes_ = 0;
};

}  // namespace takt::test
