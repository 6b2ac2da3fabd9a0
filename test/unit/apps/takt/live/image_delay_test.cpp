#include "apps/takt/live/image_delay.hpp"

#include <chrono>
#include <gtest/gtest.h>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time since_1970 = 1'700'000'000s;

/// Makes the last part of an image whose SYNC was at `sync`.
image_t image_of(Time sync) {
  image_t image{};
  image.part = 0;
  image.parts = 1;
  image.sync_mono_ns = sync.count();
  image.utime = (sync + since_1970) / 1us;
  return image;
}

TEST(ImageDelay, IsTheTimeFromSyncToTheProgramThatHearsTheImage) {
  ImageDelay delay;

  delay.take(image_of(10ms), 10ms + 700us, since_1970);
  delay.take(image_of(12ms), 12ms + 700us, since_1970 + 1ms);
  const histogram_t times = delay.finish();

  EXPECT_EQ(times.name, "sync_to_callback");
  EXPECT_EQ(times.count, 2);
  EXPECT_GT(times.minimum, 600);
  EXPECT_LT(times.maximum, 800);
  EXPECT_EQ(delay.finish().count, 0);
}

TEST(ImageDelay, CountsAnImageInPartsOnce) {
  ImageDelay delay;
  image_t image = image_of(10ms);
  image.parts = 2;

  delay.take(image, 11ms, since_1970);
  image.part = 1;
  delay.take(image, 11ms, since_1970);

  EXPECT_EQ(delay.finish().count, 1);
}

TEST(ImageDelay, LeavesOutImagesOfAMachineWithAnotherMonotonicClock) {
  ImageDelay delay;
  image_t image = image_of(10ms);
  image.sync_mono_ns += Time{20s}.count();

  delay.take(image, 11ms, since_1970);
  delay.take(image_of(10ms), 11ms, since_1970 - 1h);

  EXPECT_EQ(delay.finish().count, 0);
}

}  // namespace
}  // namespace takt
