#include "master/wire/time_of_day.hpp"

#include <array>
#include <gtest/gtest.h>

namespace takt {
namespace {

using namespace std::chrono;
using Bytes = std::array<std::uint8_t, 8>;

Bytes sent_at(sys_time<milliseconds> when) {
  const auto time = time_of_day(when.time_since_epoch());
  if (!time) return {};
  const Frame frame = time_frame(CobId::base(0x100), *time);
  EXPECT_EQ(frame.length, 6);
  return frame.data;
}

TEST(TimeOfDay, HasTheBytesOfCia301) {
  EXPECT_EQ(sent_at(sys_days{1984y / 1 / 1}), (Bytes{0x00, 0x00, 0x00, 0x00, 0x00, 0x00}));
  EXPECT_EQ(sent_at(sys_days{2000y / 3 / 1} + 12h), (Bytes{0x00, 0x2E, 0x93, 0x02, 0x10, 0x17}));
  EXPECT_EQ(sent_at(sys_days{2024y / 2 / 29} + 23h + 59min + 59s + 999ms),
            (Bytes{0xFF, 0x5B, 0x26, 0x05, 0x4D, 0x39}));
  EXPECT_EQ(sent_at(sys_days{2026y / 7 / 27} + 8h + 15min + 30s + 250ms),
            (Bytes{0xCA, 0xA5, 0xC5, 0x01, 0xBC, 0x3C}));
}

TEST(TimeOfDay, BeginsANewDayAfterTheLastMillisecond) {
  const auto last = sys_days{2024y / 2 / 29} + 23h + 59min + 59s + 999ms;
  EXPECT_EQ(sent_at(last + 1ms), (Bytes{0x00, 0x00, 0x00, 0x00, 0x4E, 0x39}));
}

TEST(TimeOfDay, IsNoneBefore1984AndAfterItsLastDay) {
  EXPECT_FALSE(time_of_day((sys_days{1984y / 1 / 1} - 1ns).time_since_epoch()));
  EXPECT_FALSE(time_of_day(-1s));
  EXPECT_TRUE(time_of_day(sys_days{2163y / 6 / 6}.time_since_epoch()));
  EXPECT_FALSE(time_of_day(sys_days{2163y / 6 / 7}.time_since_epoch()));
}

TEST(TimeOfDay, IsReadWithoutItsReservedBits) {
  const Frame sloppy = make_frame(CobId::base(0x100), {0x00, 0x2E, 0x93, 0xF2, 0x10, 0x17});
  ASSERT_TRUE(decode_time(sloppy));
  EXPECT_EQ(*decode_time(sloppy), (TimeOfDay{.days = 5904, .ms = 43'200'000}));
  EXPECT_EQ(unix_time(*decode_time(sloppy)), (sys_days{2000y / 3 / 1} + 12h).time_since_epoch());
  EXPECT_FALSE(decode_time(make_frame(CobId::base(0x100), {0x00, 0x2E, 0x93, 0x02, 0x10})));
}

}  // namespace
}  // namespace takt
