#include "master/sim/bus/frame_queue.hpp"

#include <gtest/gtest.h>

namespace takt::sim {
namespace {

void push(FrameQueue& queue, std::uint32_t rank) { queue.push_back().rank = rank; }

std::vector<std::uint32_t> ranks(const FrameQueue& queue) {
  std::vector<std::uint32_t> all;
  for (const QueuedFrame& frame : queue) all.push_back(frame.rank);
  return all;
}

using Ranks = std::vector<std::uint32_t>;

TEST(FrameQueue, KeepsTheOrderOfArrivalWhileTheFirstFramesAreTaken) {
  FrameQueue queue{3};
  push(queue, 1);
  push(queue, 2);
  EXPECT_EQ(queue.take(0).rank, 1u);
  push(queue, 3);
  push(queue, 4);

  EXPECT_EQ(ranks(queue), (Ranks{2, 3, 4}));
  EXPECT_TRUE(queue.full());
  EXPECT_EQ(queue[1].rank, 3u);
}

TEST(FrameQueue, TakesAFrameFromTheMiddle) {
  FrameQueue queue{4};
  for (const std::uint32_t rank : {1u, 2u, 3u, 4u}) push(queue, rank);
  queue.take(0);

  EXPECT_EQ(queue.take(1).rank, 3u);
  EXPECT_EQ(ranks(queue), (Ranks{2, 4}));
}

TEST(FrameQueue, PutsAFrameBackInFrontOfTheOthers) {
  FrameQueue queue{3};
  push(queue, 1);
  push(queue, 2);
  queue.push_front(queue.take(0));
  EXPECT_EQ(ranks(queue), (Ranks{1, 2}));

  queue.push_front({.rank = 7});
  EXPECT_EQ(ranks(queue), (Ranks{7, 1, 2}));
}

TEST(FrameQueue, ErasesOnlyFramesThatWait) {
  FrameQueue queue{4};
  for (const std::uint32_t rank : {1u, 2u, 3u, 4u}) push(queue, rank);
  queue.take(0);

  const std::size_t erased =
      queue.erase_if([](const QueuedFrame& frame) { return frame.rank % 2 == 1; });

  EXPECT_EQ(erased, 1u);
  EXPECT_EQ(ranks(queue), (Ranks{2, 4}));
}

TEST(FrameQueue, IsEmptyWhenAllFramesAreTaken) {
  FrameQueue queue{2};
  push(queue, 1);
  queue.take(0);

  EXPECT_TRUE(queue.empty());
  push(queue, 2);
  push(queue, 3);
  EXPECT_EQ(ranks(queue), (Ranks{2, 3}));
}

}  // namespace
}  // namespace takt::sim
