#pragma once
#include <gtest/gtest.h>

#include "master/core/network/network.hpp"
#include "test/unit/master/core/network/network_rig.hpp"

namespace takt {

class NetworkTest : public testing::Test, public NetworkRig {
 protected:
  static BootPlan simple() {
    Steps steps;
    steps.nmt(NmtCommand::reset_communication)
        .wait(BootAction::await_bootup, 'B', 1s)
        .object(BootAction::probe, 'B', {0x1000, 0})
        .nmt(NmtCommand::start);
    return steps.plan;
  }
  /// Adds a drive whose heartbeat comes every 50 ms and is lost after 150 ms.
  NodePlan& add_drive(std::uint8_t id = 5) {
    auto& node = add(id, simple());
    node.heartbeat_timeout = 150ms;
    devices.back().objects[{0x1000, 0}] = bytes({0x92, 0x01, 0x02, 0x00});
    devices.back().heartbeats(now, 50ms);
    return node;
  }
  Request read(std::uint64_t id, ObjectKey object, std::uint8_t node = 5) {
    return {.id = id, .kind = RequestKind::sdo_upload, .node = node, .object = object};
  }
  int sent_count(const Frame& frame) const {
    return static_cast<int>(std::ranges::count(sent, frame));
  }
};

}  // namespace takt
