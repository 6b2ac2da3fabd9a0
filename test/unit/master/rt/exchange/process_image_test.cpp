#include "master/rt/exchange/process_image.hpp"

#include <gtest/gtest.h>
#include <thread>
#include <vector>

namespace takt {
namespace {

void publish(ImageRing& ring, std::uint64_t cycle, std::size_t signals) {
  const std::vector<std::int64_t> values(signals, static_cast<std::int64_t>(cycle));
  const std::vector<std::uint64_t> stale((signals + 63) / 64, cycle);
  ring.publish({.cycle = cycle}, values, stale);
}

TEST(ImageView, CountsTheCyclesSinceTheNewestFrameOfATpdo) {
  const PdoMark marks[]{{.cycle = 1000}, {.cycle = 997}, {.cycle = 0xFFFF'FFFE}};
  ImageView image;
  image.pdos = marks;
  image.cycle = 1000;
  EXPECT_EQ(image.age(0), 0U);
  EXPECT_EQ(image.age(1), 3U);
  image.cycle = 0x1'0000'0001;  // A mark has only the low 32 bits of the cycle.
  EXPECT_EQ(image.age(2), 3U);
}

TEST(ImageRing, GivesImagesInOrder) {
  ImageRing ring{70};
  ImageView image;
  EXPECT_FALSE(ring.take(image));
  publish(ring, 1, 70);
  publish(ring, 2, 70);

  ASSERT_TRUE(ring.take(image));
  EXPECT_EQ(image.cycle, 1U);
  ASSERT_EQ(image.values.size(), 70U);
  EXPECT_EQ(image.values[69], 1);
  EXPECT_EQ(image.stale_bits.size(), 2U);
  ASSERT_TRUE(ring.take(image));
  EXPECT_EQ(image.cycle, 2U);
  EXPECT_FALSE(ring.take(image));
}

TEST(ImageRing, TakesTheNewestAndFreesTheRest) {
  ImageRing ring{3};
  for (std::uint64_t i = 1; i <= 64; ++i) publish(ring, i, 3);
  ImageView image;
  ASSERT_TRUE(ring.take_newest(image));
  EXPECT_EQ(image.cycle, 64U);
  EXPECT_FALSE(ring.take_newest(image));
  for (std::uint64_t i = 65; i <= 127; ++i) publish(ring, i, 3);
  EXPECT_EQ(ring.overruns(), 0U);
}

TEST(ImageRing, NeverOverwritesTheImageThatIsBeingRead) {
  ImageRing ring{1};
  publish(ring, 1, 1);
  ImageView image;
  ASSERT_TRUE(ring.take(image));
  for (std::uint64_t i = 2; i <= 100; ++i) publish(ring, i, 1);
  EXPECT_EQ(image.values[0], 1);
  EXPECT_EQ(ring.overruns(), 99U - 63U);
}

TEST(ImageRing, IsNeverTornBetweenTwoThreads) {
  constexpr std::size_t signals = 200;
  constexpr std::uint64_t last = 20000;
  ImageRing ring{signals};
  std::thread bus{[&] {
    for (std::uint64_t i = 1; i <= last; ++i) publish(ring, i, signals);
  }};
  std::uint64_t newest = 0;
  std::uint64_t seen = 0;
  const auto read = [&] {
    ImageView image;
    while (ring.take(image)) {
      ASSERT_GE(image.cycle, newest);
      newest = image.cycle;
      ++seen;
      for (const std::int64_t value : image.values) {
        ASSERT_EQ(value, static_cast<std::int64_t>(image.cycle));
      }
    }
  };
  while (seen + ring.overruns() < last) read();
  bus.join();
  EXPECT_GT(seen, 0U);
}

}  // namespace
}  // namespace takt
