#include "apps/takt/live/acknowledged.hpp"

#include <gtest/gtest.h>

#include "test/support/folder.hpp"

namespace takt {
namespace {

TEST(Acknowledged, HoldsForANodeOfABusUpToATime) {
  Acknowledged list;
  list.add("plant", 5, 100);
  list.add("plant", 5, 90);

  EXPECT_TRUE(list.contains("plant", 5, 100));
  EXPECT_FALSE(list.contains("plant", 5, 101));
  EXPECT_FALSE(list.contains("plant", 6, 100));
  EXPECT_FALSE(list.contains("lift", 5, 100));
}

TEST(Acknowledged, IsTheSameAfterItWasWrittenAndRead) {
  const test::Folder folder;
  const auto path = folder.path() / "state/takt/acknowledged";
  Acknowledged list;
  list.add("a bus", 5, 1'700'000'000'000'000);
  list.add("plant", 127, 7);

  list.save(path);

  EXPECT_EQ(Acknowledged::load(path).text(), list.text());
  EXPECT_TRUE(Acknowledged::load(path).contains("a bus", 5, 1'700'000'000'000'000));
  EXPECT_TRUE(Acknowledged::load(folder.path() / "none").text().empty());
}

TEST(Acknowledged, LeavesOutLinesThatItCannotRead) {
  const Acknowledged list =
      Acknowledged::of("\nx\n12\n12 5\n99999999999999999999 5 plant\n7 5 plant");

  EXPECT_EQ(list.text(), "7 5 plant\n");
}

TEST(Acknowledged, DoesNotGrowWithoutBound) {
  Acknowledged list;
  for (int i = 0; i < 4'200; ++i) list.add("bus " + std::to_string(i), 1, i);

  EXPECT_TRUE(list.contains("bus 4199", 1, 4199));
  EXPECT_FALSE(list.contains("bus 0", 1, 0));
  EXPECT_LT(list.text().size(), 4096U * 32);
}

}  // namespace
}  // namespace takt
