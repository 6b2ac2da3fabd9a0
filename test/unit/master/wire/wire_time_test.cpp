#include "master/wire/wire_time.hpp"

#include <array>
#include <chrono>
#include <gtest/gtest.h>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Frame base{.id = CobId::base(0x181), .length = 8};
constexpr Frame extended{.id = CobId::extended(0x181), .length = 8};

TEST(WireTime, OfOneFrameHasAFewStuffBitsInTheMeanAndOneInFourBitsAtWorst) {
  EXPECT_EQ(WireTime::mean_bits(base), 114);
  EXPECT_EQ(WireTime::worst_bits(base), 135);
  EXPECT_EQ(WireTime::mean_bits(extended), 135);
  EXPECT_EQ(WireTime::worst_bits(extended), 160);
}

TEST(WireTime, OfARemoteFrameHasNoData) {
  const Frame remote{.id = CobId::base(0x181), .length = 8, .rtr = true};
  EXPECT_EQ(WireTime::mean_bits(remote), 48);
  EXPECT_EQ(WireTime::worst_bits(remote), 55);
}

TEST(WireTime, OfSeveralFramesIsTheirSumAtTheBitrate) {
  const std::array frames{base, extended};
  EXPECT_EQ(WireTime{1'000'000}.mean(frames), 249us);
  EXPECT_EQ(WireTime{250'000}.mean(frames), 996us);
  EXPECT_EQ(WireTime{250'000}.worst(frames), 1180us);
  EXPECT_EQ(WireTime{250'000}.bits_in(1180us), 295);
}

}  // namespace
}  // namespace takt
