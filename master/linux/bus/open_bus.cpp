#include "master/linux/bus/open_bus.hpp"

#include <cerrno>

#include "master/linux/bus_name.hpp"

namespace takt {
namespace {

template <class P>
std::expected<AnyPort, BusError> wrap(std::expected<P, BusError> port) {
  if (!port) return std::unexpected{port.error()};
  return AnyPort{std::move(*port)};
}

}  // namespace

std::expected<AnyPort, BusError> open_bus(std::string_view bus, const BusPlan& plan, Time spin,
                                          SentFrames* sent) {
  const BusName name = BusName::parse(bus);
  UnixBusOptions unix_options{.path = name.name, .spin = spin, .sent = sent};
  if (plan.cycle.makes_sync()) unix_options.sync_cob_id = plan.cycle.sync_cob_id;
  switch (name.kind) {
    case BusName::Kind::can_interface:
      return wrap(SocketCanPort::open(name.name, plan, spin, sent));
    case BusName::Kind::unix_path:
      return wrap(UnixBusPort::open(unix_options));
    case BusName::Kind::simulated:
      break;
  }
  return std::unexpected{BusError{"a simulated bus can't be opened as an interface", EINVAL}};
}

}  // namespace takt
