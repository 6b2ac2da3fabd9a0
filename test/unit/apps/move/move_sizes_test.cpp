#include "apps/move/move_sizes.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(MoveSizes, FitTheUnitOfTheAxis) {
  const MoveOptions defaults;
  EXPECT_EQ(sizes_for(defaults, "rad").distance, 1.5);
  EXPECT_EQ(sizes_for(defaults, "m").distance, 0.1);
  EXPECT_EQ(sizes_for(defaults, "").distance, 10000.0);
  EXPECT_LT(sizes_for(defaults, "m").limits.velocity, 0.1);
}

TEST(MotionTime, ThatFitsNeedsNoSentence) {
  EXPECT_EQ(too_long({.move = 2.5, .sine = 0.0}, 2.5), "");
  EXPECT_EQ(too_long({.move = 2.0, .sine = 2.0}, 4.0), "");
}

TEST(MotionTime, OfTheMoveAloneCanBeTooLong) {
  EXPECT_EQ(too_long({.move = 8.3, .sine = 0.0}, 5.0),
            "the move takes 8.30 s, but --for allows 5 s: no axis moves. Give --for 8.31s or more");
}

TEST(MotionTime, LeavesRoomForOnePeriodOfTheSine) {
  EXPECT_EQ(too_long({.move = 3.0, .sine = 2.0}, 4.0),
            "the move takes 3.00 s and one period of the sine takes 2.00 s, but --for allows 4 s: "
            "no axis moves. Give --for 5.00s or more");
  EXPECT_EQ(too_long({.move = 0.0, .sine = 2.0}, 1.0),
            "one period of the sine takes 2.00 s, but --for allows 1 s: no axis moves. Give --for "
            "2.00s or more");
}

}  // namespace
}  // namespace takt
