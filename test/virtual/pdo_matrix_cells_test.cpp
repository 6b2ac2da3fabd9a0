// Each cell of device x type x event, timer, inhibit time, RTR, SYNC, RPDO against the devices.
#include "test/virtual/pdo_matrix_cells.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <string_view>
#include <vector>

#include "test/virtual/pdo_matrix_device.hpp"

namespace takt {
namespace {

constexpr std::string_view letters = "ETIRSP";

/// "E-I---" and the like; bit i of the number is letter i.
std::string name_of(unsigned combination) {
  std::string name{letters};
  for (std::size_t i = 0; i < name.size(); ++i) {
    if ((combination >> i & 1) == 0) name[i] = '-';
  }
  return name;
}

bool matches(std::string_view pattern, std::string_view name) {
  return std::ranges::equal(pattern, name, [](char p, char n) { return p == '.' || p == n; });
}

test::TpdoRow row_of(int type, std::string_view name, const test::Cell& cell) {
  const auto has = [&](char letter) { return name.find(letter) != std::string_view::npos; };
  const auto times = [&](char letter, std::vector<int> all) {
    return has(letter) ? all : std::vector<int>{};
  };
  return {.type = static_cast<std::uint8_t>(type),
          .name = cell.why,
          .course = {.inhibit = static_cast<std::uint16_t>(has('I') ? 90 : 0),
                     .timer = static_cast<std::uint16_t>(has('T') ? 24 : 0),
                     .changes = times('E', {12, 33}),
                     .back = times('E', {14}),
                     .syncs = times('S', {10, 20, 30, 40, 50}),
                     .remote = times('R', {5, 15, 17, 37}),
                     .rpdos = times('P', {11, 26})},
          .frames = cell.frames};
}

TEST(PdoMatrix, HasEachCellOnce) {
  std::vector<std::string> types;
  for (const test::CellBlock& block : test::cell_blocks) {
    for (const int type : block.types) {
      types.push_back(std::string{block.reading} + " " + std::to_string(type));
      for (unsigned combination = 0; combination < 64; ++combination) {
        const std::string name = name_of(combination);
        EXPECT_EQ(std::ranges::count_if(
                      block.cells, [&](const auto& cell) { return matches(cell.pattern, name); }),
                  1)
            << types.back() << " " << name;
      }
    }
  }
  std::vector<std::string> wanted;
  for (const char* reading : {"301", "Lenze", "Beckhoff", "ars"}) {
    for (const char* type : {" 0", " 1", " 2", " 252", " 253", " 254", " 255"}) {
      wanted.push_back(std::string{reading} + type);
    }
  }
  for (const char* type : {" 1", " 2", " 254", " 255"}) {
    wanted.push_back(std::string{"DRV-28"} + type);
  }
  EXPECT_EQ(types, wanted);
}

TEST(PdoMatrix, DevicesSendAsEachCellSays) {
  int cells = 0;
  for (const test::CellBlock& block : test::cell_blocks) {
    const auto reading =
        std::ranges::find(test::readings, std::string_view{block.reading}, &test::Reading::name);
    ASSERT_NE(reading, test::readings.end()) << block.reading;
    for (const int type : block.types) {
      for (unsigned combination = 0; combination < 64; ++combination) {
        const std::string name = name_of(combination);
        for (const test::Cell& cell : block.cells) {
          if (!matches(cell.pattern, name)) continue;
          ++cells;
          EXPECT_EQ(test::frames_of(*reading, row_of(type, name, cell), 103), cell.frames)
              << block.reading << ", type " << type << ", " << name << ": " << cell.why;
        }
      }
    }
  }
  EXPECT_EQ(cells, 32 * 64);
}

}  // namespace
}  // namespace takt
