#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "apps/takt/spy/channel_table.hpp"
#include "apps/takt/spy/message_types.hpp"
#include "apps/takt/spy/message_values.hpp"
#include "master/lcm/messages.hpp"

namespace takt::spy {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

std::string value_of(const std::vector<Value>& values, const std::string& name) {
  const auto found = std::ranges::find(values, name, &Value::name);
  return found == values.end() ? "none" : found->text;
}

TEST(MessageTypes, AreThoseOfTheFiles) {
  const MessageTypes& types = own_types();
  EXPECT_GE(types.size(), 22U);
  const auto& image = types.at("image_t");
  EXPECT_EQ(image.front().name, "utime");
  EXPECT_EQ(image.front().comment, "wall clock of SYNC, microseconds since 1970");
  const auto stale = std::ranges::find(image, "stale", &Member::name);
  ASSERT_NE(stale, image.end());
  EXPECT_EQ(stale->type, "int32_t");
  EXPECT_EQ(stale->dimensions, std::vector<std::string>{"num_stale"});
}

TEST(MessageTypes, AreFoundByTheirFingerprint) {
  EXPECT_EQ(own_type(static_cast<std::uint64_t>(event_t::getHash())), "event_t");
  EXPECT_EQ(own_type(static_cast<std::uint64_t>(image_t::getHash())), "image_t");
  EXPECT_EQ(own_type(1), "");
}

event_t make_event() {
  event_t event{};
  event.utime = 1'700'000'000'000'000;
  event.cycle = -3;
  event.severity = 2;
  event.node = "elbow";
  event.text = "EMCY\n0x8130";
  return event;
}

TEST(DecodeValues, HasNamesAndComments) {
  std::vector<std::byte> buffer;
  const auto values = decode_values(own_types(), "event_t", encode(make_event(), buffer));
  ASSERT_TRUE(values) << values.error();
  EXPECT_EQ(value_of(*values, "utime"), "1700000000000000");
  EXPECT_EQ(value_of(*values, "cycle"), "-3");
  EXPECT_EQ(value_of(*values, "node"), "\"elbow\"");
  EXPECT_EQ(value_of(*values, "text"), "\"EMCY?0x8130\"");
  EXPECT_EQ(std::ranges::find(*values, "severity", &Value::name)->comment,
            "0 note, 1 warning, 2 error");
}

TEST(DecodeValues, GoesIntoListsOfStructs) {
  layout_t layout{};
  layout.period_ns = 2'000'000;
  layout.num_signals = 2;
  layout.signals.resize(2);
  layout.signals[1].name = "statusword";
  layout.signals[1].scale = 1e-3;
  std::vector<std::byte> buffer;
  const auto values = decode_values(own_types(), "layout_t", encode(layout, buffer));
  ASSERT_TRUE(values) << values.error();
  EXPECT_EQ(value_of(*values, "signals[1].name"), "\"statusword\"");
  EXPECT_EQ(value_of(*values, "signals[1].scale"), "0.001");
  EXPECT_EQ(value_of(*values, "signals[2].name"), "none");
}

TEST(DecodeValues, ShortensLongLists) {
  image_t image{};
  for (int i = 0; i < 100; ++i) image.values.push_back(i);
  image.num_values = 100;
  std::vector<std::byte> buffer;
  const auto values = decode_values(own_types(), "image_t", encode(image, buffer));
  ASSERT_TRUE(values) << values.error();
  EXPECT_THAT(value_of(*values, "values"), HasSubstr("14, 15, ... 100 in all]"));
}

/// Each message that is cut off or changed anywhere gives a sentence or values, never more.
TEST(DecodeValues, HoldsAgainstAnyBytes) {
  std::vector<std::byte> buffer;
  layout_t layout{};
  layout.num_signals = 1;
  layout.signals.resize(1);
  const Bytes whole = encode(layout, buffer);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_FALSE(decode_values(own_types(), "layout_t", whole.first(length)));
  }
  for (std::size_t at = 8; at < buffer.size(); ++at) {
    for (const int byte : {0x00, 0x7F, 0x80, 0xFF}) {
      std::vector<std::byte> changed = buffer;
      changed[at] = static_cast<std::byte>(byte);
      const auto values = decode_values(own_types(), "layout_t", changed);
      EXPECT_TRUE(values || !values.error().empty());
    }
  }
  EXPECT_FALSE(decode_values(own_types(), "layout_t", std::vector<std::byte>(200)));
  EXPECT_FALSE(decode_values(own_types(), "no_type_t", whole));
}

TEST(DecodeValues, ATypeThatContainsItselfEnds) {
  const MessageTypes types = parse_types("struct a_t\n{\n  a_t next;\n}\n");
  EXPECT_FALSE(decode_values(types, "a_t", std::vector<std::byte>(100)));
}

std::vector<std::string> texts(const ChannelTable& table, Time now) {
  std::vector<std::string> texts;
  for (const Line& line : table.lines(now)) texts.push_back(line.render(80, false));
  return texts;
}

TEST(ChannelTable, HasTypeRateAgeAndSize) {
  ChannelTable table{0s};
  std::vector<std::byte> buffer;
  const Bytes event = encode(make_event(), buffer);
  for (int i = 0; i < 500; ++i) table.take("DEMO_EVENT", event, i * 2ms);
  table.take("OTHER", Bytes{buffer}.first(3), 1s);
  table.tick(1s);
  const auto lines = texts(table, 1250ms);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "CHANNEL       TYPE                   1/s      AGE  BYTES");
  EXPECT_EQ(lines[1], "DEMO_EVENT    event_t                500   252 ms     " +
                          std::to_string(event.size()));
  EXPECT_THAT(lines[2], HasSubstr("OTHER         0x0000000000000000     1.0   250 ms      3"));
}

TEST(ChannelTable, FitsATerminal) {
  ChannelTable table{0s};
  const std::vector<std::byte> bytes(2'000'000, std::byte{0xFF});
  table.take(std::string(63, 'X'), bytes, 0s);
  for (const Line& line : table.lines(500h)) EXPECT_LE(line.render(1000, false).size(), 80U);
}

TEST(ChannelTable, IsBounded) {
  ChannelTable table{0s};
  const std::vector<std::byte> bytes(8);
  for (int i = 0; i < 5000; ++i) table.take("C" + std::to_string(i), bytes, 0s);
  EXPECT_EQ(table.channels().size(), ChannelTable::most_channels);
  EXPECT_THAT(texts(table, 0s).back(), HasSubstr("4000 messages of further channels"));
}

}  // namespace
}  // namespace takt::spy
