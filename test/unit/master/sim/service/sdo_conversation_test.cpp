#include <array>
#include <gtest/gtest.h>
#include <string>

#include "master/sim/device/device.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;
using Bytes = std::array<std::uint8_t, 8>;

/// A device after its boot-up, and a client that talks to its SDO server.
class SdoConversation : public testing::Test {
 protected:
  SdoConversation() : SdoConversation(communicating(5_node).build()) {}
  explicit SdoConversation(const DeviceTable& table) : device_{table, Random{1}} {
    device_.power_on(0ns);
    device_.on_time(50ms);
    device_.out().clear();
  }

  /// Returns the answer of the device; all bytes are zero if there is none.
  Bytes ask(Bytes request) {
    now_ += 1ms;
    device_.on_frame({.id = CobId::base(0x605), .length = 8, .data = request}, now_);
    Bytes answer{};
    for (const Transmission& item : device_.out().pending()) {
      if (item.frame.id == CobId::base(0x585)) answer = item.frame.data;
    }
    device_.out().clear();
    return answer;
  }

  Device device_;
  Time now_ = 50ms;
};

TEST_F(SdoConversation, ReadsAnIdentityExpedited) {
  EXPECT_EQ(ask({0x40, 0x18, 0x10, 0x01}), (Bytes{0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0, 0}));
}

TEST_F(SdoConversation, WritesTheHeartbeatTime) {
  EXPECT_EQ(ask({0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03}), (Bytes{0x60, 0x17, 0x10, 0x00}));
  EXPECT_EQ(ask({0x40, 0x17, 0x10, 0x00}), (Bytes{0x4B, 0x17, 0x10, 0x00, 0xE8, 0x03}));
}

TEST_F(SdoConversation, UploadsAStringInSegments) {
  EXPECT_EQ(ask({0x40, 0x08, 0x10, 0x00}), (Bytes{0x41, 0x08, 0x10, 0x00, 0x10}));
  EXPECT_EQ(ask({0x60}), (Bytes{0x00, 0x53, 0x61, 0x6D, 0x70, 0x6C, 0x65, 0x20}));
  EXPECT_EQ(ask({0x70}), (Bytes{0x10, 0x64, 0x65, 0x76, 0x69, 0x63, 0x65, 0x20}));
  EXPECT_EQ(ask({0x60}), (Bytes{0x0B, 0x76, 0x31}));
}

TEST_F(SdoConversation, DownloadsAStringInSegments) {
  EXPECT_EQ(ask({0x21, 0x04, 0x20, 0x00, 0x14}), (Bytes{0x60, 0x04, 0x20, 0x00}));
  EXPECT_EQ(ask({0x00, 0, 1, 2, 3, 4, 5, 6}), (Bytes{0x20}));
  EXPECT_EQ(ask({0x10, 7, 8, 9, 10, 11, 12, 13}), (Bytes{0x30}));
  EXPECT_EQ(ask({0x03, 14, 15, 16, 17, 18, 19, 0}), (Bytes{0x20}));

  EXPECT_EQ(ask({0x40, 0x04, 0x20, 0x00}), (Bytes{0x41, 0x04, 0x20, 0x00, 0x14}));
}

TEST_F(SdoConversation, UploadsAnEmptyStringAsOneEmptySegment) {
  EXPECT_EQ(ask({0x40, 0x04, 0x20, 0x00}), (Bytes{0x41, 0x04, 0x20, 0x00, 0x00}));
  EXPECT_EQ(ask({0x60}), (Bytes{0x0F}));
}

struct Refusal {
  const char* why;
  Bytes request;
  std::uint32_t code;
};

TEST_F(SdoConversation, RefusesWithTheCodeOfTheReason) {
  const Refusal refusals[] = {
      {"no such object", {0x40, 0x00, 0x30, 0x00}, 0x0602'0000},
      {"no such sub-object", {0x40, 0x18, 0x10, 0x09}, 0x0609'0011},
      {"write-only", {0x40, 0x02, 0x20, 0x00}, 0x0601'0001},
      {"read-only", {0x2F, 0x01, 0x20, 0x00, 1}, 0x0601'0002},
      {"constant", {0x2F, 0x18, 0x10, 0x00, 1}, 0x0601'0002},
      {"too long", {0x23, 0x00, 0x20, 0x00, 1, 0, 0, 0}, 0x0607'0012},
      {"too short", {0x2F, 0x00, 0x20, 0x00, 1}, 0x0607'0013},
      {"above its limit", {0x2B, 0x03, 0x20, 0x00, 101, 0}, 0x0609'0031},
      {"below its limit", {0x2B, 0x03, 0x20, 0x00, 0x9B, 0xFF}, 0x0609'0032},
      {"wrong signature", {0x23, 0x10, 0x10, 0x01, 1, 2, 3, 4}, 0x0800'0020},
      {"history not cleared by 0", {0x2F, 0x03, 0x10, 0x00, 1}, 0x0609'0030},
      {"history beyond its count", {0x40, 0x03, 0x10, 0x01}, 0x0800'0024},
      {"unknown command", {0xE0, 0x00, 0x20, 0x00}, 0x0504'0001},
      {"segment without transfer", {0x60}, 0x0504'0001},
      {"segmented too long", {0x21, 0x00, 0x20, 0x00, 8}, 0x0607'0012},
  };

  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.why);
    const Bytes answer = ask(refusal.request);
    EXPECT_EQ(answer[0], 0x80);
    EXPECT_EQ(answer[4] | answer[5] << 8 | answer[6] << 16 | answer[7] << 24,
              static_cast<int>(refusal.code));
  }
}

TEST_F(SdoConversation, AbortsWhenTheToggleBitRepeats) {
  ask({0x40, 0x08, 0x10, 0x00});
  ask({0x60});

  EXPECT_EQ(ask({0x60}), (Bytes{0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
}

TEST_F(SdoConversation, AbortsWhenMoreBytesComeThanWereReported) {
  ask({0x21, 0x04, 0x20, 0x00, 0x05});

  EXPECT_EQ(ask({0x01, 1, 2, 3, 4, 5, 6, 7}), (Bytes{0x80, 0x04, 0x20, 0, 0x12, 0, 0x07, 0x06}));
}

TEST_F(SdoConversation, NeverAnswersAnAbort) {
  EXPECT_EQ(ask({0x80, 0x04, 0x20, 0x00, 0, 0, 4, 5}), Bytes{});
}

TEST_F(SdoConversation, EndsATransferWhoseClientFellSilent) {
  ask({0x40, 0x08, 0x10, 0x00});

  device_.on_time(now_ + 1s);

  ASSERT_EQ(device_.out().pending().size(), 1u);
  EXPECT_EQ(device_.out().pending()[0].frame.data, (Bytes{0x80, 0x08, 0x10, 0, 0, 0, 4, 5}));
}

TEST_F(SdoConversation, TakesTheLowBytesOfAWriteWithoutSize) {
  EXPECT_EQ(ask({0x22, 0x00, 0x20, 0x00, 0xCD, 0xAB, 0xFF, 0xFF}), (Bytes{0x60, 0, 0x20, 0}));
  EXPECT_EQ(ask({0x40, 0x00, 0x20, 0x00}), (Bytes{0x4B, 0, 0x20, 0, 0xCD, 0xAB}));
}

TEST_F(SdoConversation, KeepsStoredValuesOverAResetAndRestoresThem) {
  ask({0x2B, 0x00, 0x20, 0x00, 1, 0});
  ask({0x23, 0x10, 0x10, 0x01, 0x73, 0x61, 0x76, 0x65});
  ask({0x2B, 0x00, 0x20, 0x00, 2, 0});

  device_.reset_node(now_);
  device_.on_time(now_ + 50ms);
  EXPECT_EQ(device_.objects().number({0x2000, 0}), 1);

  ask({0x23, 0x11, 0x10, 0x01, 0x6C, 0x6F, 0x61, 0x64});
  device_.reset_node(now_);
  EXPECT_EQ(device_.objects().number({0x2000, 0}), 0x1234);
}

}  // namespace
}  // namespace takt::sim
