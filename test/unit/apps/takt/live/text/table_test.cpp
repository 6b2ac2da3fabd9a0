#include "apps/takt/live/text/table.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

Table example() {
  Table table{{{.title = "NAME", .kind = Cell::name, .least = 6},
               {.title = "VALUE", .kind = Cell::number},
               {.title = "WORDS", .kind = Cell::words, .least = 8}}};
  table.add({{"shoulder_joint_1"}, {"12.5 rad"}, {"everything is well"}});
  return table;
}

std::vector<std::string> rendered(const Table& table, std::size_t width) {
  std::vector<std::string> lines;
  for (const Line& line : table.text(width).all()) lines.push_back(line.render(width, false));
  return lines;
}

using Lines = std::vector<std::string>;

TEST(Table, ShowsAllOfItsTextWhereThereIsRoom) {
  EXPECT_EQ(rendered(example(), 80), (Lines{"NAME                 VALUE  WORDS",
                                            "shoulder_joint_1  12.5 rad  everything is well"}));
}

TEST(Table, CutsNamesInTheirMiddleAndWordsAtTheirEnd) {
  EXPECT_EQ(rendered(example(), 30),
            (Lines{"NAME         VALUE WORDS", "shou~nt_1 12.5 rad everything~"}));
}

TEST(Table, FoldsItsRowsWhereThereIsNoRoom) {
  EXPECT_EQ(rendered(example(), 16),
            (Lines{"NAME       VALUE", "  WORDS", "sho~t_1 12.5 rad", "  everything is~"}));
}

TEST(Table, NeverCutsANumber) {
  Table table{{{.title = "N", .kind = Cell::number}}};
  table.add({{"123456"}});

  EXPECT_EQ(rendered(table, 4), (Lines{"   N", "####"}));
}

TEST(Line, CountsColumnsAndNotBytes) {
  EXPECT_EQ(Line{}.add("Förder").columns(), 6U);
  EXPECT_EQ(Line{}.add("軸").columns(), 2U);
  EXPECT_EQ(Line{}.add("軸軸").render(3, false), "軸");
  EXPECT_EQ(left("e\u0301x", 3), "e\u0301x ");
}

TEST(Line, KeepsBothEndsOfALongName) {
  EXPECT_EQ(shortened("conveyor_left", 8), "conv~eft");
  EXPECT_EQ(shortened("conveyor", 8), "conveyor");
  EXPECT_EQ(shortened("conveyor", 1), "~");
}

TEST(Line, HasColoursOnlyWhereTheyAreWanted) {
  const Line line = Line{}.add("good", Paint::good);

  EXPECT_EQ(line.render(80, false), "good");
  EXPECT_EQ(line.render(80, true), "\033[32mgood\033[0m");
}

TEST(Flow, BreaksBetweenItems) {
  const std::vector<Line> lines = flow({{"one"}, {""}, {"two"}, {"three"}}, 9);

  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].render(80, false), "one  two");
  EXPECT_EQ(lines[1].render(80, false), "  three");
}

}  // namespace
}  // namespace takt
