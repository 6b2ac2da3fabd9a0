#include "master/core/pdo/pdo_fields.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace takt {
namespace {

struct Entry {
  std::int64_t value;
  unsigned bits;
  bool is_signed = false;
};

struct Vector {
  const char* name;
  std::vector<Entry> entries;
  std::vector<std::uint8_t> bytes;
};

std::vector<FieldProgram> programs(const std::vector<Entry>& entries) {
  std::vector<FieldProgram> result;
  unsigned offset = 0;
  for (const Entry& entry : entries) {
    result.push_back(compile({.signal = static_cast<SignalIndex>(result.size()),
                              .bit_offset = static_cast<std::uint8_t>(offset),
                              .bits = static_cast<std::uint8_t>(entry.bits),
                              .sign_extend = entry.is_signed}));
    offset += entry.bits;
  }
  return result;
}

// Packing vectors of the PDO fact sheet, chapter 4.
const std::vector<Vector> vectors = {
    {"A", {{0x1234, 16}, {0x56, 8}, {0x89ABCDEF, 32}}, {0x34, 0x12, 0x56, 0xEF, 0xCD, 0xAB, 0x89}},
    {"B", {{1, 1}, {0, 1}, {5, 3}, {0x3FF, 10}, {1, 1}}, {0xF5, 0xFF}},
    {"C", {{1, 1}, {0x1234, 16}, {7, 3}}, {0x69, 0x24, 0x0E}},
    {"D", {{-1, 4, true}, {0x0F, 8}, {0xABC, 12}, {-2, 16, true}}, {0xFF, 0xC0, 0xAB, 0xFE, 0xFF}},
    {"E",
     {{0x15, 5}, {0x123456, 24}, {7, 3}, {0xDEADBEEF, 32}},
     {0xD5, 0x8A, 0x46, 0xE2, 0xEF, 0xBE, 0xAD, 0xDE}},
    {"F", {{0x123456789A, 40}, {0xBCDEF0, 24}}, {0x9A, 0x78, 0x56, 0x34, 0x12, 0xF0, 0xDE, 0xBC}},
    {"G", {{0b101, 3}}, {0x05}},
    {"H",
     {{1, 1}, {0, 1}, {1, 1}, {1, 1}, {0, 1}, {0, 1}, {1, 1}, {0, 1}, {1, 1}, {1, 1}},
     {0x4D, 0x03}},
    {"64 bits", {{-2, 64, true}}, {0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}},
    {"signed bit", {{-1, 1, true}, {0, 1, true}}, {0x01}},
};

TEST(PdoFields, UnpackEveryVectorOfTheStandard) {
  for (const Vector& vector : vectors) {
    Frame frame{.id = CobId::base(0x181)};
    std::ranges::copy(vector.bytes, frame.data.begin());
    std::vector<std::int64_t> image(vector.entries.size(), 0x5555);

    unpack(load(frame), programs(vector.entries), image.data());

    for (std::size_t i = 0; i < image.size(); ++i) {
      EXPECT_EQ(image[i], vector.entries[i].value) << vector.name << " entry " << i;
    }
  }
}

TEST(PdoFields, PackEveryVectorOfTheStandard) {
  for (const Vector& vector : vectors) {
    std::uint64_t word = 0;
    const auto fields = programs(vector.entries);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      word |= put_field(vector.entries[i].value, fields[i]);
    }

    Frame frame;
    store(word, frame);

    for (std::size_t i = 0; i < 8; ++i) {
      const int expected = i < vector.bytes.size() ? vector.bytes[i] : 0;
      EXPECT_EQ(frame.data[i], expected) << vector.name << " byte " << i;
    }
  }
}

TEST(PdoFields, CutBitsThatDoNotFit) {
  const FieldProgram field = compile({.signal = 0, .bit_offset = 4, .bits = 4});
  EXPECT_EQ(put_field(0x1F3, field), 0x30U);
  EXPECT_EQ(put_field(-1, field), 0xF0U);
}

}  // namespace
}  // namespace takt
