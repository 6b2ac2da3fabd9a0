// Compares each cell of device x type x event, timer, inhibit time, RTR, SYNC, RPDO with the
// devices.
#include "test/virtual/pdo_matrix_cells.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "test/virtual/pdo_matrix_combination.hpp"
#include "test/virtual/pdo_matrix_device.hpp"

namespace takt {
namespace {

TEST(PdoMatrix, HasEachCellOnce) {
  std::vector<std::string> types;
  for (const test::CellBlock& block : test::cell_blocks) {
    for (const int type : block.types) {
      types.push_back(std::string{block.reading} + " " + std::to_string(type));
      for (const std::string& name : test::combinations()) {
        const auto matches = [&](const test::Cell& cell) { return test::matches(cell, name); };
        EXPECT_EQ(std::ranges::count_if(block.cells, matches), 1) << types.back() << " " << name;
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
    for (const int type : block.types) {
      for (const std::string& name : test::combinations()) {
        const test::Cell& cell = test::cell_of(block, name);
        const test::TpdoRow row = test::row_of(type, name, cell);
        EXPECT_EQ(test::frames_of(test::reading_of(block), row, 103), cell.frames)
            << block.reading << ", type " << type << ", " << name << ": " << cell.why;
        ++cells;
      }
    }
  }
  EXPECT_EQ(cells, 32 * 64);
}

}  // namespace
}  // namespace takt
