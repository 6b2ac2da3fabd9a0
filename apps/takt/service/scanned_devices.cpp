#include "apps/takt/service/scanned_devices.hpp"

#include <chrono>

#include "apps/command_line/failure.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/takt/service/send_all.hpp"
#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/clock.hpp"

namespace takt {

BusScan scan_bus(const std::string& bus, Time timeout, Time listen) {
  FrameChannel channel = value_or_fail(FrameChannel::open(bus, BusMember::guest), 3);
  BusScan scan{timeout};
  const Time listens_until = monotonic_now() + listen;
  const auto hear = [&](const Frame& frame) { scan.on_frame(frame, monotonic_now()); };
  const Interrupt interrupt;
  while ((!scan.done() || monotonic_now() < listens_until) && !Interrupt::asked()) {
    Outbox out;
    scan.on_time(monotonic_now(), out);
    if (!send_all(channel, out.frames(), hear)) {
      throw Failure{"a frame could not be sent on " + bus +
                    ": the interface is down, or no node acknowledges frames"};
    }
    StampedFrame frame;
    if (channel.receive(frame, std::chrono::milliseconds{1})) hear(frame.frame);
  }
  return scan;
}

std::vector<ScannedDevice> with_files(const BusScan& scan, const learn::DeviceFiles& files) {
  std::vector<ScannedDevice> all;
  for (const auto& [id, node] : scan.nodes()) {
    const learn::SeenIdentity identity{.device_type = node.device_type.value_or(0),
                                       .vendor_id = node.identity[0].value_or(0),
                                       .product_code = node.identity[1].value_or(0),
                                       .revision_number = node.identity[2].value_or(0),
                                       .serial_number = node.identity[3].value_or(0)};
    all.push_back({id, node, files.find(id, identity)});
  }
  return all;
}

}  // namespace takt
