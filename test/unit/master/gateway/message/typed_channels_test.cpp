#include "master/gateway/message/typed_channels.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

namespace takt {
namespace {

using testing::ElementsAre;

class Sent final : public Transport {
 public:
  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    channels.push_back(channel);
    bytes.assign(data.begin(), data.end());
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler&) override {}
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  bool wanted(std::string_view) const override { return heard; }

  bool heard = true;
  std::vector<std::string> channels;
  std::vector<std::byte> bytes;
};

Signal signal(const std::string& name, DataType type, std::uint8_t bits, bool output) {
  Signal made{.name = name,
              .node = 5_node,
              .object = {0x2000, 1},
              .unit = {},
              .safe_value = {},
              .seeded_from = {}};
  made.type = type;
  made.bits = bits;
  made.output = output;
  return made;
}

/// A plan with one node that has a word and a scaled position in each direction.
BusPlan lift() {
  BusPlan plan;
  plan.name = "lift";
  plan.nodes.push_back({.name = "arm", .id = 5_node});
  plan.layout.signals = {signal("word", DataType::unsigned16, 16, false),
                         signal("position", DataType::integer32, 32, false),
                         signal("control", DataType::unsigned16, 16, true),
                         signal("target", DataType::integer32, 32, true)};
  plan.layout.inputs = 2;
  for (const std::size_t scaled : {1U, 3U}) {
    plan.layout.signals[scaled].scale = 0.5;
    plan.layout.signals[scaled].unit = "rad";
  }
  return plan;
}

std::string hex_of(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    text += "0123456789abcdef"[std::to_integer<unsigned>(byte) >> 4U];
    text += "0123456789abcdef"[std::to_integer<unsigned>(byte) & 15U];
  }
  return text;
}

std::vector<std::byte> bytes_of(std::string_view hex) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoi(std::string{hex.substr(i, 2)}, nullptr, 16)));
  }
  return bytes;
}

// Bytes from the Python code that lcm-gen makes of the types that `takt export lcm` writes for
// lift().
constexpr std::string_view state_bytes =
    "3423209e0eb8892900000000000f4df800000000002dc6c0000000000000004d000000000000000c0100001237c010"
    "000000000000";
constexpr std::string_view command_bytes =
    "d3e78fee360a75cc0000000000000009000000000000004d0102030405060708000000036d6500000000000000000c"
    "00000005000000000fc010000000000000";
constexpr std::string_view nan_command_bytes =
    "d3e78fee360a75cc0000000000000009000000000000004d0102030405060708000000036d6500000000000000000c"
    "00000005000000000f7ff8000000000000";
// Bytes of a program that was built with the types of schema 1.
constexpr std::string_view old_command_bytes =
    "7856ea84513af34a0000000000000009000000000000004d000000036d6500000000000000000c000000050000000f"
    "c010000000000000";

TEST(TypedChannels, AStateIsByteForByteWhatLcmGensCodeSends) {
  const BusPlan plan = lift();
  TypedChannels typed{plan, 77};
  Sent lcm;
  const std::vector<std::int64_t> values{0x1237, -8, 0, 0};
  const std::vector<std::uint64_t> stale{2};
  const ImageView image{{.cycle = 12, .sync_time = std::chrono::milliseconds{3}}, values, stale};

  typed.publish(image, std::chrono::seconds{1}, lcm);

  EXPECT_THAT(lcm.channels, ElementsAre("LIFT_ARM_STATE"));
  EXPECT_EQ(hex_of(lcm.bytes), state_bytes);
}

TEST(TypedChannels, AStateThatNobodyHearsIsNotSent) {
  const BusPlan plan = lift();
  TypedChannels typed{plan, 77};
  Sent lcm;
  lcm.heard = false;
  const std::vector<std::int64_t> values{0x1237, -8, 0, 0};

  typed.publish({{}, values, {}}, {}, lcm);

  EXPECT_TRUE(lcm.channels.empty());
}

TEST(TypedChannels, ACommandOfLcmGensCodeBecomesSetPoints) {
  const TypedChannels typed{lift(), 77};

  const auto command = typed.command("LIFT_ARM_COMMAND", bytes_of(command_bytes));

  ASSERT_TRUE(command && *command);
  EXPECT_EQ((*command)->session, 77);
  EXPECT_EQ((*command)->sender, "me");
  EXPECT_EQ((*command)->cycle, 12);
  EXPECT_EQ((*command)->time_to_live, 5);
  EXPECT_THAT((*command)->signals, ElementsAre(2, 3));
  EXPECT_THAT((*command)->values, ElementsAre(0x000F, -8));
}

TEST(TypedChannels, AnOutputThatIsNaNIsLeftAsItIs) {
  const TypedChannels typed{lift(), 77};

  const auto command = typed.command("LIFT_ARM_COMMAND", bytes_of(nan_command_bytes));

  ASSERT_TRUE(command && *command);
  EXPECT_THAT((*command)->signals, ElementsAre(2));
}

TEST(TypedChannels, ATargetOutOfRangeStaysOutOfRange) {
  const TypedChannels typed{lift(), 77};
  const auto with_target = [&](const char* bits) {
    std::string hex{command_bytes};
    hex.replace(hex.size() - 16, 16, bits);
    return *typed.command("LIFT_ARM_COMMAND", bytes_of(hex));
  };

  const auto large = with_target("41f0000000000000");  // 2^32 rad, 2 counts a rad

  ASSERT_TRUE(large);
  EXPECT_EQ(large->values.at(1), 8589934592) << "not held at the largest that 32 bits carry";
  EXPECT_EQ(with_target("fff0000000000000").error(), DecodeFault::out_of_range);
  EXPECT_EQ(with_target("7fe0000000000000").error(), DecodeFault::out_of_range);
}

TEST(TypedChannels, OtherChannelsAreNotItsOwn) {
  const TypedChannels typed{lift(), 77};

  EXPECT_FALSE(typed.command("LIFT_COMMAND", bytes_of(command_bytes)));
  EXPECT_FALSE(typed.command("LIFT_ARM_STATE", bytes_of(command_bytes)));
  EXPECT_THAT(TypedChannels::heard(lift()), ElementsAre("LIFT_ARM_COMMAND"));
}

TEST(TypedChannels, BytesThatAreCutOrChangedAreRefused) {
  const TypedChannels typed{lift(), 77};
  const std::vector<std::byte> whole = bytes_of(command_bytes);

  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto command = typed.command("LIFT_ARM_COMMAND", Bytes{whole}.first(size));
    ASSERT_TRUE(command);
    EXPECT_FALSE(*command) << size;
  }
  std::vector<std::byte> longer = whole;
  longer.push_back({});
  EXPECT_FALSE(*typed.command("LIFT_ARM_COMMAND", longer));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::vector<std::byte> changed = whole;
    changed[at] ^= std::byte{0xFF};
    EXPECT_TRUE(typed.command("LIFT_ARM_COMMAND", changed)) << "no crash";
  }
  std::vector<std::byte> other = whole;
  other[0] ^= std::byte{1};
  EXPECT_EQ(typed.command("LIFT_ARM_COMMAND", other)->error(), DecodeFault::other_version);
}

TEST(TypedChannels, ACommandOfSchema1IsKnownAsOne) {
  const TypedChannels typed{lift(), 77};

  const auto command = typed.command("LIFT_ARM_COMMAND", bytes_of(old_command_bytes));

  ASSERT_TRUE(command);
  EXPECT_EQ(command->error(), DecodeFault::schema_1);
}

}  // namespace
}  // namespace takt
