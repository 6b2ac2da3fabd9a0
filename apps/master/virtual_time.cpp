#include "apps/master/virtual_time.hpp"

#include <utility>

#include "master/attach.hpp"
#include "master/linux/start_thread.hpp"

namespace takt {

VirtualTime::VirtualTime(std::span<const DeviceTable> devices, const BusPlan& plan)
    : world_{devices, {.bitrate = plan.bitrate}}, port_{world_, {.sync = plan.cycle.sync_cob_id}} {}

void VirtualTime::attach(MasterRun& master) { master.attach(port_); }

std::expected<std::thread, int> VirtualTime::start(std::function<void()> body) {
  return start_thread([this, body = std::move(body)] {
    go_.acquire();
    body();
    ended_ = true;
    image_.release();
  });
}

bool VirtualTime::next() noexcept {
  if (ended_) return false;
  go_.release();
  image_.acquire();
  return !ended_;
}

void VirtualTime::update(const ImageView&, OutputWriter&) noexcept {
  image_.release();
  go_.acquire();
}

}  // namespace takt
