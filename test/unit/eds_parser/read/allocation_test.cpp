#include <gtest/gtest.h>

#include "eds_parser/report/report.hpp"
#include "test/support/counted_new.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

std::uint64_t allocations_of(std::string_view text) {
  const auto before = allocations();
  const auto file = read_eds(text, "t.eds", 5_node);
  return allocations() - before;
}

/// Makes `count` typical objects whose names are too long for the small buffer of a string.
std::string dense(unsigned count) {
  std::string text = "[ManufacturerObjects]\nSupportedObjects=" + std::to_string(count) + "\n";
  for (unsigned i = 0; i < count; ++i) {
    text += std::to_string(i + 1) + "=" + hex(0x2000 + i) + "\n";
  }
  for (unsigned i = 0; i < count; ++i) {
    text += "[" + hex(0x2000 + i).substr(2) +
            "]\nParameterName=A name of more than sixteen letters\nObjectType=0x7\n"
            "DataType=0x0007\nAccessType=rw\nDefaultValue=0x12345678\nPDOMapping=0\n"
            "LowLimit=0\nHighLimit=0xFFFFFFFF\n";
  }
  return text;
}

TEST(Allocation, GrowsWithTheObjectsAndNoFaster) {
  const auto none = allocations_of(dense(0));
  for (const std::uint64_t count : {100U, 1000U, 10000U}) {
    const auto some = allocations_of(dense(static_cast<unsigned>(count)));
    EXPECT_GE(some, 2 * count);  // each object has a name and a value; fewer would mean that the
                                 // allocations are not counted
    EXPECT_LE(some, none + 64 + 3 * count);
  }
}

TEST(Allocation, AFileOfNothingButBracketsHasABoundedNumber) {
  constexpr std::size_t size = 10 << 20;
  std::string lines;
  lines.reserve(size);
  while (lines.size() < size) lines += "[\n";

  EXPECT_LE(allocations_of(std::string(size, '[')), 100U);
  EXPECT_LE(allocations_of(lines), 8 * Report::limit_per_rule);
}

TEST(Allocation, FindingsStopAtTheirLimit) {
  const auto faulty = [](unsigned count) {
    std::string text = "[2000]\nDataType=5\n";
    for (unsigned i = 0; i < count; ++i) text += "Nonsense" + std::to_string(i) + "=1\n";
    return text;
  };

  const auto at_limit = allocations_of(faulty(Report::limit_per_rule));
  EXPECT_LE(allocations_of(faulty(100 * Report::limit_per_rule)), at_limit + 64);
}

}  // namespace
}  // namespace takt
