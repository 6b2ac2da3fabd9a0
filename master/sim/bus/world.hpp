#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "eds_parser/table/device_table.hpp"
#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/bus/fault_schedule.hpp"
#include "master/sim/bus/faults.hpp"
#include "master/sim/bus/remote_port.hpp"
#include "master/sim/bus/virtual_bus.hpp"
#include "master/sim/bus/wire_frame.hpp"
#include "master/sim/deadline_tree.hpp"
#include "master/sim/random.hpp"

namespace takt::sim {

class Device;
struct HostedDevice;

struct WorldOptions {
  std::uint64_t seed = 1;
  std::uint32_t bitrate = 1'000'000;
  Faults faults{};
  /// A device whose bit rate differs from that of the bus neither receives nor sends.
  bool one_bit_rate = true;
  Time power_on_spread{};  ///< devices are switched on at random times within this time
};

/// A bus with devices in virtual time. Time passes only when the caller advances it. The same
/// tables, options and calls give exactly the same frames at the same times. Nothing allocates
/// memory after construction, except the start of a fault with values.
class World {
 public:
  World(std::span<const DeviceTable> devices, const WorldOptions& options);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Time now() const noexcept { return now_; }
  /// Returns the time of the next event that needs no further input; `never` if there is none.
  Time next_event() const noexcept;
  /// Processes all events up to and including this time.
  void advance_to(Time until) noexcept;

  /// Attaches the CAN controller of a node outside the simulation: the master or a tool. It lives
  /// as long as the world.
  RemotePort& attach(RemotePortOptions options = {});
  /// Advances as advance_to() does, but stops as soon as `port` has a frame to receive. Returns
  /// true in that case.
  bool advance_until_frame(RemotePort& port, Time until) noexcept;

  /// Returns nullptr if there is no such device.
  Device* device(NodeId node) noexcept;
  void power(NodeId node, bool on) noexcept;
  /// Adds a fault to the schedule.
  void add(const Fault& fault);

  void observe(BusObserver* observer) noexcept { observer_ = observer; }
  const VirtualBus& bus() const noexcept { return bus_; }
  /// Changes the bit rate of the bus and of all nodes outside the simulation. The devices keep
  /// their bit rates, which only LSS changes.
  void set_bitrate(std::uint32_t bitrate) noexcept { bus_.set_bitrate(bitrate); }
  /// Returns the node-ID of a device by its position on the bus; 0 means a remote port or a
  /// babbler.
  std::uint8_t node_of(BusNodeIndex sender) const noexcept;

 private:
  bool step_until(Time until) noexcept;
  void act(Time at) noexcept;
  void run_device(std::size_t index) noexcept;
  void after_call(std::size_t index) noexcept;
  void route(std::size_t index) noexcept;
  void on_wire_end(const WireFrame& wire) noexcept;
  bool fits_bus(const Device& device) const noexcept;
  void deliver_to_devices(const WireFrame& wire) noexcept;
  void deliver(std::size_t index, const Frame& frame) noexcept;
  void report_bus_changes() noexcept;
  void set_power(std::size_t index, bool on) noexcept;
  void babble_again() noexcept;

  void apply(const Fault& fault, bool begins);
  void apply_to_wire(const Fault& fault, bool begins) noexcept;
  void apply_to_device(std::size_t index, const Fault& fault, bool begins);
  void apply_to_ports(const Fault& fault, bool begins) noexcept;
  void set_babble(const Fault& fault, bool begins) noexcept;

  Time now_{};
  Random random_;
  std::uint32_t first_bitrate_;
  bool one_bit_rate_;
  VirtualBus bus_;
  std::vector<std::unique_ptr<HostedDevice>> devices_;
  std::vector<std::unique_ptr<RemotePort>> ports_;
  BusNodeIndex babbler_ = 0;
  Frame babble_;
  Time babble_period_{};
  Time next_babble_ = never;
  DeadlineTree timers_;  ///< timers of the devices, followed by that of the babbler
  FaultSchedule schedule_;
  std::size_t words_ = 1;              ///< size of a set of devices in 64-bit words
  std::vector<std::uint64_t> takers_;  ///< 11-bit identifier -> set of devices
  BusObserver* observer_ = nullptr;
};

}  // namespace takt::sim
