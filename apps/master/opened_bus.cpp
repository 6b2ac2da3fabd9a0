#include "apps/master/opened_bus.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include "master/attach.hpp"
#include "master/linux/bus_name.hpp"
#include "master/linux/can/can_link.hpp"

namespace takt {

std::expected<std::unique_ptr<OpenedBus>, BusError> OpenedBus::open_real(const std::string& name,
                                                                         const BusPlan& plan,
                                                                         Time spin) {
  std::unique_ptr<OpenedBus> bus{new OpenedBus};
  auto port = open_bus(name, plan, spin, &bus->sent_);
  if (!port) return std::unexpected{port.error()};
  bus->port_.emplace(std::move(*port));
  auto diagnostics = DiagnosticSocket::open(name, plan, bus->sent_);
  if (diagnostics) {
    bus->diagnostics_.emplace(std::move(*diagnostics));
  } else {
    bus->warnings_.push_back("takt can't detect other masters on the bus: " +
                             diagnostics.error().message);
  }
  const BusName parsed = BusName::parse(name);
  if (parsed.kind != BusName::Kind::can_interface) return bus;
  if (const auto link = read_can_link(parsed.name)) {
    std::ranges::copy(link_warnings(*link, plan.bitrate, plan.pdos.rpdos.size() + 1),
                      std::back_inserter(bus->warnings_));
  }
  return bus;
}

std::expected<std::unique_ptr<OpenedBus>, BusError> OpenedBus::open(
    const std::string& name, const BusPlan& plan, std::span<const DeviceTable> devices, Time spin) {
  if (BusName::parse(name).kind != BusName::Kind::simulated) return open_real(name, plan, spin);
  std::unique_ptr<OpenedBus> bus{new OpenedBus};
  bus->simulated_ = std::make_unique<SimulatedBus>(devices, plan, spin);
  return bus;
}

void OpenedBus::attach(MasterRun& master, Journal* journal) {
  if (simulated_) return master.attach(*simulated_, journal);
  std::visit([&](auto& port) { master.attach(port, journal); }, *port_);
}

}  // namespace takt
