#include "master/explain/frame/frame_text.hpp"

#include "test/unit/master/explain/frame/frame_text_fixture.hpp"

namespace takt {
namespace {

class FrameTextTest : public test::FrameTextFixture {};

TEST_F(FrameTextTest, NmtCommandsNameTheirNode) {
  EXPECT_EQ(plain(0x000, {0x01, 0x00}), "NMT start all nodes");
  EXPECT_EQ(plain(0x000, {0x81, 0x05}), "NMT reset node 5");
  EXPECT_EQ(named(0x000, {0x82, 0x05}), "NMT reset communication shoulder");
  EXPECT_EQ(plain(0x000, {0x07, 0x05}), "NMT not a command: 07 05");
  EXPECT_EQ(plain(0x000, {0x01}), "NMT not a command: 01");
  EXPECT_EQ(plain(0x000, {0x01, 0x05, 0, 0, 0, 0, 0, 0}),
            "NMT start node 5 (8 bytes instead of 2)");
}

TEST_F(FrameTextTest, SyncShowsItsCounter) {
  EXPECT_EQ(plain(0x080, {}), "SYNC ");
  EXPECT_EQ(plain(0x080, {0x0A}), "SYNC 10");
}

TEST_F(FrameTextTest, HeartbeatsNameTheState) {
  EXPECT_EQ(plain(0x705, {0x00}), "BOOTUP node 5");
  EXPECT_EQ(named(0x705, {0x05}), "HEARTBEAT shoulder operational");
  EXPECT_EQ(plain(0x705, {0xFF}),
            "HEARTBEAT node 5 pre-operational, toggle 1 (guarding; the request was not recorded)");
  EXPECT_EQ(plain(0x705, {0x42}), "HEARTBEAT node 5 unknown state 0x42");
}

TEST_F(FrameTextTest, AnEmcyIsReportedInWords) {
  const std::string text = named(0x085, {0x30, 0x81, 0x11, 0x05, 0, 0, 0, 0});

  EXPECT_TRUE(text.starts_with("EMCY shoulder 8130 ")) << text;
  EXPECT_NE(text.find("error register 11 ("), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("vendor 05 00 00 00 00")) << text;
}

TEST_F(FrameTextTest, TimeIsShown) {
  // 12:00:00.000 is 43,200,000 ms = 0x02932E00; day 15000 = 0x3A98
  EXPECT_EQ(plain(0x100, {0x00, 0x2E, 0x93, 0x02, 0x98, 0x3A}),
            "TIME 2025-01-25 12:00:00.000, day 15000 since 1984");
  EXPECT_EQ(plain(0x100, {0xFF, 0x5B, 0x26, 0x05, 0x4D, 0x39}),
            "TIME 2024-02-29 23:59:59.999, day 14669 since 1984");
  EXPECT_EQ(plain(0x100, {0x00, 0x2E}), "TIME has 2 bytes instead of 6");
}

TEST_F(FrameTextTest, GuardingIsFollowedByItsToggleBit) {
  Frame request = make_frame(CobId::base(0x705), {});
  request.rtr = true;
  const auto ask = [&] { return named_.meaning(request).text; };

  EXPECT_EQ(ask(), "shoulder is asked for its state");
  EXPECT_EQ(named(0x705, {0x7F}), "GUARD shoulder answers: pre-operational, toggle 0");
  ask();
  EXPECT_EQ(named(0x705, {0xFF}), "GUARD shoulder answers: pre-operational, toggle 1");
  ask();
  EXPECT_EQ(named(0x705, {0x85}),
            "GUARD shoulder answers: operational, toggle 1 as before: the toggle bit should have "
            "changed");
  ask();
  EXPECT_EQ(ask(), "shoulder is asked for its state again, the last answer is missing");
  EXPECT_EQ(named(0x705, {0x00}), "BOOTUP shoulder");
  ask();
  EXPECT_EQ(named(0x705, {0x85}),
            "GUARD shoulder answers: operational, toggle 1 as before: the toggle bit should have "
            "changed")
      << "the first answer after a boot-up has toggle 0";
}

TEST_F(FrameTextTest, AHeartbeatOfAnotherLengthSaysSo) {
  EXPECT_EQ(plain(0x705, {}), "HEARTBEAT node 5 has 0 bytes instead of 1");
  EXPECT_EQ(plain(0x705, {0x05, 0x00}), "HEARTBEAT node 5 has 2 bytes instead of 1");
}

TEST_F(FrameTextTest, AShortEmcyIsNotReadAsACode) {
  EXPECT_EQ(plain(0x085, {0x11}),
            "EMCY node 5 has 1 byte instead of 8, too short for an error code: 11");
  EXPECT_EQ(plain(0x085, {0x30, 0x81}),
            "EMCY node 5 8130 life guard or heartbeat error: a node that the device monitors is "
            "silent, error register 00 (none) (2 bytes instead of 8)");
  EXPECT_EQ(plain(0x085, {}), "EMCY node 5 empty (the boot-up message of devices before CiA 301)");
  EXPECT_EQ(plain(0x085, {0x11, 0x86, 0x21}),
            "EMCY node 5 8611 following error, error register 21 (generic, profile) (3 bytes "
            "instead of 8)");
}

TEST_F(FrameTextTest, AnEmcyThatEndsAnErrorSaysWhetherOthersRemain) {
  EXPECT_EQ(plain(0x085, {0, 0, 0, 0, 0, 0, 0, 0}),
            "EMCY node 5 0000 error reset or no error, error register 00 (none)");
  EXPECT_EQ(plain(0x085, {0, 0, 0x01, 0, 0, 0, 0, 0}),
            "EMCY node 5 0000 one error is reset, others remain, error register 01 (generic)");
}

TEST_F(FrameTextTest, AnEmcyHasTheWordsOfItsDeviceData) {
  network_.plan.nodes[0].emcy_texts.push_back({0x5441, "CANopen time-out (E.CAN)"});
  network_.plan.nodes[0].emcy_cob_id = CobId::extended(0x12345);

  const auto reported =
      named_.meaning(make_frame(CobId::extended(0x12345), {0x41, 0x54, 0x81, 0, 0, 0, 0, 0}));

  EXPECT_EQ(reported.service, "EMCY");
  EXPECT_EQ(reported.text,
            "shoulder 5441 CANopen time-out (E.CAN), error register 81 (generic, manufacturer)");
}

TEST_F(FrameTextTest, SyncAndTimeMayHaveLongIdentifiers) {
  network_.plan.cycle.sync_cob_id = CobId::extended(0x80);
  network_.plan.time.cob_id = CobId::extended(0x100);

  EXPECT_EQ(named_.meaning(make_frame(CobId::extended(0x80), {0x05})).service, "SYNC");
  EXPECT_EQ(named_.meaning(make_frame(CobId::extended(0x80), {0x05})).text, "5");
  EXPECT_EQ(named_.meaning(make_frame(CobId::extended(0x100), {0, 0, 0, 0, 1, 0})).text,
            "1984-01-02 00:00:00.000, day 1 since 1984");
  EXPECT_EQ(plain(0x080, {1, 2}), "SYNC 1 (2 bytes instead of at most 1)");
}

TEST_F(FrameTextTest, RequestsToAnNmtMasterAreReported) {
  EXPECT_EQ(named(0x67F, {0x2F, 0x82, 0x1F, 0x05, 0x05, 0, 0, 0}),
            "SDO master is asked: write 1F82:05 request NMT = 5: start shoulder");
  EXPECT_EQ(named(0x67F, {0x2F, 0x82, 0x1F, 0x80, 0x06, 0, 0, 0}),
            "SDO master is asked: write 1F82:80 request NMT = 6: reset all nodes");
  EXPECT_EQ(plain(0x073, {}), "MASTER which master is active?");
  EXPECT_EQ(plain(0x071, {0x02, 0x7F}), "MASTER the active master answers: 02 7F");
  EXPECT_EQ(plain(0x075, {}), "MASTER is there a master?");
}

TEST_F(FrameTextTest, RemoteRequestsAreNotReadAsData) {
  const auto remote = [&](std::uint32_t id) {
    Frame frame = make_frame(CobId::base(id), {});
    frame.rtr = true;
    const FrameMeaning reported = named_.meaning(frame);
    return std::string{reported.service} + " " + reported.text;
  };

  EXPECT_EQ(remote(0x185), "TPDO 1 shoulder remote request");
  EXPECT_EQ(remote(0x286), "TPDO 2 node 6 remote request");
  EXPECT_EQ(remote(0x605), "SDO shoulder remote request");
  EXPECT_EQ(remote(0x085), "EMCY shoulder remote request");
  EXPECT_EQ(remote(0x080), "SYNC remote request");
}

TEST_F(FrameTextTest, EveryIdentifierAndEveryFirstByteIsReadWithoutHarm) {
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    for (unsigned first = 0; first < 256; ++first) {
      Frame frame = make_frame(CobId::base(id), {static_cast<std::uint8_t>(first), 1, 2, 3});
      frame.length = static_cast<std::uint8_t>((id + first) % 9);
      frame.rtr = first % 16 == 7;
      named_.meaning(frame);
    }
  }
}

}  // namespace
}  // namespace takt
