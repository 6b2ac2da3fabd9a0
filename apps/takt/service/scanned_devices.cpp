#include "apps/takt/service/scanned_devices.hpp"

#include <chrono>

#include "apps/command_line/failure.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/takt/service/send_all.hpp"
#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/clock.hpp"

namespace takt {

BusScan scan_bus(const BusScanOptions& options) {
  FrameChannel channel = value_or_fail(FrameChannel::open(options.bus, BusMember::guest), 3);
  BusScan scan{std::chrono::milliseconds{options.timeout_ms}};
  const Time listens_until = monotonic_now() + std::chrono::milliseconds{options.listen_ms};
  const auto hear = [&](const Frame& frame) { scan.on_frame(frame, monotonic_now()); };
  const Interrupt interrupt;
  while ((!scan.done() || monotonic_now() < listens_until) && !Interrupt::asked()) {
    Outbox out;
    scan.on_time(monotonic_now(), out);
    if (!send_all(channel, out.frames(), hear)) {
      throw Failure{"a frame could not be sent on " + options.bus +
                    ": the interface is down, or no node acknowledges frames"};
    }
    StampedFrame frame;
    if (channel.receive(frame, std::chrono::milliseconds{1})) hear(frame.frame);
  }
  return scan;
}

learn::DeviceFiles device_files_in(const std::vector<std::string>& folders) {
  learn::DeviceFiles files;
  Findings findings;
  for (const std::string& folder : folders) files.add_folder(folder, findings);
  if (!findings.empty()) throw Failure{to_string(findings.front()), exit_wrong_use};
  return files;
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

int complain_of_silence(const std::string& bus) {
  return complain("no device answers on " + bus +
                      ": is the bit rate right, are the devices powered, is the bus terminated? "
                      "`takt lss find` finds devices without node id",
                  1);
}

}  // namespace takt
