#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

#include "test/support/counted_new.hpp"
#include "test/unit/master/core/network/network_rig.hpp"

namespace takt {
namespace {

TEST(Allocation, HappensOnlyInTheConstructorOfTheNetwork) {
  Steps steps;
  steps.nmt(NmtCommand::reset_communication)
      .wait(BootAction::await_bootup, 'B', 10ms)
      .object(BootAction::probe, 'B', {0x1000, 0})
      .object(BootAction::write_if_differs, 'J', {0x1008, 0}, std::vector<std::byte>(40))
      .nmt(NmtCommand::start);
  BusPlan plan{.name = "lift"};
  plan.master_heartbeat = 20ms;
  for (std::uint8_t id = 1; id <= 32; ++id) {
    NodePlan& node = plan.nodes.emplace_back(NodePlan{.name = "n", .id = *NodeId::from(id)});
    node.boot_plan = steps.plan;
    node.heartbeat_timeout = 30ms;
    node.sdo_timeout = 20ms;
  }
  std::uint64_t before = allocations();
  Network network{plan};
  EXPECT_GT(allocations(), before);

  before = allocations();
  Time now = 1s;
  network.start(now);
  std::uint32_t frames = 0;
  Outbox out;
  Reply reply;
  Event event;
  Request request{.id = 1, .kind = RequestKind::sdo_upload, .node = 3, .object = {0x1008, 0}};
  for (int cycle = 0; cycle < 10'000; ++cycle) {
    now += 1ms;
    out.clear();
    network.on_time(now, out);
    for (const Frame& frame : out.frames()) {  // the devices answer every other request
      ++frames;
      Frame answer = frame;
      answer.id = CobId::base(frame.id.id() - 0x80);
      answer.data[0] = frame.data[0] == 0x40 ? 0x43 : 0x60;
      Outbox none;
      if (frames % 2 == 0) network.on_frame(answer, now, none);
      network.on_frame(make_frame(CobId::base(0x700 + frames % 33), {0x05}), now, none);
      network.on_frame(make_frame(CobId::base(0x080 + frames % 33), {1, 2, 3}), now, none);
    }
    network.submit(request, now);
    while (network.take(reply)) ++request.id;
    while (network.take(event)) {
    }
  }
  EXPECT_EQ(allocations(), before);
  EXPECT_GT(frames, 1000U);
  EXPECT_GT(request.id, 10U);
}

}  // namespace
}  // namespace takt
