#include "master/explain/frame/frame_text.hpp"
#include "test/unit/master/explain/frame/frame_text_fixture.hpp"

namespace takt {
namespace {

class LssTextTest : public test::FrameTextFixture {};

TEST_F(LssTextTest, LssIsNamed) {
  EXPECT_EQ(plain(0x7E5, {0x04, 0x01, 0, 0, 0, 0, 0, 0}), "LSS all devices to configuration state");
  EXPECT_EQ(plain(0x7E5, {0x40, 0x5A, 0x01, 0, 0, 0, 0, 0}), "LSS select vendor id 0x0000015A");
  EXPECT_EQ(plain(0x7E5, {0x11, 0x05, 0, 0, 0, 0, 0, 0}), "LSS node id := 5");
  EXPECT_EQ(plain(0x7E4, {0x11, 0x01, 0, 0, 0, 0, 0, 0}),
            "LSS node id: refused, the id is out of range (error 1)");
  EXPECT_EQ(plain(0x7E4, {0x5A, 0x5A, 0x01, 0, 0, 0, 0, 0}), "LSS vendor id is 0x0000015A");
  EXPECT_EQ(plain(0x7E5, {0x99, 0, 0, 0, 0, 0, 0, 0}), "LSS unknown command 0x99");
}

TEST_F(LssTextTest, EveryRequestOfTheLssMasterIsNamed) {
  EXPECT_EQ(plain(0x7E5, {0x04, 0x00, 0, 0, 0, 0, 0, 0}), "LSS all devices to waiting state");
  EXPECT_EQ(plain(0x7E5, {0x41, 0x02, 0, 0, 0, 0, 0, 0}), "LSS select product code 0x00000002");
  EXPECT_EQ(plain(0x7E5, {0x42, 0x03, 0, 0x01, 0, 0, 0, 0}), "LSS select revision 0x00010003");
  EXPECT_EQ(plain(0x7E5, {0x43, 0xA5, 0, 0, 0, 0, 0, 0}), "LSS select serial number 0x000000A5");
  EXPECT_EQ(plain(0x7E5, {0x11, 0xFF, 0, 0, 0, 0, 0, 0}), "LSS node id := none (255)");
  EXPECT_EQ(plain(0x7E5, {0x13, 0x00, 0x03, 0, 0, 0, 0, 0}),
            "LSS bit rate := 250 kbit/s (table 0, entry 3)");
  EXPECT_EQ(plain(0x7E5, {0x13, 0x00, 0x05, 0, 0, 0, 0, 0}),
            "LSS bit rate := table 0, entry 5, reserved");
  EXPECT_EQ(plain(0x7E5, {0x13, 0x00, 0x09, 0, 0, 0, 0, 0}),
            "LSS bit rate := found by the device itself (table 0, entry 9)");
  EXPECT_EQ(plain(0x7E5, {0x15, 0xE8, 0x03, 0, 0, 0, 0, 0}),
            "LSS activate the bit rate after 1000 ms of silence, send again after 2000 ms");
  EXPECT_EQ(plain(0x7E5, {0x17, 0, 0, 0, 0, 0, 0, 0}), "LSS store configuration");
  EXPECT_EQ(plain(0x7E5, {0x5B, 0, 0, 0, 0, 0, 0, 0}), "LSS inquire product code");
  EXPECT_EQ(plain(0x7E5, {0x5E, 0, 0, 0, 0, 0, 0, 0}), "LSS inquire node id");
  EXPECT_EQ(plain(0x7E5, {0x48, 0, 0, 0x01, 0, 0, 0, 0}), "LSS identify revision from 0x00010000");
  EXPECT_EQ(plain(0x7E5, {0x4B, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0}),
            "LSS identify serial to 0xFFFFFFFF");
  EXPECT_EQ(plain(0x7E5, {0x4C, 0, 0, 0, 0, 0, 0, 0}), "LSS which device has no node id?");
  EXPECT_EQ(plain(0x7E5, {0x04, 0x01}), "LSS has 2 bytes instead of 8: 04 01");
}

TEST_F(LssTextTest, EveryAnswerOfAnLssSlaveIsNamed) {
  EXPECT_EQ(plain(0x7E4, {0x44, 0, 0, 0, 0, 0, 0, 0}), "LSS selected");
  EXPECT_EQ(plain(0x7E4, {0x11, 0x00, 0, 0, 0, 0, 0, 0}), "LSS node id: done");
  EXPECT_EQ(plain(0x7E4, {0x13, 0x01, 0, 0, 0, 0, 0, 0}),
            "LSS bit rate: refused, the device does not have this bit rate (error 1)");
  EXPECT_EQ(plain(0x7E4, {0x17, 0x02, 0, 0, 0, 0, 0, 0}),
            "LSS store configuration: refused, the memory can't be written (error 2)");
  EXPECT_EQ(plain(0x7E4, {0x17, 0xFF, 0x2A, 0, 0, 0, 0, 0}),
            "LSS store configuration: refused, device error 42");
  EXPECT_EQ(plain(0x7E4, {0x5D, 0xA5, 0, 0, 0, 0, 0, 0}), "LSS serial number is 0x000000A5");
  EXPECT_EQ(plain(0x7E4, {0x5E, 0xFF, 0, 0, 0, 0, 0, 0}), "LSS node id is none (255)");
  EXPECT_EQ(plain(0x7E4, {0x4F, 0, 0, 0, 0, 0, 0, 0}),
            "LSS a device answers (identify or fastscan)");
  EXPECT_EQ(plain(0x7E4, {0x50, 0, 0, 0, 0, 0, 0, 0}), "LSS a device without node id answers");
}

TEST_F(LssTextTest, AFastscanReportsWhatItAsks) {
  EXPECT_EQ(plain(0x7E5, {0x51, 0, 0, 0, 0, 0x80, 0, 0}),
            "LSS fastscan: which device has no node id?");
  EXPECT_EQ(plain(0x7E5, {0x51, 0x50, 0x01, 0, 0, 0x03, 0, 0}),
            "LSS fastscan: vendor id 0x00000150 in bits 31 to 3?");
  EXPECT_EQ(plain(0x7E5, {0x51, 0x5A, 0x01, 0, 0, 0x00, 0, 1}),
            "LSS fastscan: vendor id 0x0000015A in bits 31 to 0? then product code");
  EXPECT_EQ(plain(0x7E5, {0x51, 0xA5, 0, 0, 0, 0x00, 3, 0}),
            "LSS fastscan: serial number 0x000000A5 in bits 31 to 0? then to configuration");
  EXPECT_EQ(plain(0x7E5, {0x51, 0, 0, 0, 0, 0x00, 9, 9}),
            "LSS fastscan: unknown part 0x00000000 in bits 31 to 0?");
}

}  // namespace
}  // namespace takt
