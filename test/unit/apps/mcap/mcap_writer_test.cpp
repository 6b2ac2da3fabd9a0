#include "apps/mcap/mcap_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "apps/mcap/record.hpp"

namespace takt::mcap {
namespace {

using testing::ElementsAre;
using testing::Pair;

/// A file of at most `most` bytes, in memory.
class MemorySink final : public ByteSink {
 public:
  explicit MemorySink(std::uint64_t most = ~std::uint64_t{0}) : most_{most} {}
  bool reserve(std::uint64_t more) override {
    return can_reserve ? bytes.size() + more <= most_ : true;
  }
  bool write(std::string_view more) override {
    if (bytes.size() + more.size() > most_) return false;
    bytes += more;
    return true;
  }

  std::string bytes;
  bool can_reserve = true;

 private:
  std::uint64_t most_;
};

std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i > 0; --i) {
    value = value << 8U | static_cast<unsigned char>(bytes.at(at + i - 1));
  }
  return value;
}

struct Found {
  Opcode opcode{};
  std::size_t at = 0;  // of the opcode
  std::string content;
};

/// The records between the magic bytes, or those of a chunk.
std::vector<Found> records_in(std::string_view bytes) {
  std::vector<Found> found;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t length = number_at(bytes, at + 1, 8);
    found.push_back(
        {static_cast<Opcode>(bytes.at(at)), at, std::string{bytes.substr(at + 9, length)}});
    at += 9 + length;
  }
  return found;
}

std::vector<Found> records_of(const std::string& file) {
  EXPECT_TRUE(file.starts_with(magic));
  EXPECT_TRUE(file.ends_with(magic));
  auto found = records_in(std::string_view{file}.substr(8, file.size() - 16));
  for (Found& record : found) record.at += 8;
  return found;
}

std::vector<Found> only(Opcode opcode, const std::vector<Found>& all) {
  std::vector<Found> some;
  for (const Found& record : all) {
    if (record.opcode == opcode) some.push_back(record);
  }
  return some;
}

const Channel values{"/demo/image", "json", "takt.image", "jsonschema", "{}", {{"bus", "demo"}}};
const Channel events{"/demo/event", "json", "foxglove.Log", "jsonschema", "{}", {}};

TEST(Crc32, IsThatOfTheStandard) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32(""), 0U);
  Crc32 in_parts;
  in_parts.add("1234");
  in_parts.add("56789");
  EXPECT_EQ(in_parts.value(), 0xCBF43926U);
}

TEST(McapRecord, HasItsLengthInFront) {
  std::string out = "x";
  {
    const Record record{out, Opcode::data_end};
    put(out, std::uint32_t{0x04030201});
  }
  EXPECT_EQ(out, (std::string{"x\x0F\x04\0\0\0\0\0\0\0\x01\x02\x03\x04", 14}));
}

TEST(McapWriter, WritesEachByteOfAFileWithOneMessage) {
  MemorySink sink;
  McapWriter writer{sink, "takt"};
  const ChannelId channel = writer.add(values);
  EXPECT_EQ(channel, 1);
  EXPECT_TRUE(writer.write(channel, 0x1122334455667788, "{}"));
  EXPECT_TRUE(writer.finish());

  const std::string time{"\x88\x77\x66\x55\x44\x33\x22\x11", 8};
  const auto records = records_of(sink.bytes);
  EXPECT_EQ(records[0].content, (std::string{"\0\0\0\0\x04\0\0\0takt", 12}));
  EXPECT_EQ(records[1].content,
            (std::string{"\x01\0\x0A\0\0\0takt.image\x0A\0\0\0jsonschema\x02\0\0\0{}", 36}));
  EXPECT_EQ(records[2].content,
            (std::string{"\x01\0\x01\0\x0B\0\0\0/demo/image\x04\0\0\0json\x0F\0\0\0\x03\0\0\0bus"
                         "\x04\0\0\0demo",
                         46}));
  const std::string message =
      std::string{"\x05\x18\0\0\0\0\0\0\0\x01\0\0\0\0\0", 15} + time + time + "{}";
  std::string chunk = time + time + std::string{"\x21\0\0\0\0\0\0\0", 8};
  put(chunk, crc32(message));
  chunk += std::string{"\0\0\0\0\x21\0\0\0\0\0\0\0", 12} + message;
  EXPECT_EQ(records[3].opcode, Opcode::chunk);
  EXPECT_EQ(records[3].content, chunk);
  EXPECT_EQ(records[4].opcode, Opcode::message_index);
  EXPECT_EQ(records[4].content, (std::string{"\x01\0\x10\0\0\0", 6} + time + std::string(8, '\0')));
  EXPECT_EQ(records[5].opcode, Opcode::data_end);
  EXPECT_EQ(number_at(records[5].content, 0, 4),
            crc32(std::string_view{sink.bytes}.substr(0, records[5].at)));
}

TEST(McapWriter, SummaryPointsToItsRecords) {
  MemorySink sink;
  McapWriter writer{sink, "takt", 64};
  const ChannelId image = writer.add(values);
  const ChannelId event = writer.add(events);
  for (std::uint64_t i = 0; i < 5; ++i) EXPECT_TRUE(writer.write(image, 100 + i, "{\"a\":1}"));
  EXPECT_TRUE(writer.write(event, 99, "{}"));
  EXPECT_TRUE(writer.finish());
  EXPECT_EQ(writer.messages(), 6U);

  const auto records = records_of(sink.bytes);
  const auto chunks = only(Opcode::chunk, records);
  const auto indexes = only(Opcode::chunk_index, records);
  ASSERT_EQ(chunks.size(), 3U);
  ASSERT_EQ(indexes.size(), 3U);
  for (std::size_t i = 0; i < indexes.size(); ++i) {
    EXPECT_EQ(number_at(indexes[i].content, 16, 8), chunks[i].at);
    EXPECT_EQ(number_at(indexes[i].content, 24, 8), chunks[i].content.size() + 9);
    const std::uint64_t message_index = number_at(indexes[i].content, 38, 8);
    EXPECT_EQ(static_cast<Opcode>(sink.bytes.at(message_index)), Opcode::message_index);
    EXPECT_EQ(message_index, chunks[i].at + chunks[i].content.size() + 9);
  }
  EXPECT_EQ(number_at(indexes[2].content, 0, 8), 99U);  // the event came last and is the earliest
  EXPECT_EQ(number_at(indexes[2].content, 8, 8), 104U);

  const auto statistics = only(Opcode::statistics, records);
  ASSERT_EQ(statistics.size(), 1U);
  EXPECT_EQ(number_at(statistics[0].content, 0, 8), 6U);
  EXPECT_EQ(number_at(statistics[0].content, 22, 4), 3U);  // chunks
  EXPECT_EQ(number_at(statistics[0].content, 26, 8), 99U);
  EXPECT_EQ(number_at(statistics[0].content, 34, 8), 104U);
  EXPECT_EQ(number_at(statistics[0].content, 48, 8), 5U);  // of channel 1
  EXPECT_EQ(number_at(statistics[0].content, 58, 8), 1U);  // of channel 2

  const Found footer = records.back();
  const std::uint64_t summary = number_at(footer.content, 0, 8);
  const std::uint64_t offsets = number_at(footer.content, 8, 8);
  EXPECT_EQ(static_cast<Opcode>(sink.bytes.at(summary)), Opcode::schema);
  EXPECT_EQ(number_at(footer.content, 16, 4),
            crc32(std::string_view{sink.bytes}.substr(summary, footer.at + 25 - summary)));
  EXPECT_EQ(static_cast<Opcode>(sink.bytes.at(offsets)), Opcode::summary_offset);
  std::vector<std::pair<Opcode, std::size_t>> groups;
  for (const Found& offset : only(Opcode::summary_offset, records)) {
    const auto group = static_cast<Opcode>(offset.content.at(0));
    const std::uint64_t begin = number_at(offset.content, 1, 8);
    const std::uint64_t length = number_at(offset.content, 9, 8);
    const auto in_group = records_in(std::string_view{sink.bytes}.substr(begin, length));
    for (const Found& record : in_group) EXPECT_EQ(record.opcode, group);
    groups.emplace_back(group, in_group.size());
  }
  EXPECT_THAT(groups, ElementsAre(Pair(Opcode::schema, 2), Pair(Opcode::channel, 2),
                                  Pair(Opcode::chunk_index, 3), Pair(Opcode::statistics, 1)));
}

TEST(McapWriter, CountsTheMessagesOfEachChannel) {
  MemorySink sink;
  McapWriter writer{sink, "takt"};
  const ChannelId image = writer.add(values);
  const ChannelId event = writer.add(events);
  for (const ChannelId channel : {image, event, image}) {
    EXPECT_TRUE(writer.write(channel, 1, "{}"));
  }
  EXPECT_TRUE(writer.finish());
  const auto chunks = only(Opcode::chunk, records_of(sink.bytes));
  ASSERT_EQ(chunks.size(), 1U);
  std::vector<std::pair<std::uint64_t, std::uint64_t>> sequences;
  for (const Found& record : records_in(std::string_view{chunks[0].content}.substr(40))) {
    sequences.emplace_back(number_at(record.content, 0, 2), number_at(record.content, 2, 4));
  }
  EXPECT_THAT(sequences, ElementsAre(Pair(1, 0), Pair(2, 0), Pair(1, 1)));
}

TEST(McapWriter, WithoutMessagesTheFileIsComplete) {
  MemorySink sink;
  McapWriter writer{sink, "takt"};
  writer.add(values);
  EXPECT_TRUE(writer.finish());
  const auto records = records_of(sink.bytes);
  EXPECT_TRUE(only(Opcode::chunk, records).empty());
  EXPECT_EQ(only(Opcode::summary_offset, records).size(), 3U);
}

/// Whatever the size of the disk is: either the file is complete, or the writer says that it is
/// not.
TEST(McapWriter, OnAFullDiskTheFileEndsWithItsLastChunk) {
  std::uint64_t fewest = 0;
  std::uint64_t most = 0;
  for (std::uint64_t room = 0; room < 3000; room += 7) {
    MemorySink sink{room};
    McapWriter writer{sink, "takt", 128};
    const ChannelId channel = writer.add(values);
    std::uint64_t taken = 0;
    while (taken < 1000 && writer.write(channel, taken, "{\"a\":1}")) ++taken;
    EXPECT_LT(taken, 1000U);
    EXPECT_TRUE(writer.full());
    EXPECT_FALSE(writer.write(channel, taken, "{}"));
    if (!writer.finish()) {
      EXPECT_EQ(most, 0U) << "a smaller disk had room";
      fewest = room;
      continue;
    }
    std::uint64_t found = 0;
    for (const Found& chunk : only(Opcode::chunk, records_of(sink.bytes))) {
      found += records_in(std::string_view{chunk.content}.substr(40)).size();
    }
    EXPECT_EQ(found, writer.messages());
    EXPECT_GE(found, most);
    most = found;
  }
  EXPECT_GT(fewest, 0U);
  EXPECT_GT(most, 10U);
}

TEST(McapWriter, SaysThatAFileWithoutSummaryIsNotComplete) {
  MemorySink sink{400};
  sink.can_reserve = false;
  McapWriter writer{sink, "takt", 64};
  const ChannelId channel = writer.add(values);
  while (writer.write(channel, 1, "{}")) {
  }
  EXPECT_FALSE(writer.finish());
}

}  // namespace
}  // namespace takt::mcap
