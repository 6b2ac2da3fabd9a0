// Service frames leave the same queue as the outputs in order, so a waiting service frame would
// delay the outputs.
#include <gtest/gtest.h>

#include "master/sim/device/device.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

TEST(ServiceSlack, RequestsAreThroughWhenTheOutputsGoOut) {
  BusPlan plan = test::axes({.nodes = 3});
  plan.cycle.service_frames = 250;  // as many as fit
  for (NodePlan& node : plan.nodes) node.sdo.block = SdoBlockUse::off;
  test::Rig rig{std::move(plan)};
  ASSERT_TRUE(rig.boot());
  rig.world->device(1_node)->objects().find({0x2020, 0})->bytes.assign(20'000, std::byte{0x55});
  SdoTransfer& file = rig.master->transfers()[0];
  file.data.assign(21'000, std::byte{});
  Request request{.id = 7, .kind = RequestKind::sdo_upload, .node = 1, .object = {0x2020, 0}};
  request.timeout = 100ms;
  request.transfer = &file;
  ASSERT_TRUE(rig.master->submit(request));
  rig.recorder.frames.clear();

  Reply reply;
  for (int cycle = 0; cycle < 5000 && !rig.master->take(reply); ++cycle) {
    rig.command_all(0x0F, cycle);
    rig.cycle();
  }

  ASSERT_EQ(reply.id, 7U);
  EXPECT_EQ(reply.fault, SdoFault::none);
  unsigned syncs = 0;
  unsigned requests = 0;
  unsigned too_late = 0;
  Time sync{};
  for (const sim::WireFrame& wire : rig.recorder.frames) {
    const std::uint32_t id = wire.frame.id.id();
    if (id == 0x080) {
      sync = wire.start;
      ++syncs;
    }
    if ((id & 0x780U) != 0x600) continue;
    ++requests;
    too_late += wire.end - sync > 1600us;
  }
  EXPECT_GT(requests, 2857U);      // segments of seven bytes each
  EXPECT_GT(requests, 2 * syncs);  // the slack was full of them
  EXPECT_EQ(too_late, 0U);
}

}  // namespace
}  // namespace takt
