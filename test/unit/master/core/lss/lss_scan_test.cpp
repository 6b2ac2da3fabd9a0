#include "master/core/lss/lss_scan.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

namespace takt {
namespace {

using Question = lss::FastScan;

/// Devices without a node-ID, as in CiA 305, together on one bus.
struct Slaves {
  struct Slave {
    LssAddress address;
    std::uint8_t part = 0;
    bool configuration = false;
  };
  std::vector<Slave> all;

  bool answers(const Question& question) {
    bool answered = false;
    for (Slave& slave : all) {
      if (slave.configuration) continue;
      if (question.bit_check == 0x80) {
        slave.part = 0;
        answered = true;
      } else if (question.part == slave.part &&
                 ((slave.address[question.part] ^ question.number) >> question.bit_check) == 0) {
        slave.part = question.next;
        slave.configuration = question.bit_check == 0 && question.next < question.part;
        answered = true;
      }
    }
    return answered;
  }
};

constexpr LssAddress sample{0x15A, 2, 0x0001'0003, 0xA5};

TEST(LssFastScan, AsksWhatTheStandardAsksFor) {
  Slaves slaves{{{.address = sample}}};
  LssFastScan scan;
  std::vector<Question> asked;
  std::vector<bool> answers;

  while (scan.state() == LssScanState::running && asked.size() < 1000) {
    asked.push_back(scan.question());
    answers.push_back(slaves.answers(scan.question()));
    scan.on_reaction(answers.back());
  }

  ASSERT_EQ(scan.state(), LssScanState::found);
  EXPECT_EQ(scan.address(), sample);
  ASSERT_EQ(asked.size(), 133U);
  EXPECT_TRUE(slaves.all[0].configuration);
  // The questions around the bits of vendor-ID 0x15A, derived from the algorithm in the standard.
  EXPECT_EQ(asked[0], (Question{0, 0x80, 0, 0}));
  EXPECT_EQ(asked[1], (Question{0, 0x1F, 0, 0}));
  EXPECT_EQ(asked[24], (Question{0, 0x08, 0, 0}));
  EXPECT_FALSE(answers[24]);
  EXPECT_EQ(asked[25], (Question{0x100, 0x07, 0, 0}));
  EXPECT_EQ(asked[26], (Question{0x100, 0x06, 0, 0}));
  EXPECT_EQ(asked[27], (Question{0x140, 0x05, 0, 0}));
  EXPECT_EQ(asked[29], (Question{0x150, 0x03, 0, 0}));
  EXPECT_EQ(asked[32], (Question{0x15A, 0x00, 0, 0}));
  EXPECT_EQ(asked[33], (Question{0x15A, 0x00, 0, 1}));
  EXPECT_EQ(asked[34], (Question{0, 0x1F, 1, 1}));
  EXPECT_EQ(asked[131], (Question{0xA4, 0x00, 3, 3}));
  EXPECT_FALSE(answers[131]);
  EXPECT_EQ(asked[132], (Question{0xA5, 0x00, 3, 0}));
  // The start and four confirmations are answered; 5, 1, 3 and 4 bits get no answer.
  EXPECT_EQ(std::ranges::count(answers, false), 5 + 1 + 3 + 4);
}

TEST(LssFastScan, FindsTheLowestAddressFirst) {
  Slaves slaves{{{.address = {0x15A, 2, 1, 0x8000'0000}},
                 {.address = {0x15A, 2, 1, 0x7FFF'FFFF}},
                 {.address = {0x15A, 2, 1, 0xFFFF'FFFF}},
                 {.address = {0x15A, 2, 1, 0}}}};
  std::vector<std::uint32_t> serials;
  for (int round = 0; round < 5; ++round) {
    LssFastScan scan;
    while (scan.state() == LssScanState::running) scan.on_reaction(slaves.answers(scan.question()));
    if (scan.state() == LssScanState::found) serials.push_back(scan.address()[3]);
    EXPECT_EQ(scan.state(), round < 4 ? LssScanState::found : LssScanState::nobody);
  }
  EXPECT_EQ(serials, (std::vector<std::uint32_t>{0, 0x7FFF'FFFF, 0x8000'0000, 0xFFFF'FFFF}));
}

TEST(LssFastScan, AsksOnlyForBitsThatAreNotKnown) {
  Slaves slaves{{{.address = sample}}};
  LssFastScan scan{{0x15A, 2, 0x0001'0000, 0}, {~0U, ~0U, 0xFFFF'0000, 0}};
  int asked = 0;
  for (; scan.state() == LssScanState::running; ++asked) {
    scan.on_reaction(slaves.answers(scan.question()));
  }
  EXPECT_EQ(scan.address(), sample);
  EXPECT_EQ(asked, 1 + 1 + 1 + 17 + 33);
}

TEST(LssFastScan, FindsNobodyWhereTheKnownPartsBelongToNobody) {
  Slaves slaves{{{.address = sample}}};
  LssFastScan scan{{0x15B, 2, 0, 0}, {~0U, ~0U, 0, 0}};
  while (scan.state() == LssScanState::running) scan.on_reaction(slaves.answers(scan.question()));
  EXPECT_EQ(scan.state(), LssScanState::nobody);
  EXPECT_FALSE(slaves.all[0].configuration);
}

TEST(LssFastScan, AsksASecondTimeBeforeItBelievesThatNobodyIsThere) {
  Slaves slaves{{{.address = sample}}};
  LssFastScan scan;
  scan.on_reaction(false);
  EXPECT_TRUE(scan.doubtful());
  EXPECT_EQ(scan.question(), LssFastScan{}.question());
  while (scan.state() == LssScanState::running) scan.on_reaction(slaves.answers(scan.question()));
  EXPECT_EQ(scan.state(), LssScanState::found);
  EXPECT_EQ(scan.address(), sample);
}

TEST(LssFastScan, RepeatsAPartAfterALostAnswer) {
  Slaves slaves{{{.address = sample}}};
  LssFastScan scan;
  bool doubted = false;
  for (int asked = 0; scan.state() == LssScanState::running && asked < 1000; ++asked) {
    const bool answered = slaves.answers(scan.question());
    scan.on_reaction(answered && asked != 10);
    doubted |= scan.doubtful();
  }
  EXPECT_TRUE(doubted);
  EXPECT_EQ(scan.state(), LssScanState::found);
  EXPECT_EQ(scan.address(), sample);
}

struct Outcome {
  LssScanState state;
  LssAddress address;
  std::vector<LssAddress> in_configuration;
};

/// Runs a scan in which the master misses the answer to question number `missed`. With `late` the
/// answer comes at the next question, unless the master waits as long as the answer may take.
Outcome scan_with_fault(Slaves slaves, int missed, bool late) {
  LssFastScan scan;
  bool on_its_way = false;
  for (int asked = 0; scan.state() == LssScanState::running && asked < 1000; ++asked) {
    const bool answered = slaves.answers(scan.question());
    const bool misses = asked == missed && !(late && scan.doubtful());
    scan.on_reaction((answered && !misses) || on_its_way);
    on_its_way = late && answered && misses;
  }
  Outcome outcome{.state = scan.state(), .address = scan.address(), .in_configuration = {}};
  for (const Slaves::Slave& slave : slaves.all) {
    if (slave.configuration) outcome.in_configuration.push_back(slave.address);
  }
  return outcome;
}

constexpr int last_question = 132;  // after its answer the device is in the configuration state

TEST(LssFastScan, FindsADeviceWhicheverAnswerIsLost) {
  for (const std::uint32_t serial : {0xA4U, 0xA5U}) {
    const LssAddress only{0x15A, 2, 0x0001'0003, serial};
    for (int lost = 0; lost < last_question; ++lost) {
      const Outcome outcome = scan_with_fault({{{.address = only}}}, lost, false);

      EXPECT_EQ(outcome.state, LssScanState::found) << lost;
      EXPECT_EQ(outcome.address, only) << lost;
      EXPECT_EQ(outcome.in_configuration, std::vector{only}) << lost;
    }
  }
}

TEST(LssFastScan, FindsADeviceWhoseAnswerIsTakenForThatOfTheNextQuestion) {
  for (const std::uint32_t serial : {0xA4U, 0xA5U}) {
    const LssAddress only{0x15A, 2, 0x0001'0003, serial};
    for (int late = 0; late <= last_question; ++late) {
      const Outcome outcome = scan_with_fault({{{.address = only}}}, late, true);

      // In the serial number the result may look as if another device had switched without an
      // answer.
      if (outcome.state == LssScanState::lost && late > 99) continue;
      EXPECT_EQ(outcome.state, LssScanState::found) << late;
      EXPECT_EQ(outcome.address, only) << late;
      EXPECT_EQ(outcome.in_configuration, std::vector{only}) << late;
    }
  }
}

/// If the scan found one device while two are in configuration state, both would get the same
/// node-ID.
TEST(LssFastScan, DoesNotFindASecondDeviceWhereTheFirstOneHasSwitchedUnheard) {
  const LssAddress others[] = {
      {0x15A, 2, 0x0001'0003, 0xA6}, {0x15A, 2, 0x0001'0004, 3}, {0x15A, 3, 0x0001'0003, 0x10}};
  for (const LssAddress& other : others) {
    const Slaves both{{{.address = sample}, {.address = other}}};

    EXPECT_EQ(scan_with_fault(both, last_question, false).state, LssScanState::lost);

    for (int fault = 0; fault < 2 * last_question; ++fault) {
      const Outcome outcome = scan_with_fault(both, fault / 2, fault % 2 != 0);
      if (outcome.state != LssScanState::found) continue;
      EXPECT_EQ(outcome.in_configuration, std::vector{outcome.address}) << fault;
    }
  }
}

TEST(LssFastScan, EndsWhereTheDeviceGoesAwayInTheMiddle) {
  Slaves slaves{{{.address = sample}}};
  LssFastScan scan;
  int asked = 0;
  for (; scan.state() == LssScanState::running; ++asked) {
    const bool answered = slaves.answers(scan.question());
    scan.on_reaction(answered && asked < 50);
  }
  EXPECT_EQ(scan.state(), LssScanState::lost);
  EXPECT_LT(asked, 150);
}

struct Configured {
  std::vector<LssAddress> all;
  bool answers(const std::array<std::uint32_t, 6>& asked) const {
    return std::ranges::any_of(all, [&](const LssAddress& own) {
      return own[0] == asked[0] && own[1] == asked[1] && own[2] >= asked[2] && own[2] <= asked[3] &&
             own[3] >= asked[4] && own[3] <= asked[5];
    });
  }
};

TEST(LssSlowScan, HalvesTheRangesUntilOneIsLeft) {
  const Configured slaves{{sample, {0x15A, 2, 0x0001'0003, 0xA6}, {0x15A, 2, 0x0002'0000, 1}}};
  LssSlowScan scan{{0x15A, 2, 0, 0xFFFF'FFFF, 0, 0xFFFF'FFFF}};
  int asked = 0;
  for (; scan.state() == LssScanState::running; ++asked) {
    scan.on_reaction(slaves.answers(scan.question()));
  }
  EXPECT_EQ(scan.state(), LssScanState::found);
  EXPECT_EQ(scan.address(), sample);
  EXPECT_EQ(asked, 1 + 32 + 32 + 1);
}

TEST(LssSlowScan, FindsTheEndsOfTheRanges) {
  const Configured slaves{{{0x15A, 2, 0xFFFF'FFFF, 0xFFFF'FFFF}}};
  LssSlowScan scan{{0x15A, 2, 0, 0xFFFF'FFFF, 0, 0xFFFF'FFFF}};
  while (scan.state() == LssScanState::running) scan.on_reaction(slaves.answers(scan.question()));
  EXPECT_EQ(scan.address(), (LssAddress{0x15A, 2, 0xFFFF'FFFF, 0xFFFF'FFFF}));
  EXPECT_EQ(scan.state(), LssScanState::found);
}

TEST(LssSlowScan, NeedsOneQuestionWhereNobodyIs) {
  const Configured slaves{{sample}};
  LssSlowScan scan{{0x15A, 3, 0, 0xFFFF'FFFF, 0, 0xFFFF'FFFF}};
  scan.on_reaction(slaves.answers(scan.question()));
  EXPECT_EQ(scan.state(), LssScanState::nobody);
}

}  // namespace
}  // namespace takt
