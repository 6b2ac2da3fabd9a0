#include "master/lcm/messages.hpp"

#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace takt {
namespace {

command_t a_command() {
  command_t command{};
  command.schema = 2;
  command.instance = 9;
  command.session = 7;
  command.sender = "move";
  command.cycle = 1000;
  command.time_to_live = 3;
  command.signals = {4, 5};
  command.values = {0x0F, -70000};
  command.num_values = 2;
  return command;
}

std::vector<std::byte> bytes_of(const auto& message) {
  std::vector<std::byte> buffer;
  encode(message, buffer);
  return buffer;
}

template <class T>
void expect_round_trip(const T& message) {
  const auto bytes = bytes_of(message);
  EXPECT_TRUE(decode<T>(bytes).has_value()) << T::getTypeName();
}

TEST(Messages, EveryTypeHasTheShapeThatIsChecked) {
  signal_t signal{};
  signal.node = "shoulder";
  layout_t layout{};
  layout.signals = {signal, signal};
  layout.num_signals = 2;
  node_status_t node{};
  node.holder = "move";
  status_t status{};
  status.nodes = {node, node, node};
  status.num_nodes = 3;
  histogram_t histogram{};
  histogram.bins = {1, 2, 3};
  histogram.num_bins = 3;
  timing_t timing{};
  timing.histograms = {histogram, histogram};
  timing.num_histograms = 2;
  image_t image{};
  image.values = {1, 2, 3};
  image.num_values = 3;
  image.stale = {2};
  image.num_stale = 1;
  request_t request{};
  request.data = {1, 2};
  request.size = 2;
  reply_t reply{};
  reply.data = {1};
  reply.size = 1;

  motion_command_t motion_command{};
  motion_command.goals = {motion_goal_t{}, motion_goal_t{}};
  motion_command.num_goals = 2;
  motion_t motion{};
  motion.axes = {axis_motion_t{}, axis_motion_t{}};
  motion.num_axes = 2;

  expect_round_trip(a_command());
  expect_round_trip(motion_command);
  expect_round_trip(motion);
  expect_round_trip(layout);
  expect_round_trip(status);
  expect_round_trip(timing);
  expect_round_trip(image);
  expect_round_trip(request);
  expect_round_trip(reply);
  expect_round_trip(event_t{});
}

TEST(Messages, CommandComesBackAsItWas) {
  const auto command = decode<command_t>(bytes_of(a_command()));

  ASSERT_TRUE(command);
  EXPECT_EQ(command->sender, "move");
  EXPECT_EQ(command->values, (std::vector<std::int64_t>{0x0F, -70000}));
}

TEST(Messages, AnotherTypeIsAnotherVersion) {
  const auto bytes = bytes_of(event_t{});

  EXPECT_EQ(decode<command_t>(bytes).error(), DecodeFault::other_version);
}

TEST(Messages, ATypeThatSchema1HadOtherwiseIsDeclaredToBeOfSchema1) {
  const auto begins_with = [](std::string_view hex) {
    std::vector<std::byte> bytes(16);
    for (std::size_t i = 0; i < 8; ++i) {
      const std::string byte{hex.substr(2 * i, 2)};
      bytes[i] = static_cast<std::byte>(std::stoi(byte, nullptr, 16));
    }
    return bytes;
  };

  EXPECT_EQ(decode<command_t>(begins_with("e6cf45b76fc2022e")).error(), DecodeFault::schema_1);
  EXPECT_EQ(decode<image_t>(begins_with("802677b48765da81")).error(), DecodeFault::schema_1);
  EXPECT_EQ(decode<status_t>(begins_with("b1e043970713c28c")).error(), DecodeFault::schema_1);
  EXPECT_EQ(decode<event_t>(begins_with("0000000000000000")).error(), DecodeFault::other_version);
  EXPECT_EQ(schema_refusal(1),
            "message of schema 1: rebuild the application against this takt, which uses schema 2");
}

TEST(Messages, CountsThatTheMessageCannotHoldAreRefusedWithoutMemory) {
  command_t command = a_command();
  auto bytes = bytes_of(command);
  // num_values is the int32 before two int32 and two int64
  const std::size_t at = bytes.size() - 24 - 4;
  ASSERT_EQ(bytes[at + 3], std::byte{2});

  for (const std::byte high : {std::byte{0x7F}, std::byte{0x80}, std::byte{0xFF}, std::byte{1}}) {
    bytes[at] = high;
    EXPECT_EQ(decode<command_t>(bytes).error(), DecodeFault::malformed);
  }
}

TEST(Messages, StringsOfImpossibleLengthAreRefused) {
  auto bytes = bytes_of(a_command());
  const std::size_t length_at = 8 + 8 + 2 + 8 + 8;
  ASSERT_EQ(bytes[length_at + 3], std::byte{5});

  for (const std::byte low : {std::byte{0x00}, std::byte{0xFF}}) {
    bytes[length_at + 3] = low;
    EXPECT_EQ(decode<command_t>(bytes).error(), DecodeFault::malformed);
  }
  bytes[length_at] = std::byte{0xFF};
  EXPECT_EQ(decode<command_t>(bytes).error(), DecodeFault::malformed);
}

TEST(Messages, EveryTruncationAndEveryRandomChangeIsSurvived) {
  const auto good = bytes_of(a_command());
  std::mt19937 random{1};

  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(decode<command_t>(Bytes{good}.first(size)));
  }
  for (int i = 0; i < 20000; ++i) {
    auto bytes = good;
    for (int change = 0; change < 3; ++change) {
      bytes[8 + random() % (bytes.size() - 8)] = static_cast<std::byte>(random());
    }
    const auto command = decode<command_t>(bytes);
    if (command) {
      EXPECT_EQ(command->signals.size(), command->values.size());
    }
  }
}

}  // namespace
}  // namespace takt
