#include "eds_parser/budget/response_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::ElementsAre;

constexpr Time bit = microseconds{1};

std::vector<std::int64_t> in_us(const std::vector<std::optional<Time>>& times) {
  std::vector<std::int64_t> out;
  for (const auto& time : times) {
    out.push_back(time ? std::chrono::duration_cast<microseconds>(*time).count() : -1);
  }
  return out;
}

TEST(ResponseTime, TheWorstInstanceNeedNotBeTheFirst) {
  // example of Davis, Burns, Bril and Lukkien: C is late in its second instance
  const FrameStream streams[] = {{1, milliseconds{1}, microseconds{2500}, {}},
                                 {2, milliseconds{1}, microseconds{3500}, {}},
                                 {3, milliseconds{1}, microseconds{3500}, {}}};
  EXPECT_THAT(in_us(worst_responses(streams, Time{1})), ElementsAre(2000, 3000, 3500));
}

/// Four drives at 1 Mbit/s and 2 ms: NMT, SYNC, EMCY, 4 TPDOs, 4 RPDOs, SDO response and request,
/// 4 heartbeats.
std::vector<FrameStream> four_drives(Time tpdo_jitter = {}) {
  std::vector<FrameStream> streams{{0, microseconds{75}, milliseconds{1000}, {}},
                                   {1, microseconds{55}, milliseconds{2}, {}},
                                   {2, microseconds{135}, milliseconds{100}, {}}};
  const auto add = [&](int count, Time frame, Time period, Time jitter) {
    for (int i = 0; i < count; ++i) streams.push_back({streams.size(), frame, period, jitter});
  };
  add(4, microseconds{135}, milliseconds{2}, tpdo_jitter);
  add(4, microseconds{135}, milliseconds{2}, {});
  add(2, microseconds{135}, milliseconds{10}, {});
  add(4, microseconds{65}, milliseconds{100}, {});
  return streams;
}

TEST(ResponseTime, FourDrivesAtTwoMilliseconds) {
  EXPECT_THAT(in_us(worst_responses(four_drives(), bit)),
              ElementsAre(210, 265, 400, 535, 670, 805, 940, 1075, 1210, 1345, 1480, 1615, 1680,
                          1745, 1810, 1875, 1875));
}

TEST(ResponseTime, AnErrorEachTenMillisecondsDelaysAll) {
  EXPECT_THAT(in_us(worst_responses(four_drives(), bit, {1, milliseconds{10}})),
              ElementsAre(316, 371, 566, 701, 836, 971, 1106, 1241, 1376, 1511, 1646, 1781, 1846,
                          1911, 1976, 2041, 2041));
}

TEST(ResponseTime, JitterOfTpdosReachesTheNextCycle) {
  EXPECT_THAT(in_us(worst_responses(four_drives(microseconds{200}), bit)),
              ElementsAre(210, 265, 400, 735, 870, 1005, 1140, 1075, 1210, 1345, 1480, 1615, 1680,
                          1745, 1810, 3010, 3010));
}

TEST(ResponseTime, AFullBusHasNoBoundForTheLast) {
  const FrameStream streams[] = {{1, microseconds{600}, milliseconds{1}, {}},
                                 {2, microseconds{600}, milliseconds{1}, {}}};
  EXPECT_THAT(in_us(worst_responses(streams, bit)), ElementsAre(1200, -1));
}

}  // namespace
}  // namespace takt
