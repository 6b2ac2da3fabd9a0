#include "master/core/sdo/sdo_client.hpp"

#include <array>
#include <gtest/gtest.h>
#include <string>

#include "test/unit/master/core/script.hpp"

namespace takt {
namespace {

/// One client of node 5 and a conversation with literal frames.
class SdoClientTest : public testing::Test {
 protected:
  void upload(ObjectKey object) { client.upload(object, buffer, 500ms); }
  void download(ObjectKey object, std::vector<std::byte> value) {
    value_ = std::move(value);
    client.download(object, value_, 500ms);
  }
  void sends(const Frame& expected) {
    Outbox out;
    client.on_time(now, out);
    ASSERT_EQ(out.frames().size(), 1U);
    EXPECT_EQ(out.frames()[0], expected);
  }
  void sends_nothing() {
    Outbox out;
    client.on_time(now, out);
    EXPECT_TRUE(out.empty());
  }
  void hears(const Frame& frame) { client.on_frame(frame, now); }
  std::string text(const SdoResult& result) {
    return {reinterpret_cast<const char*>(buffer.data()), result.size};
  }

  Time now = 1s;
  std::array<std::byte, 64> buffer{};
  std::vector<std::byte> value_;
  SdoClient client{5_node};
};

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

TEST_F(SdoClientTest, IsOwedAnAnswerFromItsRequestToTheAnswerOrTheTimeOut) {
  upload({0x1008, 0});
  EXPECT_FALSE(client.awaits_answer());
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  EXPECT_TRUE(client.awaits_answer());
  hears(rx({0x41, 0x08, 0x10, 0x00, 0x0A}));
  EXPECT_FALSE(client.awaits_answer());
  sends(tx({0x60}));
  EXPECT_TRUE(client.awaits_answer());

  now += 501ms;
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
  EXPECT_FALSE(client.awaits_answer());
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

TEST_F(SdoClientTest, ReportsTheAbortCodeOfTheDevice) {
  upload({0x3000, 0});
  sends(tx({0x40, 0x00, 0x30, 0x00}));
  hears(rx({0x80, 0x00, 0x30, 0x00, 0x00, 0x00, 0x02, 0x06}));

  const auto result = client.take_result();
  EXPECT_EQ(result->fault, SdoFault::aborted_by_device);
  EXPECT_EQ(result->abort_code, 0x06020000U);
  sends_nothing();  // an abort is never answered
}

TEST_F(SdoClientTest, TakesAnAbortInTheMiddleOfSegmentsWhateverItsObject) {
  download({0x2001, 0}, std::vector<std::byte>(20));
  sends(tx({0x21, 0x01, 0x20, 0x00, 0x14}));
  hears(rx({0x60, 0x01, 0x20, 0x00}));
  sends(tx({0x00}));
  hears(rx({0x80, 0x00, 0x00, 0x00, 0x22, 0x00, 0x00, 0x08}));
  EXPECT_EQ(client.take_result()->abort_code, 0x08000022U);

  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(rx({0x41, 0x08, 0x10, 0x00, 0x10}));
  sends(tx({0x60}));
  hears(rx({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x06, 0x06}));
  EXPECT_EQ(client.take_result()->abort_code, 0x06060000U);
}

TEST_F(SdoClientTest, AbortsWhenTheToggleBitRepeatsInAnUpload) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(rx({0x41, 0x08, 0x10, 0x00, 0x10}));
  sends(tx({0x60}));
  hears(rx({0x00, 1, 2, 3, 4, 5, 6, 7}));
  sends(tx({0x70}));
  hears(rx({0x00, 1, 2, 3, 4, 5, 6, 7}));

  sends(tx({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::aborted_by_master);
}

TEST_F(SdoClientTest, AbortsWhenTheToggleBitRepeatsInADownload) {
  download({0x2001, 0}, std::vector<std::byte>(20));
  sends(tx({0x21, 0x01, 0x20, 0x00, 0x14}));
  hears(rx({0x60, 0x01, 0x20, 0x00}));
  sends(tx({0x00}));
  hears(rx({0x30}));
  sends(tx({0x80, 0x01, 0x20, 0x00, 0x00, 0x00, 0x03, 0x05}));
  EXPECT_EQ(client.take_result()->abort_code, 0x05030000U);
}

TEST_F(SdoClientTest, AbortsWhenTheAnnouncedSizeIsOneTooSmall) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(rx({0x41, 0x08, 0x10, 0x00, 0x06}));
  sends(tx({0x60}));
  hears(rx({0x01, 1, 2, 3, 4, 5, 6, 7}));
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x12, 0x00, 0x07, 0x06}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::aborted_by_master);
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

TEST_F(SdoClientTest, RefusesWhatDoesNotFitTheBuffer) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(rx({0x41, 0x08, 0x10, 0x00, 0x41}));  // 65 bytes announced, 64 fit
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x05, 0x00, 0x04, 0x05}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::too_long);

  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(rx({0x40, 0x08, 0x10, 0x00}));  // size not announced
  for (int i = 0; i < 10; ++i) {
    const bool odd = i % 2 == 1;
    sends(odd ? tx({0x70}) : tx({0x60}));
    hears(odd ? rx({0x10, 1, 2, 3, 4, 5, 6, 7}) : rx({0x00, 1, 2, 3, 4, 5, 6, 7}));
  }
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x05, 0x00, 0x04, 0x05}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::too_long);
}

TEST_F(SdoClientTest, EndsADeviceThatSendsEmptySegmentsForEver) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(rx({0x40, 0x08, 0x10, 0x00}));
  sends(tx({0x60}));
  hears(rx({0x0E}));
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x10, 0x00, 0x07, 0x06}));
}

TEST_F(SdoClientTest, AbortsOnTheBusWhenTheDeviceStaysSilent) {
  download({0x1017, 0}, bytes({0xE8, 0x03}));
  EXPECT_EQ(client.deadline(), at_once);
  sends(tx({0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03}));
  EXPECT_EQ(client.deadline(), 1500ms);

  now = 1500ms - 1ns;
  sends_nothing();
  now = 1500ms;
  sends(tx({0x80, 0x17, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));

  const auto result = client.take_result();
  EXPECT_EQ(result->fault, SdoFault::timeout);
  EXPECT_EQ(result->abort_code, 0x05040000U);
}

TEST_F(SdoClientTest, GivesEachSegmentItsOwnTime) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  for (int i = 0; i < 4; ++i) {
    now += 499ms;
    hears(i == 0
              ? rx({0x40, 0x08, 0x10, 0x00})
              : (i % 2 == 1 ? rx({0x00, 1, 2, 3, 4, 5, 6, 7}) : rx({0x10, 1, 2, 3, 4, 5, 6, 7})));
    sends(i % 2 == 0 ? tx({0x60}) : tx({0x70}));
  }
  now += 500ms;
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
}

TEST_F(SdoClientTest, IgnoresTheLateAnswerOfAnEarlierRequest) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  now += 500ms;
  sends(tx({0x80, 0x18, 0x10, 0x01, 0x00, 0x00, 0x04, 0x05}));
  client.take_result();
  upload({0x1018, 2});
  sends(tx({0x40, 0x18, 0x10, 0x02}));

  hears(rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00}));  // late answer
  hears(rx({0x80, 0x18, 0x10, 0x01, 0x00, 0x00, 0x04, 0x05}));  // late abort
  hears(rx({0x00, 1, 2, 3, 4, 5, 6, 7}));                       // late segment
  hears(rx({0x20}));                                            // late confirmation
  hears(rx({0x60, 0x18, 0x10, 0x02}));                          // confirmation of a download
  EXPECT_FALSE(client.take_result());
  EXPECT_EQ(client.deadline(), now + 500ms);  // unrelated frames do not extend the wait

  hears(rx({0x43, 0x18, 0x10, 0x02, 0x07, 0x00, 0x00, 0x00}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);
  EXPECT_EQ(buffer[0], std::byte{7});
}

TEST_F(SdoClientTest, IgnoresAnswersBeforeItsRequestIsSent) {
  upload({0x1018, 1});
  hears(rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00}));
  EXPECT_FALSE(client.take_result());
  sends(tx({0x40, 0x18, 0x10, 0x01}));
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

TEST_F(SdoClientTest, AbortsAnswersOfABlockTransferItNeverAskedFor) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  hears(rx({0xC6, 0x18, 0x10, 0x01, 0x1D}));
  sends(tx({0x80, 0x18, 0x10, 0x01, 0x01, 0x00, 0x04, 0x05}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::aborted_by_master);
}

TEST_F(SdoClientTest, AbortsSegmentsOfTheWrongDirection) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  hears(rx({0x41, 0x08, 0x10, 0x00, 0x10}));
  sends(tx({0x60}));
  hears(rx({0x20}));
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x01, 0x00, 0x04, 0x05}));
}

TEST_F(SdoClientTest, SaysOnTheBusWhenItIsCancelled) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  client.cancel();
  EXPECT_EQ(client.take_result()->fault, SdoFault::cancelled);
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x00, 0x08}));
  EXPECT_TRUE(client.idle());
}

TEST_F(SdoClientTest, SaysNothingWhenItIsCancelledBeforeItsRequestWasSent) {
  upload({0x1008, 0});
  client.cancel();
  EXPECT_EQ(client.take_result()->fault, SdoFault::cancelled);
  sends_nothing();
}

TEST_F(SdoClientTest, ComesBackWhenTheOutboxIsFull) {
  upload({0x1018, 1});
  Outbox full;
  full.set_limit(0);
  client.on_time(now, full);
  EXPECT_EQ(client.deadline(), at_once);
  now += 10s;
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  EXPECT_EQ(client.deadline(), now + 500ms);
}

}  // namespace
}  // namespace takt
