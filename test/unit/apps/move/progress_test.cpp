#include "apps/move/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt {
namespace {

using ::testing::HasSubstr;

TEST(Progress, PrintsNoControlCharactersOfTheBus) {
  ::testing::internal::CaptureStdout();

  Progress::print("axis\nshoulder\x1B[5m  1.0 rad\r\x07\xC2\x9B\n");

  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "axis\nshoulder?[5m  1.0 rad???\n");
}

TEST(Progress, SaysNoControlCharactersOfTheBus) {
  ::testing::internal::CaptureStdout();

  Progress{}.say("shoulder\x1B[5m: not enabled");

  EXPECT_THAT(::testing::internal::GetCapturedStdout(),
              HasSubstr("s  shoulder?[5m: not enabled\n"));
}

}  // namespace
}  // namespace takt
