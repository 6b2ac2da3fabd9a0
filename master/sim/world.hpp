#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "eds_parser/table/device_table.hpp"
#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/sim/deadline_tree.hpp"
#include "master/sim/fault_schedule.hpp"
#include "master/sim/faults.hpp"
#include "master/sim/random.hpp"
#include "master/sim/remote_port.hpp"
#include "master/sim/virtual_bus.hpp"
#include "master/sim/wire_frame.hpp"

namespace takt::sim {

class Device;
struct HostedDevice;

struct WorldOptions {
  std::uint64_t seed = 1;
  std::uint32_t bitrate = 1'000'000;
  Faults faults{};
  bool one_bit_rate = true;  ///< a device whose bit rate is not that of the bus is deaf and mute
  Time power_on_spread{};    ///< devices are switched on at random times within this
};

/// A bus with devices in virtual time. Time stands still unless somebody advances it. The same
/// tables, options and calls give the same frames at the same times, to the byte. Nothing allocates
/// after construction, except a fault with values when it begins.
class World {
 public:
  World(std::span<const DeviceTable> devices, WorldOptions options);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Time now() const noexcept { return now_; }
  /// When something happens next by itself; `never`: nothing at all.
  Time next_event() const noexcept;
  /// Everything up to and including this time happens.
  void advance_to(Time until) noexcept;

  /// A controller of somebody outside: the master, a tool. Lives as long as the world.
  RemotePort& attach(RemotePortOptions options = {});
  /// As advance_to, but stops as soon as `port` has something to receive. True: it has.
  bool advance_until_frame(RemotePort& port, Time until) noexcept;

  /// nullptr: no such device.
  Device* device(NodeId node) noexcept;
  void power(NodeId node, bool on) noexcept;
  /// A fault from now on, on top of the schedule.
  void add(const Fault& fault);

  void observe(BusObserver* observer) noexcept { observer_ = observer; }
  const VirtualBus& bus() const noexcept { return bus_; }
  /// Everybody but the devices, whom LSS changes, has another bit rate from now on.
  void set_bitrate(std::uint32_t bitrate) noexcept { bus_.set_bitrate(bitrate); }
  /// Node of a device by its position on the bus; 0: a remote port or a babbler.
  std::uint8_t node_of(BusNodeIndex sender) const noexcept;

 private:
  void step(Time at) noexcept;
  void step_bus() noexcept;
  void run_device(std::size_t index) noexcept;
  void after_call(std::size_t index) noexcept;
  void route(std::size_t index) noexcept;
  void on_wire_end(const WireFrame& wire) noexcept;
  bool fits_bus(const Device& device) const noexcept;
  void deliver_to_devices(const WireFrame& wire) noexcept;
  void deliver(std::size_t index, const Frame& frame) noexcept;
  void tell_bus_changes() noexcept;
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
  DeadlineTree timers_;  ///< of the devices; behind them the babbler
  FaultSchedule schedule_;
  std::size_t words_ = 1;              ///< of a set of devices
  std::vector<std::uint64_t> takers_;  ///< 11-bit identifier -> set of devices
  BusObserver* observer_ = nullptr;
};

}  // namespace takt::sim
