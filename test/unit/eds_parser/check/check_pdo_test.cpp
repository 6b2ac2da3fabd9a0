#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::find;
using test::has;
using test::line_of;
using test::read;

std::string sub(const std::string& section, int type, const std::string& value) {
  return "[" + section + "]\nParameterName=x\nDataType=" + std::to_string(type) +
         "\nAccessType=rw\nDefaultValue=" + value + "\n";
}

/// A communication record: COB-ID, transmission type, inhibit time, event timer.
struct Record {
  std::string index = "1800";
  std::string cob_id = "$NODEID+0x180";
  int type = 255;
  int inhibit = 0;
  int timer = 0;
};

/// Checks a record. Each sub-object has five lines, and sub-index 1 begins in the first line.
Findings judged(const Record& record) {
  const auto& index = record.index;
  return check(read(sub(index + "sub1", 7, record.cob_id) +
                    sub(index + "sub2", 5, std::to_string(record.type)) +
                    sub(index + "sub3", 6, std::to_string(record.inhibit)) +
                    sub(index + "sub5", 6, std::to_string(record.timer)))
                   .dictionary);
}

TEST(CheckPdo, AnInhibitTimeLongerThanTheEventTimerIsReported) {
  const auto findings = judged({.inhibit = 1001, .timer = 100});

  const auto* finding = find(findings, "pdo-inhibit-too-long");
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->severity, Severity::warning);
  EXPECT_EQ(finding->pos, (SourcePos{line_of(15), 14}));
  EXPECT_EQ(finding->message,
            "1800sub3: the inhibit time of 1001 x 100 us is longer than the event timer of 100 ms, "
            "so the device can't keep the event timer");
  for (const auto& good : {Record{.inhibit = 1000, .timer = 100}, Record{.inhibit = 1001},
                           Record{.index = "1400", .inhibit = 1001, .timer = 100},
                           Record{.type = 1, .inhibit = 1001, .timer = 100}}) {
    EXPECT_FALSE(has(judged(good), "pdo-inhibit-too-long"));
  }
  EXPECT_FALSE(has(judged({.inhibit = 65535, .timer = 65535}), "pdo-inhibit-too-long"));
}

TEST(CheckPdo, NoTransmissionTypeSparesNoOtherEntry) {
  EXPECT_TRUE(has(check(read(sub("1400sub3", 6, "100")).dictionary), "pdo-inhibit-of-rpdo"));
  EXPECT_TRUE(has(check(read(sub("1800sub6", 5, "241")).dictionary), "pdo-sync-start"));
}

TEST(CheckPdo, ASyncStartValueIsACounterOfSync) {
  const auto reported = [](const std::string& value) {
    return has(check(read(sub("1800sub6", 5, value)).dictionary), "pdo-sync-start");
  };

  EXPECT_FALSE(reported("0"));
  EXPECT_FALSE(reported("240"));
  EXPECT_TRUE(reported("241"));
}

TEST(CheckPdo, AnEventTimerBesideASynchronousTypeIsReported) {
  const auto reported = [](const Record& record) {
    return has(judged(record), "pdo-event-timer-unused");
  };

  EXPECT_TRUE(reported({.type = 1, .timer = 100}));
  EXPECT_TRUE(reported({.type = 240, .timer = 100}));
  EXPECT_TRUE(reported({.type = 252, .timer = 100}));
  EXPECT_TRUE(reported({.type = 253, .timer = 100}));
  EXPECT_FALSE(reported({.type = 1}));
  EXPECT_FALSE(reported({.type = 0, .timer = 100}));  // for some devices the timer is the event
  EXPECT_FALSE(reported({.type = 254, .timer = 100}));
  EXPECT_FALSE(reported({.index = "1400", .type = 1, .timer = 100}));  // monitors the reception
  const auto findings = judged({.type = 1, .timer = 100});
  EXPECT_EQ(find(findings, "pdo-event-timer-unused")->severity, Severity::note);
  EXPECT_EQ(find(findings, "pdo-event-timer-unused")->pos, (SourcePos{line_of(20), 14}));
}

TEST(CheckPdo, AnInhibitTimeWithoutEffectIsReported) {
  const auto reported = [](const Record& record) {
    return has(judged(record), "pdo-inhibit-unused");
  };

  for (const int type : {0, 1, 240, 252, 253}) EXPECT_TRUE(reported({.type = type, .inhibit = 1}));
  EXPECT_FALSE(reported({.type = 1}));
  EXPECT_FALSE(reported({.type = 254, .inhibit = 1}));
  EXPECT_FALSE(reported({.index = "1400", .type = 1, .inhibit = 1}));
  EXPECT_FALSE(has(check(read(sub("1800sub3", 6, "100")).dictionary), "pdo-inhibit-unused"));
  const auto findings = judged({.type = 1, .inhibit = 1});
  EXPECT_EQ(find(findings, "pdo-inhibit-unused")->severity, Severity::note);
  EXPECT_EQ(find(findings, "pdo-inhibit-unused")->pos, (SourcePos{line_of(15), 14}));
}

TEST(CheckPdo, ATypeOnRequestNeedsTheRequestAllowed) {
  const auto reported = [](const Record& record) { return has(judged(record), "pdo-rtr"); };

  EXPECT_TRUE(reported({.cob_id = "$NODEID+0x40000180", .type = 252}));
  EXPECT_TRUE(reported({.cob_id = "0x40000185", .type = 253}));
  EXPECT_FALSE(reported({.cob_id = "$NODEID+0x180", .type = 253}));
  EXPECT_FALSE(reported({.cob_id = "$NODEID+0x40000180", .type = 254}));
  EXPECT_FALSE(reported({.cob_id = "0xC0000185", .type = 253}));  // off
  EXPECT_FALSE(reported({.cob_id = "", .type = 253}));
  const auto findings = judged({.cob_id = "$NODEID+0x40000180", .type = 253});
  ASSERT_TRUE(has(findings, "pdo-rtr"));
  EXPECT_EQ(find(findings, "pdo-rtr")->pos, (SourcePos{line_of(10), 14}));
  EXPECT_EQ(find(findings, "pdo-rtr")->severity, Severity::warning);
}

}  // namespace
}  // namespace takt
