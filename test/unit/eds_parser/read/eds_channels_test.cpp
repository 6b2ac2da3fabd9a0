#include <algorithm>
#include <gtest/gtest.h>

#include "eds_parser/read/eds.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

EdsFile with_channels(const std::string& lines, bool supported = true) {
  return read_eds("[DeviceInfo]\nDynamicChannelsSupported=" + std::string{supported ? "1" : "0"} +
                      "\n[DynamicChannels]\n" + lines +
                      "[1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\n",
                  "plc.eds");
}

std::size_t count_of(const EdsFile& file, std::string_view rule) {
  return static_cast<std::size_t>(std::ranges::count(file.findings, rule, &Finding::rule));
}

TEST(Eds, KeepsDynamicChannels) {
  const auto file = with_channels(
      "NrOfSeg=2\nType1=0x0005\nDir1=RO\nRange1=0xA080-0xA0BF\nPPOffset1=0x10\n"
      "Type2=6\nDir2=wo\nRange2=0xA100 - 0xA13F\nPPOffset2=64\nMaxCnt2=8\n");

  ASSERT_EQ(file.dictionary.channels.size(), 2U);
  const auto& inputs = file.dictionary.channels[0];
  EXPECT_EQ(inputs.type, DataType::unsigned8);
  EXPECT_EQ(inputs.direction, Access::ro);
  EXPECT_EQ(inputs.first, 0xA080);
  EXPECT_EQ(inputs.last, 0xA0BF);
  EXPECT_EQ(inputs.offset, 16U);
  EXPECT_EQ(inputs.pos, (SourcePos{7, 8}));
  EXPECT_EQ(file.dictionary.channels[1].direction, Access::wo);
  EXPECT_EQ(file.dictionary.channels[1].most, 8U);
  for (const auto& finding : file.findings) EXPECT_FALSE(finding.rule.starts_with("channel"));
}

TEST(Eds, SaysWhatIsWrongWithDynamicChannels) {
  EXPECT_EQ(count_of(with_channels("Type1=5\n"), "channel-incomplete"), 2U);
  EXPECT_EQ(count_of(with_channels("NrOfSeg=1\nType1=5\nDir1=ro\n"), "channel-incomplete"), 1U);
  const std::string good = "NrOfSeg=1\nType1=5\nDir1=ro\n";
  for (const auto* range : {"0xA0BF-0xA080", "0x0000-0x0000", "0xA000", "0xAF00-0xB000"}) {
    const auto file = with_channels(good + "Range1=" + range + '\n');
    EXPECT_EQ(count_of(file, "channel-range"), 1U) << range;
    EXPECT_TRUE(file.dictionary.channels.empty());
  }
  EXPECT_EQ(count_of(with_channels("NrOfSeg=1\nType1=0\nDir1=ro\nRange1=0xA000-0xA001\n"),
                     "channel-type"),
            1U);
  EXPECT_EQ(count_of(with_channels("NrOfSeg=1\nType1=5\nDir1=in\nRange1=0xA000-0xA001\n"),
                     "channel-direction"),
            1U);
  EXPECT_EQ(count_of(with_channels("NrOfSeg=2\nType1=5\nDir1=ro\nRange1=0xA000-0xA010\nType2="
                                   "5\nDir2=wo\nRange2=0xA010-0xA020\n"),
                     "channel-range"),
            1U);
  EXPECT_EQ(count_of(with_channels(good + "Range1=0xA000-0xA001\n", false), "channels-unsupported"),
            1U);
  const auto none = read_eds(
      "[DeviceInfo]\nDynamicChannelsSupported=1\n[1000]\nParameterName=T\nDataType=7\n", "plc.eds");
  EXPECT_EQ(count_of(none, "channels-missing"), 1U);
}

}  // namespace
}  // namespace takt
