#include "master/linux/bus/frame_channel.hpp"

#include <gtest/gtest.h>
#include <string>

#include "master/linux/can/interface_bitrate.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

TEST(FrameChannel, SeesWhatWasSentOnTheBusAndNothingElse) {
  const test::Folder folder;
  const std::string bus = "unix:" + (folder / "bus").string();
  auto sender = FrameChannel::open(bus);
  ASSERT_TRUE(sender);
  auto witness = FrameChannel::open(bus, BusMember::guest);
  ASSERT_TRUE(witness);
  constexpr CobId lss = CobId::base(0x7E5);

  ASSERT_TRUE(sender->send(make_frame(lss, {0x13, 0, 3})));
  EXPECT_FALSE(witness->sees(lss, 0x15, 50ms)) << "another frame";
  ASSERT_TRUE(sender->send(make_frame(lss, {0x15, 0xE8, 3})));
  EXPECT_TRUE(witness->sees(lss, 0x15, 60s));
  EXPECT_FALSE(witness->sees(lss, 0x15, 0ms)) << "seen once";
}

TEST(InterfaceBitrate, IsNoTroubleWhereThereIsNone) {
  EXPECT_EQ(interface_bitrate_error(std::string{"unix:/tmp/x"}), "");
  EXPECT_EQ(interface_bitrate_error(CanLink{.name = "vcan7", .kind = "vcan"}), "");
}

TEST(InterfaceBitrate, IsFoundOutBeforeAnythingChanges) {
  const std::string declared = interface_bitrate_error(CanLink{.name = "takt-none", .kind = "can"});
  EXPECT_NE(declared.find("the bit rate of takt-none can't be changed"), std::string::npos)
      << declared;
  EXPECT_NE(declared.find("no device was changed"), std::string::npos);
}

}  // namespace
}  // namespace takt
