#include "master/core/fixed_queue.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace takt {
namespace {

template <std::size_t N>
std::vector<int> taken(FixedQueue<int, N>& queue) {
  std::vector<int> items;
  for (int item = 0; queue.pop(item);) items.push_back(item);
  return items;
}

TEST(FixedQueue, GivesTheItemsInTheirOrder) {
  FixedQueue<int, 4> queue;
  EXPECT_TRUE(queue.empty());
  queue.push(1);
  queue.push(2);
  EXPECT_FALSE(queue.empty());
  EXPECT_EQ(queue.front(), 1);
  EXPECT_EQ(taken(queue), (std::vector{1, 2}));
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.lost(), 0U);
}

TEST(FixedQueue, ThatIsFullKeepsTheOldestItemsAndCountsTheOthers) {
  FixedQueue<int, 4> queue;
  queue.push(0);
  EXPECT_EQ(taken(queue), std::vector{0});  // The next items go over the end of the array.
  for (int item = 1; item <= 6; ++item) queue.push(item);
  EXPECT_EQ(queue.lost(), 2U);
  EXPECT_EQ(taken(queue), (std::vector{1, 2, 3, 4}));
  queue.push(7);
  EXPECT_EQ(taken(queue), std::vector{7});
  EXPECT_EQ(queue.lost(), 2U);
}

}  // namespace
}  // namespace takt
