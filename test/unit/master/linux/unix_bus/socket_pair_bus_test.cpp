#include "master/linux/bus/frame_channel.hpp"
#include "test/unit/master/linux/unix_bus/unix_bus_fixture.hpp"

namespace takt::test {
namespace {

TEST(SocketPairBus, EchoesTheSyncThatTheDevicesHaveSeen) {
  auto [master, end] = make_socket_pair_bus();
  FrameChannel devices{std::move(end)};
  const Time before = master.now();

  master.send({&sync_frame, 1});
  StampedFrame seen;
  ASSERT_TRUE(devices.receive(seen, limit));
  devices.send(tpdo);

  std::array<StampedFrame, 4> in;
  ASSERT_EQ(master.receive(in), 1U);
  EXPECT_EQ(seen.frame, sync_frame);
  EXPECT_EQ(in[0].frame, tpdo);
  EXPECT_GE(master.condition().last_sync_echo, before);
}

TEST(SocketPairBus, ABatchIsFullEvenWhereSomeOfItWasForThePortAlone) {
  auto [master, devices] = make_socket_pair_bus();
  std::array<StampedFrame, 8> in;
  for (int i = 0; i < 3; ++i) master.send({&sync_frame, 1});
  ASSERT_EQ(devices.receive(in), 3U);  // and gives the echoes back
  const std::vector<Frame> tpdos(10, tpdo);
  devices.send(tpdos);

  EXPECT_EQ(master.receive(in), 8U);
  EXPECT_EQ(master.receive(in), 2U);
}

TEST(SocketPairBus, GoesDownForGoodWhenTheDevicesEnd) {
  auto [master, end] = make_socket_pair_bus();
  {
    const UnixBusPort gone = std::move(end);
  }

  std::array<StampedFrame, 4> in;
  EXPECT_EQ(master.receive(in), 0U);

  EXPECT_TRUE(master.condition().interface_down);
  EXPECT_EQ(master.send({&tpdo, 1}).error, ENETDOWN);
}

TEST(FrameChannel, RefusesNamesThatAreNoBus) {
  const auto sim = FrameChannel::open("sim");
  const auto missing = FrameChannel::open("no_such_can_interface");

  ASSERT_FALSE(sim);
  ASSERT_FALSE(missing);
  EXPECT_NE(sim.error().message.find("unix:PATH"), std::string::npos);
}

}  // namespace
}  // namespace takt::test
