#include <gtest/gtest.h>

#include "test/unit/master/core/sdo/sdo_client_rig.hpp"

// Servers that answer late, with too few bytes, or with something else than the client has asked
// for. The time-out is 500 ms.

namespace takt {
namespace {

class SdoClientOdd : public SdoClientTest {
 protected:
  /// Lets the time-out pass, and expects the abort for `object`.
  void times_out(ObjectKey object) {
    now = client.deadline();
    sends(tx({0x80, static_cast<std::uint8_t>(object.index & 0xFF),
              static_cast<std::uint8_t>(object.index >> 8), object.sub, 0x00, 0x00, 0x04, 0x05}));
    const auto result = client.take_result();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->fault, SdoFault::timeout);
  }
  void ends_with(SdoFault fault, std::uint32_t abort_code) {
    const auto result = client.take_result();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->fault, fault);
    EXPECT_EQ(result->abort_code, abort_code);
  }
  /// Begins to read a value of 26 bytes.
  void begins_to_read_26_bytes() {
    upload({0x2200, 0});
    sends(tx({0x40, 0x00, 0x22, 0x00}));
    hears(rx({0x41, 0x00, 0x22, 0x00, 26}));
    sends(tx({0x60}));
  }
  /// Begins to write a value of 8 bytes.
  void begins_to_write_8_bytes() {
    download({0x2200, 0}, bytes({1, 2, 3, 4, 5, 6, 7, 8}));
    sends(tx({0x21, 0x00, 0x22, 0x00, 0x08}));
    hears(rx({0x60, 0x00, 0x22, 0x00}));
    sends(tx({0x00, 1, 2, 3, 4, 5, 6, 7}));
  }

  const Frame vendor = rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00});
};

TEST_F(SdoClientOdd, TheAnswerToARepetitionIsNotLate) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  times_out({0x1018, 1});
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  now += 1ms;
  hears(vendor);

  ends_with(SdoFault::none, 0);
  EXPECT_EQ(client.lateness(), 0ns);
}

TEST_F(SdoClientOdd, OneMoreAnswerThanRepetitionsExplainShowsThatTheFirstWasLate) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  times_out({0x1018, 1});
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  now += 120ms;
  hears(vendor);
  ends_with(SdoFault::none, 0);
  upload({0x1018, 2});
  sends(tx({0x40, 0x18, 0x10, 0x02}));
  now += 400ms;
  hears(vendor);

  EXPECT_EQ(client.lateness(), 620ms);
  EXPECT_FALSE(client.answered());
}

TEST_F(SdoClientOdd, ThreeLateAnswersCountFromTheirOwnRequests) {
  for (int i = 0; i < 2; ++i) {  // at 1 s and at 1.5 s
    upload({0x1018, 1});
    sends(tx({0x40, 0x18, 0x10, 0x01}));
    times_out({0x1018, 1});
  }
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));  // at 2 s
  now = 2200ms;
  hears(vendor);
  client.take_result();
  upload({0x1018, 2});
  sends(tx({0x40, 0x18, 0x10, 0x02}));
  now = 2300ms;
  hears(vendor);
  now = 2350ms;
  hears(vendor);

  EXPECT_EQ(client.lateness(), 1200ms);
}

TEST_F(SdoClientOdd, AnAnswerWhileAnotherObjectIsReadIsLateAtOnce) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  times_out({0x1018, 1});
  upload({0x1018, 2});
  sends(tx({0x40, 0x18, 0x10, 0x02}));
  now += 150ms;
  hears(vendor);

  EXPECT_EQ(client.lateness(), 650ms);
}

TEST_F(SdoClientOdd, TheConfirmationOfAWriteThatIsReadBackIsLateAtOnce) {
  download({0x1017, 0}, bytes({0xE8, 0x03}));
  sends(tx({0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03}));
  times_out({0x1017, 0});
  upload({0x1017, 0});
  sends(tx({0x40, 0x17, 0x10, 0x00}));
  now += 100ms;
  hears(rx({0x60, 0x17, 0x10, 0x00}));

  EXPECT_EQ(client.lateness(), 600ms);
}

TEST_F(SdoClientOdd, AFrameWithTooFewBytesIsNoLateAnswer) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  times_out({0x1018, 1});
  Frame cut = vendor;
  cut.length = 4;
  hears(cut);
  EXPECT_EQ(client.lateness(), 0ns);

  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  hears(cut);
  EXPECT_FALSE(client.take_result());
  EXPECT_EQ(client.trace().received.length, 4);
}

TEST_F(SdoClientOdd, ARestartOfTheServerEndsTheWaitForLateAnswers) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  times_out({0x1018, 1});
  client.drop();
  now += 20s;
  hears(vendor);
  EXPECT_EQ(client.lateness(), 0ns);
}

TEST_F(SdoClientOdd, SegmentsThatComeLateAreNoToggleError) {
  begins_to_read_26_bytes();  // at 1 s; each segment comes 0.9 s after its request
  times_out({0x2200, 0});
  begins_to_read_26_bytes();  // at 1.5 s
  now = 1900ms;
  hears(rx({0x00, 1, 2, 3, 4, 5, 6, 7}));  // for the request of the first try
  sends(tx({0x70}));
  now = 2400ms - 1ns;
  hears(rx({0x00, 1, 2, 3, 4, 5, 6, 7}));  // for the request of the second try

  sends(tx({0x80, 0x00, 0x22, 0x00, 0x00, 0x00, 0x04, 0x05}));
  ends_with(SdoFault::timeout, 0x05040000);
  EXPECT_EQ(client.lateness(), 900ms);

  begins_to_read_26_bytes();
  now = 2800ms;
  hears(rx({0x10, 1, 2, 3, 4, 5, 6, 7}));  // for the second request of the second try
  sends(tx({0x80, 0x00, 0x22, 0x00, 0x00, 0x00, 0x04, 0x05}));
  ends_with(SdoFault::timeout, 0x05040000);
  EXPECT_EQ(client.lateness(), 900ms);
}

TEST_F(SdoClientOdd, ConfirmationsOfSegmentsThatComeLateAreNoToggleError) {
  begins_to_write_8_bytes();  // at 1 s
  times_out({0x2200, 0});
  begins_to_write_8_bytes();  // at 1.5 s
  now = 1900ms;
  hears(rx({0x20}));
  sends(tx({0x1D, 8}));
  now = 2300ms;
  hears(rx({0x20}));

  sends(tx({0x80, 0x00, 0x22, 0x00, 0x00, 0x00, 0x04, 0x05}));
  ends_with(SdoFault::timeout, 0x05040000);
  EXPECT_EQ(client.lateness(), 900ms);
}

TEST_F(SdoClientOdd, ALateConfirmationOfASegmentDoesNotEndTheReadingBack) {
  begins_to_write_8_bytes();
  times_out({0x2200, 0});
  begins_to_read_26_bytes();
  now += 100ms;
  hears(rx({0x20}));
  EXPECT_FALSE(client.take_result());
  EXPECT_EQ(client.lateness(), 600ms);

  hears(rx({0x00, 1, 2, 3, 4, 5, 6, 7}));
  sends(tx({0x70}));
}

TEST_F(SdoClientOdd, AnInitiateInAnswerToASegmentIsAbortedAtOnceWhateverItsObject) {
  for (const std::uint8_t command : {std::uint8_t{0x43}, std::uint8_t{0x60}}) {
    begins_to_read_26_bytes();
    hears(rx({command}));
    sends(tx({0x80, 0x00, 0x22, 0x00, 0x01, 0x00, 0x04, 0x05}));
    ends_with(SdoFault::aborted_by_master, 0x05040001);

    begins_to_write_8_bytes();
    hears(rx({command, 0x01, 0x00, 0x00}));
    sends(tx({0x80, 0x00, 0x22, 0x00, 0x01, 0x00, 0x04, 0x05}));
    ends_with(SdoFault::aborted_by_master, 0x05040001);
  }
}

TEST_F(SdoClientOdd, AConfirmationThatOnlyRepeatsItselfIsAWrongAnswerAfterTheTimeOut) {
  begins_to_write_8_bytes();
  hears(rx({0x60, 0x00, 0x22, 0x00}));  // CAN may have repeated the frame
  EXPECT_FALSE(client.take_result());
  now += 500ms;
  sends(tx({0x80, 0x00, 0x22, 0x00, 0x01, 0x00, 0x04, 0x05}));
  ends_with(SdoFault::aborted_by_master, 0x05040001);
}

TEST_F(SdoClientOdd, AConfirmationThatCanRepeatsDoesNoHarm) {
  begins_to_write_8_bytes();
  hears(rx({0x60, 0x00, 0x22, 0x00}));
  hears(rx({0x20}));
  sends(tx({0x1D, 8}));
  hears(rx({0x30}));
  ends_with(SdoFault::none, 0);
}

TEST_F(SdoClientOdd, AnAnswerForObjectZeroIsRemembered) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  hears(rx({0x43, 0x00, 0x00, 0x00, 0xCD, 0xAB}));
  ASSERT_TRUE(client.answered());
  EXPECT_EQ(*client.answered(), (ObjectKey{0, 0}));
}

}  // namespace
}  // namespace takt
