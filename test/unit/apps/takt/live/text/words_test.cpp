#include <gtest/gtest.h>
#include <limits>

#include "apps/takt/live/text/drive_words.hpp"
#include "apps/takt/live/text/quantity.hpp"
#include "apps/takt/live/view/timing_table.hpp"

namespace takt {
namespace {

TEST(DriveWords, NameTheBitsOfAStatusword) {
  EXPECT_EQ(statusword_text(0x0250, 0), "switch on disabled, voltage, remote");
  EXPECT_EQ(statusword_text(0x0040, 0), "switch on disabled, no voltage, not remote");
  EXPECT_EQ(statusword_text(0x1627, 8),
            "operation enabled, no voltage, remote, target reached, follows the target");
  EXPECT_EQ(statusword_text(0x3637, 6),
            "operation enabled, voltage, remote, target reached, homing attained, homing error");
  EXPECT_EQ(statusword_text(0xC298, 0), "fault, warning, voltage, remote, bit 14, bit 15");
}

TEST(DriveWords, NameTheCommandOfAControlword) {
  EXPECT_EQ(controlword_text(0x0006, 8), "shutdown");
  EXPECT_EQ(controlword_text(0x0007, 8), "switch on");
  EXPECT_EQ(controlword_text(0x010F, 8), "enable operation, halt");
  EXPECT_EQ(controlword_text(0x007F, 1), "enable operation, new set-point, at once, relative");
  EXPECT_EQ(controlword_text(0x0002, 8), "quick stop");
  EXPECT_EQ(controlword_text(0x0080, 8), "fault reset, disable voltage");
}

TEST(DriveWords, NameModes) {
  EXPECT_EQ(mode_text(8), "csp");
  EXPECT_EQ(mode_text(0), "none");
  EXPECT_EQ(mode_text(5), "5");
  EXPECT_EQ(mode_text(-3), "-3");
}

TEST(NumberText, FitsItsWidthAndNeverHidesASmallNumber) {
  EXPECT_EQ(number_text(1.25, 8, 4), "1.2500");
  EXPECT_EQ(number_text(-123.456789, 8, 4), "-123.457");
  EXPECT_EQ(number_text(123456789.0, 8, 4), "1.23e+08");
  EXPECT_EQ(number_text(0.00001234, 7, 4), "1.2e-05");
  EXPECT_EQ(number_text(0.0, 7, 4), "0.0000");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN(), 7, 4), "nan");
}

TEST(QuantityText, HasAUnitOrCounts) {
  EXPECT_EQ(quantity_text({.value = 1.5, .unit = "rad/s"}, 8), "1.5000 rad/s");
  EXPECT_EQ(quantity_text({.value = 1500.0, .unit = ""}, 8), "1500 cnt");
  EXPECT_EQ(quantity_text({}, 8), "-");
}

timing_t times_of(std::size_t octaves) {
  timing_t timing{};
  for (const char* const name : {"sync_lateness", "sync_to_publish", "command_age"}) {
    histogram_t times{};
    times.name = name;
    times.count = 500;
    times.maximum = 123'456.0F;
    times.bins.assign(octaves, 0);
    times.bins.front() = times.bins.back() = 250;
    timing.histograms.push_back(times);
  }
  return timing;
}

TEST(TimingTable, FitsEveryWidth) {
  for (const std::size_t octaves : {1U, 9U, 25U}) {
    const timing_t timing = times_of(octaves);
    for (const std::size_t width : {20U, 35U, 50U, 80U, 120U}) {
      std::string text;
      for (const Line& line : timing_lines(timing, width)) {
        EXPECT_LE(line.columns(), width) << line.render(200, false);
        text += line.render(200, false) + '\n';
      }
      for (const char* const title :
           {"times", "least", "median", "p99", "longest", "command age"}) {
        EXPECT_NE(text.find(title), std::string::npos) << title << '\n' << text;
      }
      EXPECT_NE(text.find("\u2588"), std::string::npos) << "the bars: " << text;
    }
  }
}

}  // namespace
}  // namespace takt
