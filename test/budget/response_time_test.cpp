#include "eds_parser/budget/response_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <span>

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
  // This is the example of Davis, Burns, Bril and Lukkien: C is late in its second instance.
  const FrameStream streams[] = {{1, milliseconds{1}, microseconds{2500}, {}},
                                 {2, milliseconds{1}, microseconds{3500}, {}},
                                 {3, milliseconds{1}, microseconds{3500}, {}}};
  EXPECT_THAT(in_us(worst_responses(streams, Time{1})), ElementsAre(2000, 3000, 3500));
}

struct Bus {
  int drives = 4;
  Time period = milliseconds{2};
  Time tpdo_jitter{};
  int bit_us = 1;
};

/// NMT, SYNC, EMCY, a TPDO and an RPDO of each drive, SDO response and request, heartbeats.
std::vector<FrameStream> drives(const Bus& bus) {
  const auto bits = [&](int count) { return microseconds{count * bus.bit_us}; };
  std::vector<FrameStream> streams{{0, bits(75), milliseconds{1000}, {}},
                                   {1, bits(55), bus.period, {}},
                                   {2, bits(135), milliseconds{100}, {}}};
  const auto add = [&](int count, Time frame, Time period, Time jitter) {
    for (int i = 0; i < count; ++i) streams.push_back({streams.size(), frame, period, jitter});
  };
  add(bus.drives, bits(135), bus.period, bus.tpdo_jitter);
  add(bus.drives, bits(135), bus.period, {});
  add(2, bits(135), milliseconds{10}, {});
  add(bus.drives, bits(65), milliseconds{100}, {});
  return streams;
}

std::vector<FrameStream> four_drives(Time tpdo_jitter = {}) {
  return drives({.tpdo_jitter = tpdo_jitter});
}

/// Returns the response time of an RPDO of one of `drives` drives.
std::int64_t rpdo_us(const Bus& bus, int number) {
  const auto all = in_us(worst_responses(drives(bus), bus.bit_us * bit));
  return all[static_cast<std::size_t>(3 + bus.drives + number - 1)];
}

double load(std::span<const FrameStream> streams) {
  double sum = 0;
  for (const auto& stream : streams) sum += 1.0 * stream.frame / stream.period;
  return sum;
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

TEST(ResponseTime, WhatFitsWithoutServicesMayFailWithThem) {
  EXPECT_EQ(rpdo_us({.drives = 3, .period = milliseconds{1}}, 2), 1075);
  EXPECT_EQ(rpdo_us({.drives = 3, .period = milliseconds{1}}, 3), 1940);
  EXPECT_EQ(rpdo_us({.drives = 6}, 6), 2020);
  EXPECT_EQ(rpdo_us({.drives = 6, .period = milliseconds{4}, .bit_us = 2}, 6), 4040);
}

TEST(ResponseTime, TheLoadIsThatOfTheWorkedExamples) {
  EXPECT_NEAR(load(drives({})), 0.599, 5e-4);
  EXPECT_NEAR(load(drives({.drives = 3, .period = milliseconds{1}})), 0.895, 5e-4);
  EXPECT_NEAR(load(drives({.drives = 6})), 0.870, 5e-4);
  EXPECT_NEAR(load(drives({.drives = 6, .period = milliseconds{4}, .bit_us = 2})), 0.902, 5e-4);
}

/// SYNC, a TPDO and an RPDO of each drive.
std::vector<FrameStream> sync_and_pdos(int drives, Time period, Time one_bit) {
  std::vector<FrameStream> streams{{0, 55 * one_bit, period, {}}};
  for (int i = 0; i < 2 * drives; ++i) {
    streams.push_back({streams.size(), 135 * one_bit, period, {}});
  }
  return streams;
}

/// Returns the greatest number of drives of which the last PDO ends before the next SYNC, even if
/// this PDO waits for a frame of lower priority that has begun.
int most_in_time(Time period, Time one_bit) {
  for (int count = 0;; ++count) {
    auto streams = sync_and_pdos(count + 1, period, one_bit);
    streams.push_back({streams.size(), 135 * one_bit, std::chrono::seconds{1000}, {}});
    const auto last = worst_responses(streams, one_bit)[streams.size() - 2];
    if (!last || *last > period) return count;
  }
}

/// Returns the greatest number of drives that need no more than 80 % of the bus.
int most_at_80_percent(Time period, Time one_bit) {
  int count = 0;
  while (load(sync_and_pdos(count + 1, period, one_bit)) <= 0.8) ++count;
  return count;
}

TEST(ResponseTime, MostDrivesOfEachBitRateAndPeriod) {
  struct Case {
    int bit_us;
    std::vector<int> in_time;
    std::vector<int> at_80_percent;
  };
  for (const auto& [bit_us, in_time, at_80_percent] :
       {Case{1, {3, 6, 14, 36}, {2, 5, 11, 29}}, Case{2, {1, 3, 6, 17}, {1, 2, 5, 14}},
        Case{4, {0, 1, 3, 8}, {0, 1, 2, 7}}, Case{8, {0, 0, 1, 3}, {0, 0, 1, 3}}}) {
    std::vector<int> first;
    std::vector<int> second;
    for (const int ms : {1, 2, 4, 10}) {
      first.push_back(most_in_time(milliseconds{ms}, bit_us * bit));
      second.push_back(most_at_80_percent(milliseconds{ms}, bit_us * bit));
    }
    EXPECT_EQ(first, in_time) << bit_us << " us a bit";
    EXPECT_EQ(second, at_80_percent) << bit_us << " us a bit";
  }
}

TEST(ResponseTime, AFullBusHasNoBoundForTheLast) {
  const FrameStream streams[] = {{1, microseconds{600}, milliseconds{1}, {}},
                                 {2, microseconds{600}, milliseconds{1}, {}}};
  EXPECT_THAT(in_us(worst_responses(streams, bit)), ElementsAre(1200, -1));
}

}  // namespace
}  // namespace takt
