// On can0 and can1, two SJA1000 controllers on one wire at 1 Mbit/s: see support/with-rt-can.
#include <gmock/gmock.h>
#include <stdexcept>
#include <thread>

#include "master/linux/can/can_filters.hpp"
#include "master/linux/can/can_link.hpp"
#include "master/linux/can/socket_can.hpp"
#include "master/linux/rt_thread.hpp"
#include "test/support/time_limit.hpp"
#include "test/vcan/vcan_fixture.hpp"

namespace takt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Time limit = test::time_limit;
constexpr CobId sync_id = CobId::base(0x080);
const Frame sync_frame = make_frame(sync_id, {0x07});

SocketCanPort open_port(const char* interface) {
  const std::vector<CobId> ids{sync_id, CobId::base(0x185)};
  auto port = SocketCanPort::open(
      {.interface = interface, .filters = filters_for(ids), .sync_cob_id = sync_id});
  if (!port) throw std::runtime_error{port.error().message};
  return std::move(*port);
}

template <class Condition>
bool soon(SocketCanPort& port, Condition condition) {
  const Time until = port.now() + limit;
  std::array<StampedFrame, 8> some;
  bool met = condition();  // called only as often as needed, because it may send
  while (!met && port.now() < until) {
    port.wait_frame(port.now() + std::chrono::milliseconds{20});
    port.receive(some);
    met = condition();
  }
  return met;
}

TEST(CanLinkOnHardware, ReadsBitRateStateRestartAndQueue) {
  const auto link = read_can_link("can0");

  ASSERT_TRUE(link) << link.error().message;
  EXPECT_TRUE(link->is_can);
  EXPECT_TRUE(link->up);
  EXPECT_EQ(link->kind, "can");
  EXPECT_EQ(link->bitrate, 1'000'000U);
  EXPECT_EQ(link->restart_ms, 100U);
  EXPECT_EQ(link->state, CanState::error_active);
  EXPECT_EQ(link->tx_queue_length, 10U);
  EXPECT_EQ(link->bus_off_count, 0U);
  EXPECT_FALSE(link->listen_only);
}

TEST(CanLinkOnHardware, WarnsOfAnotherBitRateAndOfTheShortQueue) {
  const auto link = read_can_link("can0");
  ASSERT_TRUE(link);

  EXPECT_THAT(link_warnings(*link, 500'000, 8),
              ElementsAre(HasSubstr("runs at 1000 kbit/s, but the network file says 500"),
                          HasSubstr("txqueuelen 128")));
}

TEST(CanLinkOnHardware, TheCommandsOfTheWarningsMendThem) {
  run("ip link set can0 down && ip link set can0 up type can bitrate 500000");
  run("ip link set can0 txqueuelen 128");

  EXPECT_THAT(link_warnings(*read_can_link("can0"), 500'000, 8), IsEmpty());

  run("ip link set can0 txqueuelen 10");
  run("ip link set can0 down && ip link set can0 up type can bitrate 1000000");
}

TEST(SocketCanOnHardware, AFrameCrossesTheWire) {
  SocketCanPort a = open_port("can0");
  SocketCanPort b = open_port("can1");
  const Frame tpdo = make_frame(CobId::base(0x185), {1, 2, 3, 4, 5, 6, 7, 8});

  EXPECT_EQ(a.send({&tpdo, 1}).sent, 1U);

  std::array<StampedFrame, 4> in;
  ASSERT_TRUE(b.wait_frame(b.now() + limit));
  ASSERT_EQ(b.receive(in), 1U);
  EXPECT_EQ(in[0].frame, tpdo);
}

TEST(SocketCanOnHardware, TheEchoOfSyncReportsWhenItWasOnTheWire) {
  SocketCanPort a = open_port("can0");
  const Time before = a.now() - std::chrono::milliseconds{2};

  a.send({&sync_frame, 1});

  EXPECT_TRUE(soon(a, [&] { return a.condition().last_sync_echo >= before; }));
  EXPECT_LE(a.condition().last_sync_echo, a.now());
}

TEST(SocketCanOnHardware, AFullQueueOfTenIsReportedAsNoBuffers) {
  SocketCanPort a = open_port("can0");
  std::array<Frame, 256> burst;
  burst.fill(make_frame(CobId::base(0x205), {1, 2, 3, 4, 5, 6, 7, 8}));

  SendResult result;
  for (int i = 0; i < 200 && result.error == 0; ++i) result = a.send(burst);

  EXPECT_EQ(result.error, ENOBUFS);
  EXPECT_LT(result.sent, burst.size());
  EXPECT_FALSE(a.condition().interface_down);
  EXPECT_TRUE(soon(a, [&] { return a.send({&sync_frame, 1}).sent == 1; }));
}

TEST(SocketCanOnHardware, AnInterfaceThatGoesDownComesBackWithItsFilters) {
  SocketCanPort a = open_port("can0");
  run("ip link set can0 down");
  EXPECT_TRUE(soon(a, [&] { return a.condition().interface_down; }));
  EXPECT_EQ(a.send({&sync_frame, 1}).sent, 0U);

  run("ip link set can0 up");

  EXPECT_TRUE(soon(a, [&] { return !a.condition().interface_down; }));
  Peer peer{"can1"};
  peer.send(0x186, {1});
  peer.send(0x185, {2});
  std::array<StampedFrame, 4> in;
  ASSERT_TRUE(a.wait_frame(a.now() + limit));
  ASSERT_EQ(a.receive(in), 1U);
  EXPECT_EQ(in[0].frame.data[0], 2);
}

TEST(SocketCanOnHardware, TheDriverCanBeRemovedAndLoadedAgain) {
  SocketCanPort a = open_port("can0");
  const char* pci = "/sys/bus/pci/drivers/kvaser_pci";
  const std::string device = "$(basename $(readlink -f /sys/class/net/can0/device))";
  run("echo " + device + " > /tmp/takt-can-hw-device && cat /tmp/takt-can-hw-device > " +
      std::string{pci} + "/unbind");
  EXPECT_TRUE(soon(a, [&] { return a.condition().interface_down; }));

  run("cat /tmp/takt-can-hw-device > " + std::string{pci} + "/bind");
  run("ip link set can0 up type can bitrate 1000000 restart-ms 100");

  EXPECT_TRUE(soon(a, [&] { return !a.condition().interface_down; }));
  const Time before = a.now() - std::chrono::milliseconds{2};
  a.send({&sync_frame, 1});
  EXPECT_TRUE(soon(a, [&] { return a.condition().last_sync_echo >= before; }));
}

TEST(RtThreadOnAnRtKernel, GetsAllItAsksFor) {
  int cpu = -1;

  RtReport report;
  auto thread = start_rt_thread({.mode = RtMode::enforce, .priority = 80, .cpu = 1}, "takt-bus",
                                report, [&] { cpu = sched_getcpu(); });
  ASSERT_TRUE(thread);
  thread->join();

  EXPECT_EQ(to_string(report), "SCHED_FIFO 80 on cpu 1, memory locked, kernel PREEMPT_RT: yes");
  EXPECT_EQ(cpu, 1);
}

}  // namespace
}  // namespace takt
