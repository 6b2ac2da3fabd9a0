#include "master/lcm/link/lcm_transport.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "test/support/step_clock.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

TEST(LcmTransport, AFloodOfMessagesEndsTheRoundWithItsBudgetAndLosesNothing) {
  const auto transport = LcmTransport::create("memq://", test::StepClock{100us});
  ASSERT_NE(transport, nullptr);
  transport->subscribe("FLOOD");
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(transport->publish("FLOOD", {}));
  int heard = 0;
  int most = 0;

  for (int rounds = 0; rounds < 1000 && heard < 60; ++rounds) {
    const int before = heard;
    transport->serve([&](std::string_view, std::span<const std::byte>) { ++heard; });
    most = std::max(most, heard - before);
    EXPECT_FALSE(transport->drained()) << "the budget has ended first";
  }

  EXPECT_EQ(heard, 60);
  EXPECT_LE(most, 5) << "500 us at 100 us a message";
  transport->serve([](std::string_view, std::span<const std::byte>) {});
  EXPECT_TRUE(transport->drained());
}

}  // namespace
}  // namespace takt
