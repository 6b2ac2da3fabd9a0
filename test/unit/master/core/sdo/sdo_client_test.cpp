// Values that come and go, expedited and by segments.
#include <gtest/gtest.h>

#include "test/unit/master/core/sdo/sdo_client_rig.hpp"

namespace takt {
namespace {

TEST_F(SdoClientTest, WritesTheHeartbeatTimeExpedited) {
  download({0x1017, 0}, bytes({0xE8, 0x03}));
  sends(tx({0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03}));
  hears(rx({0x60, 0x17, 0x10, 0x00}));

  const auto result = client.take_result();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->fault, SdoFault::none);
  EXPECT_TRUE(client.idle());
  EXPECT_EQ(client.deadline(), never);
}

TEST_F(SdoClientTest, ReadsTheVendorIdExpedited) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  hears(rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00}));

  const auto result = client.take_result();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->size, 4U);
  EXPECT_EQ(buffer[0], std::byte{0x5A});
  EXPECT_EQ(buffer[1], std::byte{0x01});
}

TEST_F(SdoClientTest, TakesTheSizeFromTheAnswer) {
  upload({0x6061, 0});
  sends(tx({0x40, 0x61, 0x60, 0x00}));
  hears(rx({0x4F, 0x61, 0x60, 0x00, 0xFF}));
  EXPECT_EQ(client.take_result()->size, 1U);

  upload({0x6041, 0});
  sends(tx({0x40, 0x41, 0x60, 0x00}));
  hears(rx({0x42, 0x41, 0x60, 0x00, 0x37, 0x02, 0x00, 0x00}));  // no size, so all four bytes count
  EXPECT_EQ(client.take_result()->size, 4U);
}

TEST_F(SdoClientTest, WritesTwentyBytesInSegments) {
  download({0x2001, 0},
           bytes({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19}));
  sends(tx({0x21, 0x01, 0x20, 0x00, 0x14}));
  hears(rx({0x60, 0x01, 0x20, 0x00}));
  sends(tx({0x00, 0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06}));
  hears(rx({0x20}));
  sends(tx({0x10, 0x07, 0x08, 0x09, 0x0A, 0x0B, 0x0C, 0x0D}));
  hears(rx({0x30}));
  sends(tx({0x03, 0x0E, 0x0F, 0x10, 0x11, 0x12, 0x13, 0x00}));
  EXPECT_FALSE(client.take_result());
  hears(rx({0x20}));

  const auto result = client.take_result();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->fault, SdoFault::none);
  EXPECT_EQ(result->size, 20U);
}

TEST_F(SdoClientTest, ReadsADeviceNameInSegments) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  EXPECT_EQ(client.announced(), 0U);
  hears(rx({0x41, 0x08, 0x10, 0x00, 0x10}));
  sends(tx({0x60}));
  EXPECT_EQ(client.announced(), 16U);
  hears(rx({0x00, 0x53, 0x61, 0x6D, 0x70, 0x6C, 0x65, 0x20}));
  sends(tx({0x70}));
  hears(rx({0x10, 0x64, 0x65, 0x76, 0x69, 0x63, 0x65, 0x20}));
  sends(tx({0x60}));
  hears(rx({0x0B, 0x76, 0x31}));

  const auto result = client.take_result();
  ASSERT_TRUE(result);
  EXPECT_EQ(text(*result), "Sample device v1");
}

TEST_F(SdoClientTest, ReadsSegmentsWithoutAnnouncedSize) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(rx({0x40, 0x08, 0x10, 0x00}));
  sends(tx({0x60}));
  EXPECT_EQ(client.announced(), 0U);
  hears(rx({0x0B, 0x76, 0x31}));
  EXPECT_EQ(text(*client.take_result()), "v1");
}

TEST_F(SdoClientTest, MovesAnEmptyValueInOneEmptySegment) {
  download({0x2001, 0}, {});
  sends(tx({0x21, 0x01, 0x20, 0x00}));
  hears(rx({0x60, 0x01, 0x20, 0x00}));
  sends(tx({0x0F}));
  hears(rx({0x20}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);

  upload({0x2001, 0});
  sends(tx({0x40, 0x01, 0x20, 0x00}));
  hears(rx({0x41, 0x01, 0x20, 0x00}));
  sends(tx({0x60}));
  hears(rx({0x0F}));
  EXPECT_EQ(client.take_result()->size, 0U);
}

TEST_F(SdoClientTest, TakesLessThanWasAnnouncedAndSaysSo) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(rx({0x41, 0x08, 0x10, 0x00, 0x08}));
  sends(tx({0x60}));
  hears(rx({0x01, 1, 2, 3, 4, 5, 6, 7}));
  sends_nothing();
  const auto result = client.take_result();
  EXPECT_EQ(result->fault, SdoFault::none);
  EXPECT_EQ(result->size, 7U);
  EXPECT_TRUE(result->shortened);
}

Frame short_rx(std::initializer_list<std::uint8_t> bytes) {
  return make_frame(CobId::base(0x585), bytes);
}

// In CiA 301 each frame has eight bytes; some devices omit the unused ones.
TEST_F(SdoClientTest, TakesShortAnswersThatSayEverything) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  hears(short_rx({0x4B, 0x18, 0x10, 0x01, 0x5A, 0x01}));
  EXPECT_EQ(client.take_result()->size, 2U);
  EXPECT_EQ(buffer[1], std::byte{1});

  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(short_rx({0x40, 0x08, 0x10, 0x00}));
  sends(tx({0x60}));
  hears(short_rx({0x0B, 'o', 'k'}));
  EXPECT_EQ(text(*client.take_result()), "ok");

  download({0x1017, 0}, bytes({1, 2, 3, 4, 5, 6, 7, 8}));
  sends(tx({0x21, 0x17, 0x10, 0x00, 0x08}));
  hears(short_rx({0x60, 0x17, 0x10, 0x00}));
  sends(tx({0x00, 1, 2, 3, 4, 5, 6, 7}));
  hears(short_rx({0x20}));
  sends(tx({0x1D, 8}));
  hears(short_rx({0x30}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);

  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  hears(short_rx({0x80, 0x18, 0x10, 0x01, 0x00, 0x00, 0x02}));
  EXPECT_EQ(client.take_result()->abort_code, 0x0002'0000U);
}

TEST_F(SdoClientTest, IgnoresAnswersThatLackAPartOfTheirValue) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  for (const Frame& frame : {short_rx({}), short_rx({0x43}), short_rx({0x43, 0x18, 0x10}),
                             short_rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00}),
                             short_rx({0x42, 0x18, 0x10, 0x01}), short_rx({0x80, 0x18, 0x10})}) {
    hears(frame);
    EXPECT_FALSE(client.take_result());
  }
  hears(short_rx({0x41, 0x18, 0x10, 0x01}));
  sends(tx({0x60}));
  hears(short_rx({0x09, 1, 2}));  // announces three bytes
  EXPECT_FALSE(client.take_result());
  sends_nothing();
}

}  // namespace
}  // namespace takt
