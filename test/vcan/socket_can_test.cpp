#include "master/linux/can/socket_can.hpp"

#include <stdexcept>

#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/can/can_filters.hpp"
#include "test/support/time_limit.hpp"
#include "test/vcan/vcan_fixture.hpp"

namespace takt {
namespace {

constexpr Time limit = test::time_limit;
constexpr CobId sync_id = CobId::base(0x080);
const Frame sync_frame = make_frame(sync_id, {0x07});
const Frame rpdo = make_frame(CobId::base(0x205), {0x0F, 0x00, 0x10, 0x20, 0x30, 0x40});

SocketCanPort open_port(const char* interface,
                        std::vector<CobId> ids = {sync_id, CobId::base(0x185)}) {
  auto port = SocketCanPort::open(
      {.interface = interface, .filters = filters_for(ids), .sync_cob_id = sync_id});
  if (!port) throw std::runtime_error{port.error().message};
  return std::move(*port);
}

std::vector<StampedFrame> receive_all(SocketCanPort& port, std::size_t wanted) {
  std::vector<StampedFrame> all;
  const Time until = port.now() + limit;
  while (all.size() < wanted && port.wait_frame(until)) {
    std::array<StampedFrame, 300> some;
    const std::size_t count = port.receive(some);
    all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return all;
}

template <class Condition>
bool soon(SocketCanPort& port, Condition condition) {
  const Time until = port.now() + limit;
  std::array<StampedFrame, 8> some;
  bool met = condition();  // called only as often as needed, because it may send
  while (!met && port.now() < until) {
    port.wait_frame(port.now() + std::chrono::milliseconds{10});
    port.receive(some);
    met = condition();
  }
  return met;
}

TEST(SocketCan, TakesOnlyWhatTheFiltersLetPass) {
  SocketCanPort port = open_port("vcan0");
  Peer peer{"vcan0"};

  peer.send(0x186, {9});
  peer.send(0x185 | CAN_RTR_FLAG, {});
  peer.send(0x185 | CAN_EFF_FLAG, {9});
  peer.send(0x185, {1, 2, 3});

  const auto got = receive_all(port, 1);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].frame, make_frame(CobId::base(0x185), {1, 2, 3}));
}

TEST(SocketCan, TakesABatchInOrderWithOneCall) {
  SocketCanPort port = open_port("vcan0");
  Peer peer{"vcan0"};
  Peer listener{"vcan0"};
  for (std::uint8_t i = 0; i < 120; ++i) peer.send(0x185, {i});
  // The kernel may deliver frames later than their send() returns.
  for (int i = 0; i < 120; ++i) listener.receive();
  sleep_until(port.now() + std::chrono::milliseconds{10});

  std::array<StampedFrame, 128> in;
  ASSERT_EQ(port.receive(in), 120U);

  for (std::uint8_t i = 0; i < 120; ++i) EXPECT_EQ(in[i].frame.data[0], i);
  EXPECT_EQ(port.receive(in), 0U);
}

TEST(SocketCan, SendsABatchInOrder) {
  SocketCanPort port = open_port("vcan0");
  Peer peer{"vcan0"};
  Frame extended = make_frame(CobId::extended(0x12345), {1});
  const std::array<Frame, 3> batch{sync_frame, rpdo, extended};

  const SendResult result = port.send(batch);

  EXPECT_EQ(result.sent, 3U);
  EXPECT_EQ(result.error, 0);
  EXPECT_EQ(peer.receive().can_id, 0x080U);
  const can_frame second = peer.receive();
  EXPECT_EQ(second.can_id, 0x205U);
  EXPECT_EQ(second.can_dlc, 6);
  EXPECT_EQ(second.data[5], 0x40);
  EXPECT_EQ(peer.receive().can_id, 0x8001'2345U);
}

TEST(SocketCan, ReportsWhenTheOwnSyncWasOnTheWireAndKeepsItBack) {
  SocketCanPort port = open_port("vcan0");
  const Time before = port.now();

  port.send({&sync_frame, 1});
  const Time after = port.now();

  std::array<StampedFrame, 4> in;
  EXPECT_TRUE(port.wait_frame(port.now() + limit));
  EXPECT_EQ(port.receive(in), 0U);
  constexpr Time of_clock_reading = std::chrono::milliseconds{2};
  EXPECT_GE(port.condition().last_sync_echo, before - of_clock_reading);
  EXPECT_LE(port.condition().last_sync_echo, after + of_clock_reading);
}

TEST(SocketCan, TheSyncOfAnotherIsAFrameAndNoEcho) {
  SocketCanPort port = open_port("vcan0");
  Peer peer{"vcan0"};

  peer.send(0x080, {7});

  const auto got = receive_all(port, 1);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].frame, sync_frame);
  EXPECT_EQ(port.condition().last_sync_echo, Time{0});
}

TEST(SocketCan, DoesNotHearItsOwnOutputsEvenWhereTheFiltersAreWide) {
  SocketCanPort port = open_port("vcan0", {sync_id, rpdo.id});

  port.send({&rpdo, 1});

  std::array<StampedFrame, 4> in;
  EXPECT_TRUE(port.wait_frame(port.now() + limit));
  EXPECT_EQ(port.receive(in), 0U);
}

TEST(SocketCan, StampsAFrameWithItsArrivalAndNotWithTheTimeOfReading) {
  SocketCanPort port = open_port("vcan0");
  Peer peer{"vcan0"};
  peer.send(0x185, {1});
  const Time sent = port.now();

  port.sleep_until(sent + std::chrono::milliseconds{50});
  const auto got = receive_all(port, 1);

  ASSERT_EQ(got.size(), 1U);
  EXPECT_LT(got[0].when, sent + std::chrono::milliseconds{25});
}

TEST(SocketCan, ErrorFramesBecomeNewsAndNoFrames) {
  SocketCanPort port = open_port("vcan0");
  Peer controller{"vcan0"};

  controller.send(CAN_ERR_FLAG | 0x004, {0, 0x30, 0, 0, 0, 0, 130, 129});
  EXPECT_TRUE(soon(port, [&] { return port.condition().error_passive; }));
  EXPECT_EQ(port.condition().tx_error_counter, 130);
  EXPECT_EQ(port.condition().rx_error_counter, 129);

  controller.send(CAN_ERR_FLAG | 0x040, {0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(soon(port, [&] { return port.condition().bus_off; }));

  controller.send(CAN_ERR_FLAG | 0x100, {0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(
      soon(port, [&] { return !port.condition().bus_off && !port.condition().error_passive; }));
  EXPECT_EQ(port.condition().error_frames, 3U);
}

TEST(SocketCan, ABusOffControllerWhoseSyncIsOnTheWireAgainHasRecovered) {
  SocketCanPort port = open_port("vcan0");
  Peer controller{"vcan0"};
  controller.send(CAN_ERR_FLAG | 0x040, {0, 0, 0, 0, 0, 0, 0, 0});
  ASSERT_TRUE(soon(port, [&] { return port.condition().bus_off; }));

  port.send({&sync_frame, 1});

  EXPECT_TRUE(soon(port, [&] { return !port.condition().bus_off; }));
}

TEST(SocketCan, CountsWhatTheKernelHadToDrop) {
  SocketCanPort port = open_port("vcan0");
  Peer peer{"vcan0"};
  for (int i = 0; i < 8000; ++i) peer.send(0x185, {1});

  std::array<StampedFrame, 256> in;
  while (port.receive(in) > 0) {
  }
  peer.send(0x185, {2});  // the count of drops comes with the next frame

  EXPECT_TRUE(soon(port, [&] { return port.condition().receive_overruns > 0; }));
}

TEST(SocketCan, AddsTheOverrunsOfTheControllerToWhatTheKernelHadToDrop) {
  SocketCanPort port = open_port("vcan0");
  Peer peer{"vcan0"};
  for (int i = 0; i < 8000; ++i) peer.send(0x185, {1});
  std::array<StampedFrame, 256> in;
  while (port.receive(in) > 0) {
  }
  peer.send(0x185, {2});
  ASSERT_TRUE(soon(port, [&] { return port.condition().receive_overruns > 0; }));
  const std::uint32_t dropped = port.condition().receive_overruns;

  peer.send(CAN_ERR_FLAG | 0x004, {0, 0x01, 0, 0, 0, 0, 0, 0});
  peer.send(0x185, {3});

  EXPECT_EQ(receive_all(port, 1).size(), 1U);
  EXPECT_EQ(port.condition().receive_overruns, dropped + 1);
}

TEST(SocketCan, ABatchIsFullEvenWhereSomeOfItWasForThePortAlone) {
  SocketCanPort port = open_port("vcan0");
  Peer peer{"vcan0"};
  for (int i = 0; i < 3; ++i) port.send({&sync_frame, 1});
  for (int i = 0; i < 300; ++i) peer.send(0x185, {static_cast<std::uint8_t>(i)});

  std::array<StampedFrame, 256> in;
  ASSERT_EQ(port.receive(in), 256U);

  EXPECT_EQ(in[255].frame.data[0], 255);
  EXPECT_EQ(port.receive(in), 44U);
}

TEST(SocketCan, LeavesFramesOfCanFdAlone) {
  run("ip link set vcan0 down && ip link set vcan0 mtu 72 up");
  SocketCanPort port = open_port("vcan0");
  Peer peer{"vcan0"};

  peer.send_fd(0x185);
  peer.send(0x185, {1});

  const auto got = receive_all(port, 1);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].frame.length, 1);
}

TEST(SocketCan, AFullSendQueueIsReportedAsNoBuffersWithTheFramesThatWent) {
  run("ip link add vcan9 type vcan && ip link set vcan9 up");
  run("tc qdisc add dev vcan9 root tbf rate 1kbit burst 16 limit 160");
  SocketCanPort port = open_port("vcan9");
  std::array<Frame, 100> batch;
  batch.fill(rpdo);

  const SendResult result = port.send(batch);

  EXPECT_EQ(result.error, ENOBUFS);
  EXPECT_GT(result.sent, 0U);
  EXPECT_LT(result.sent, 100U);
  EXPECT_EQ(port.condition().last_error, ENOBUFS);
  EXPECT_FALSE(port.condition().interface_down);
  run("ip link del vcan9");
}

TEST(SocketCan, AnInterfaceThatIsDownCannotBeOpenedAndTheMessageSaysWhatToDo) {
  run("ip link add vcan9 type vcan");

  const auto port = SocketCanPort::open({.interface = "vcan9", .filters = {}});

  ASSERT_FALSE(port);
  EXPECT_NE(port.error().message.find("ip link set vcan9 up"), std::string::npos);
  run("ip link del vcan9");
}

TEST(SocketCan, AnInterfaceThatIsNoCanIsRefused) {
  const auto port = SocketCanPort::open({.interface = "lo", .filters = {}});

  ASSERT_FALSE(port);
  EXPECT_NE(port.error().message.find("lo: this is not a CAN interface"), std::string::npos);
}

class SocketCanTrouble : public testing::Test {
 protected:
  SocketCanTrouble() { run("ip link add vcan8 type vcan && ip link set vcan8 up"); }
  ~SocketCanTrouble() override { run("ip link del vcan8"); }

  /// Filters and echo work again after a failure.
  void expect_working(SocketCanPort& port) {
    ASSERT_TRUE(soon(port, [&] { return !port.condition().interface_down; }));
    Peer peer{"vcan8"};
    peer.send(0x186, {1});
    peer.send(0x185, {2});
    const auto got = receive_all(port, 1);
    ASSERT_EQ(got.size(), 1U);
    EXPECT_EQ(got[0].frame.id, CobId::base(0x185));
    const Time before = port.now();
    EXPECT_EQ(port.send({&sync_frame, 1}).sent, 1U);
    EXPECT_EQ(peer.receive().can_id, 0x080U);
    EXPECT_TRUE(soon(port, [&] {
      return port.condition().last_sync_echo > before - std::chrono::milliseconds{2};
    }));
  }
};

TEST_F(SocketCanTrouble, SendingReportsThatTheInterfaceIsDownAndItComesBack) {
  SocketCanPort port = open_port("vcan8");
  run("ip link set vcan8 down");

  const SendResult result = port.send({&sync_frame, 1});

  EXPECT_EQ(result.sent, 0U);
  EXPECT_EQ(result.error, ENETDOWN);
  EXPECT_TRUE(port.condition().interface_down);
  run("ip link set vcan8 up");
  expect_working(port);
}

TEST_F(SocketCanTrouble, ReceivingReportsThatTheInterfaceIsDownAndItComesBack) {
  SocketCanPort port = open_port("vcan8");
  run("ip link set vcan8 down");

  EXPECT_TRUE(soon(port, [&] { return port.condition().interface_down; }));

  run("ip link set vcan8 up");
  expect_working(port);
}

TEST_F(SocketCanTrouble, ADeletedInterfaceIsFoundAgainByItsName) {
  SocketCanPort port = open_port("vcan8");
  run("ip link del vcan8");
  EXPECT_TRUE(soon(port, [&] { return port.condition().interface_down; }));
  EXPECT_EQ(port.send({&sync_frame, 1}).sent, 0U);

  run("ip link add vcan7 type vcan && ip link add vcan8 type vcan");  // another index than before
  EXPECT_TRUE(port.condition().interface_down);
  run("ip link set vcan8 up");

  expect_working(port);
  run("ip link del vcan7");
}

TEST_F(SocketCanTrouble, WaitingOnAnInterfaceThatIsDownDoesNotSpin) {
  SocketCanPort port = open_port("vcan8");
  run("ip link set vcan8 down");
  ASSERT_TRUE(soon(port, [&] { return port.condition().interface_down; }));

  const Time until = port.now() + std::chrono::milliseconds{200};
  int waits = 0;
  std::array<StampedFrame, 4> in;
  while (port.now() < until) {
    port.wait_frame(until);
    port.receive(in);
    ++waits;
  }

  EXPECT_LE(waits, 8);
}

TEST(FrameChannelOnVcan, HearsEverythingOfTheOthersAndNothingOfItsOwn) {
  auto channel = FrameChannel::open("vcan0");
  ASSERT_TRUE(channel);
  Peer peer{"vcan0"};

  channel->send(rpdo);
  peer.send(0x605, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0});

  StampedFrame got;
  ASSERT_TRUE(channel->receive(got, limit));
  EXPECT_EQ(got.frame.id, CobId::base(0x605));
  EXPECT_FALSE(channel->receive(got, Time{0}));
}

}  // namespace
}  // namespace takt
