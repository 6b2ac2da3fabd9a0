#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::find;
using test::has;
using test::line_of;
using test::read;

std::string channel(const std::string& index, const std::string& first, const std::string& second) {
  const auto sub = [&index](const char* number, const std::string& value) {
    return "[" + index + "sub" + number +
           "]\nParameterName=x\nDataType=7\nAccessType=rw\nDefaultValue=" + value + "\n";
  };
  return sub("1", first) + sub("2", second);
}

Findings judged(const std::string& objects, std::optional<NodeId> node = std::nullopt) {
  return check(read(objects, node).dictionary);
}

TEST(CheckSdo, TheDefaultChannelFollowsFromTheNodeId) {
  const auto reported = [](const std::string& first, const std::string& second,
                           std::optional<NodeId> node) {
    const auto findings = judged(channel("1200", first, second), node);
    EXPECT_FALSE(has(findings, "cob-id-restricted"));
    return std::ranges::count(findings, "sdo-default-channel", &Finding::rule);
  };

  EXPECT_EQ(reported("$NODEID+0x600", "$NODEID+0x580", {}), 0);
  EXPECT_EQ(reported("$NODEID+0x600", "$NODEID+0x580", 5_node), 0);
  EXPECT_EQ(reported("0x605", "0x585", 5_node), 0);
  EXPECT_EQ(reported("0x605", "0x585", {}), 0);
  EXPECT_EQ(reported("", "", {}), 0);
  EXPECT_EQ(reported("0x606", "0x586", 5_node), 2);
  EXPECT_EQ(reported("$NODEID+0x580", "$NODEID+0x600", {}), 2);
  EXPECT_EQ(reported("0x600", "0x580", {}), 2);
  EXPECT_EQ(reported("0x80000000", "0x80000000", {}), 2);
  const auto findings = judged(channel("1200", "$NODEID+0x580", "$NODEID+0x580"));
  ASSERT_TRUE(has(findings, "sdo-default-channel"));
  EXPECT_EQ(find(findings, "sdo-default-channel")->severity, Severity::warning);
  EXPECT_EQ(find(findings, "sdo-default-channel")->pos, (SourcePos{line_of(5), 14}));
  EXPECT_EQ(find(findings, "sdo-default-channel")->message,
            "1200sub1: COB-ID $NODEID+0x580 differs from the COB-ID of the default SDO channel, "
            "$NODEID+0x600");
}

TEST(CheckSdo, AFurtherServerNeedsCobIdsOfItsOwn) {
  const auto restricted = judged(channel("1201", "$NODEID+0x600", "$NODEID+0x680"));

  ASSERT_TRUE(has(restricted, "cob-id-restricted"));
  EXPECT_EQ(find(restricted, "cob-id-restricted")->pos, (SourcePos{line_of(5), 14}));
  EXPECT_TRUE(has(judged(channel("127F", "0x605", "0x6C5")), "cob-id-restricted"));
  for (const auto& off : {channel("1201", "0x80000000", "0x80000605"), channel("1201", "0", "0"),
                          channel("1201", "", ""), channel("1201", "0x640", "0x5C0")}) {
    EXPECT_EQ(has(judged(off), "cob-id-restricted"), off.contains("0x640")) << off;
  }
}

/// Returns severity and message of the findings about sub-index 1 of 0x1201.
std::string declared(const std::string& cob_id, std::optional<NodeId> node = std::nullopt) {
  std::string text;
  for (const auto& finding : judged(channel("1201", cob_id, "0x80000000"), node)) {
    if (finding.rule != "cob-id-restricted") continue;
    text += std::string{name(finding.severity)} + ": " + finding.message + "\n";
  }
  return text;
}

TEST(CheckSdo, AFurtherServerOnTheChannelOfAnotherNodeIsAWarningThatNamesIt) {
  EXPECT_EQ(declared("$NODEID+0x640", 5_node),
            "warning: 1201sub1: COB-ID 0x645 is the SDO request of node 69; it works while no such "
            "node is on the bus\n");
  EXPECT_EQ(declared("0x645"),
            "warning: 1201sub1: COB-ID 0x645 is the SDO request of node 69; it works while no such "
            "node is on the bus\n");
  EXPECT_EQ(declared("$NODEID+0x640"),
            "warning: 1201sub1: COB-ID $NODEID+0x640 is the SDO request of node $NODEID+64 for "
            "nodes of 1..63; it works while no such node is on the bus\n");
  EXPECT_EQ(
      declared("$NODEID+0x5C0"),
      "warning: 1201sub1: COB-ID $NODEID+0x5C0 is the SDO answer of node $NODEID+64 for nodes "
      "of 1..63, and the SDO request of node $NODEID-64 for nodes of 65..127; it works while "
      "no such node is on the bus\n");
  EXPECT_EQ(declared("$NODEID+0x640", 64_node), "");
  EXPECT_EQ(declared("$NODEID+0x5C0", 64_node), "");
}

TEST(CheckSdo, AFurtherServerOnTheFirstChannelOfTheDeviceOrOnOtherServicesIsAnError) {
  EXPECT_EQ(declared("$NODEID+0x600", 5_node),
            "error: 1201sub1: COB-ID 0x605 is restricted (SDO requests)\n");
  EXPECT_EQ(declared("$NODEID+0x600"),
            "error: 1201sub1: COB-ID $NODEID+0x600 is restricted (SDO requests) for nodes of "
            "1..127\n");
  EXPECT_EQ(declared("$NODEID+0x700", 5_node),
            "error: 1201sub1: COB-ID 0x705 is restricted (error control)\n");
  EXPECT_EQ(declared("0x6E5"), "warning: 1201sub1: COB-ID 0x6E5 is restricted (reserved)\n");
}

TEST(CheckSdo, ACobIdOfAPdoIsTaken) {
  const auto pdo = channel("1800", "$NODEID+0x180", "");

  EXPECT_TRUE(has(judged(pdo + channel("1201", "$NODEID+0x180", "")), "cob-id-twice"));
  EXPECT_TRUE(has(judged(pdo + channel("1280", "$NODEID+0x180", "")), "cob-id-twice"));
  EXPECT_FALSE(has(judged(pdo + channel("1201", "$NODEID+0x80000180", "")), "cob-id-twice"));
  EXPECT_TRUE(has(judged(channel("1201", "0x680", "0x680")), "cob-id-twice"));
}

TEST(CheckSdo, AClientReachesTheDefaultChannelsOfOthers) {
  EXPECT_FALSE(has(judged(channel("1280", "0x601", "0x581")), "cob-id-restricted"));
  EXPECT_TRUE(has(judged(channel("1280", "0x581", "0x601")), "cob-id-restricted"));
  EXPECT_TRUE(has(judged(channel("12FF", "0x701", "0x581")), "cob-id-restricted"));
  const auto two = judged(channel("1280", "0x601", "0x581") + channel("1281", "0x601", "0x581"));
  ASSERT_TRUE(has(two, "cob-id-twice"));
  EXPECT_EQ(find(two, "cob-id-twice")->severity, Severity::warning);
}

}  // namespace
}  // namespace takt
