#include <gtest/gtest.h>

#include "master/wire/emcy.hpp"
#include "master/wire/heartbeat.hpp"
#include "master/wire/nmt.hpp"
#include "master/wire/sync.hpp"

namespace takt {
namespace {

TEST(Bytes, MissingOnesAreZero) {
  const std::array<std::uint8_t, 2> two{0x34, 0x12};
  EXPECT_EQ(load_le<std::uint32_t>(std::span{two}), 0x1234U);
  EXPECT_EQ(load_le<std::uint64_t>(std::span<const std::byte>{}), 0U);
}

TEST(Nmt, CommandsAreTwoBytesOnIdentifierZero) {
  EXPECT_EQ(encode(NmtMessage{NmtCommand::start, 0}), make_frame(CobId::base(0), {0x01, 0x00}));
  EXPECT_EQ(encode(NmtMessage{NmtCommand::start, 5}), make_frame(CobId::base(0), {0x01, 0x05}));
  EXPECT_EQ(encode(NmtMessage{NmtCommand::enter_preoperational, 0}),
            make_frame(CobId::base(0), {0x80, 0x00}));
  EXPECT_EQ(encode(NmtMessage{NmtCommand::reset_communication, 5}),
            make_frame(CobId::base(0), {0x82, 0x05}));
  EXPECT_EQ(encode(NmtMessage{NmtCommand::reset_node, 0}),
            make_frame(CobId::base(0), {0x81, 0x00}));
}

TEST(Nmt, IgnoresUnknownCommandsForeignNodesAndShortFrames) {
  EXPECT_EQ(decode_nmt(make_frame(CobId::base(0), {0x82, 0x05})),
            (NmtMessage{NmtCommand::reset_communication, 5}));
  EXPECT_FALSE(decode_nmt(make_frame(CobId::base(0), {0x03, 0x05})));
  EXPECT_FALSE(decode_nmt(make_frame(CobId::base(0), {0x01, 0x80})));
  EXPECT_FALSE(decode_nmt(make_frame(CobId::base(0), {0x01})));
  EXPECT_FALSE(decode_nmt(make_frame(CobId::extended(0), {0x01, 0x05})));
}

TEST(Heartbeat, MasksTheToggleBitOfGuarding) {
  EXPECT_EQ(decode_heartbeat(make_frame(CobId::base(0x705), {0x05}))->state, NmtState::operational);
  EXPECT_EQ(decode_heartbeat(make_frame(CobId::base(0x705), {0x85}))->state, NmtState::operational);
  EXPECT_EQ(decode_heartbeat(make_frame(CobId::base(0x705), {0xFF}))->state,
            NmtState::preoperational);
  EXPECT_EQ(decode_heartbeat(make_frame(CobId::base(0x705), {0x84}))->state, NmtState::stopped);
  EXPECT_EQ(decode_heartbeat(make_frame(CobId::base(0x705), {0x00}))->state, NmtState::bootup);
  EXPECT_EQ(decode_heartbeat(make_frame(CobId::base(0x705), {0x00}))->node, 5_node);
}

TEST(Heartbeat, IsNotSeenInOtherFrames) {
  EXPECT_FALSE(decode_heartbeat(make_frame(CobId::base(0x700), {0x05})));
  EXPECT_FALSE(decode_heartbeat(make_frame(CobId::base(0x685), {0x05})));
  EXPECT_FALSE(decode_heartbeat(make_frame(CobId::base(0x785), {0x05})));
  EXPECT_FALSE(decode_heartbeat(make_frame(CobId::base(0x705), {})));
  EXPECT_FALSE(decode_heartbeat(make_frame(CobId::extended(0x705), {0x05})));
  EXPECT_FALSE(decode_heartbeat(Frame{.id = CobId::base(0x705), .length = 1, .rtr = true}));
  EXPECT_EQ(decode_heartbeat(make_frame(CobId::base(0x705), {0x33}))->state, NmtState::unknown);
}

TEST(Sync, HasOneByteOnlyWithACounter) {
  EXPECT_EQ(sync_frame(CobId::base(0x80)), make_frame(CobId::base(0x80), {}));
  EXPECT_EQ(sync_frame(CobId::base(0x80), 10), make_frame(CobId::base(0x80), {0x0A}));
  EXPECT_EQ(sync_counter(make_frame(CobId::base(0x80), {})), 0);
}

TEST(Emcy, IsCodeRegisterAndFiveBytes) {
  const Emcy emcy =
      emcy_of(5_node, make_frame(CobId::base(0x85), {0x30, 0x81, 0x11, 0x05, 0, 0, 0, 0}));
  EXPECT_EQ(emcy.node, 5_node);
  EXPECT_EQ(emcy.code, 0x8130);
  EXPECT_EQ(emcy.error_register, 0x11);
  EXPECT_EQ(emcy.manufacturer[0], 5);
  EXPECT_EQ(encode(emcy), make_frame(CobId::base(0x85), {0x30, 0x81, 0x11, 0x05, 0, 0, 0, 0}));
}

TEST(Emcy, TakesShortFrames) {
  EXPECT_EQ(emcy_of(5_node, make_frame(CobId::base(0x85), {0x50})).code, 0x0050);
  EXPECT_EQ(emcy_of(5_node, make_frame(CobId::base(0x85), {})).code, 0);
}

}  // namespace
}  // namespace takt
