#pragma once
// The combinations of events in the cells of the PDO matrix, and the row for each combination.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "test/virtual/pdo_matrix_cells.hpp"
#include "test/virtual/pdo_matrix_table.hpp"

namespace takt::test {

/// Returns the 64 names from "------" to "ETIRSP".
inline std::vector<std::string> combinations() {
  std::vector<std::string> names;
  for (unsigned bits = 0; bits < 64; ++bits) {
    std::string name = "ETIRSP";
    for (std::size_t i = 0; i < name.size(); ++i) {
      if ((bits >> i & 1) == 0) name[i] = '-';
    }
    names.push_back(name);
  }
  return names;
}

inline bool matches(const Cell& cell, std::string_view name) {
  return std::ranges::equal(std::string_view{cell.pattern}, name,
                            [](char p, char n) { return p == '.' || p == n; });
}

inline const Cell& cell_of(const CellBlock& block, std::string_view name) {
  return *std::ranges::find_if(block.cells, [&](const Cell& cell) { return matches(cell, name); });
}

inline const Reading& reading_of(const CellBlock& block) {
  return *std::ranges::find(readings, std::string_view{block.reading}, &Reading::name);
}

inline TpdoRow row_of(int type, std::string_view name, const Cell& cell) {
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

}  // namespace takt::test
