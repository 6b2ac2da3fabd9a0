#include "master/linux/can/can_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

CanLink good_link() {
  CanLink link;
  link.name = "can0";
  link.kind = "can";
  link.is_can = true;
  link.up = true;
  link.tx_queue_length = 128;
  link.bitrate = 1'000'000;
  link.restart_ms = 100;
  link.state = CanState::error_active;
  return link;
}

TEST(CanLink, SaysNothingWhereAllIsWell) {
  EXPECT_THAT(link_warnings(good_link(), 1'000'000, 8), IsEmpty());
}

TEST(CanLink, AVirtualInterfaceHasNoBitRateToBeWrong) {
  CanLink link;
  link.name = "vcan0";
  link.kind = "vcan";
  link.tx_queue_length = 1000;

  EXPECT_THAT(link_warnings(link, 250'000, 8), IsEmpty());
}

TEST(CanLink, NamesBothBitRatesAndTheCommand) {
  CanLink link = good_link();
  link.bitrate = 250'000;

  EXPECT_THAT(link_warnings(link, 1'000'000, 8),
              ElementsAre("can0 runs at 250 kbit/s, but the network file says 1000: ip link set "
                          "can0 down && ip link set can0 up type can bitrate 1000000"));
}

TEST(CanLink, ASendQueueShorterThanACycleIsReported) {
  CanLink link = good_link();
  link.tx_queue_length = 10;

  EXPECT_THAT(link_warnings(link, 1'000'000, 8),
              ElementsAre(HasSubstr("ip link set can0 txqueuelen 128")));
}

TEST(CanLink, AControllerThatStaysOffAndOneThatOnlyListensAreReported) {
  CanLink link = good_link();
  link.restart_ms = 0;
  link.listen_only = true;

  EXPECT_THAT(link_warnings(link, 1'000'000, 8),
              ElementsAre(HasSubstr("restart-ms 100"), HasSubstr("listen-only off")));
}

TEST(CanLink, TheLoopbackIsRead) {
  const auto link = read_can_link("lo");

  ASSERT_TRUE(link) << link.error().message;
  EXPECT_EQ(link->name, "lo");
  EXPECT_FALSE(link->is_can);
  EXPECT_FALSE(link->bitrate);
}

TEST(CanLink, AnInterfaceThatIsNotThereIsDeclaredSo) {
  const auto link = read_can_link("nosuchcan");

  ASSERT_FALSE(link);
  EXPECT_EQ(link.error().error, ENODEV);
}

}  // namespace
}  // namespace takt
