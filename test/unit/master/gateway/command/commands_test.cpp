#include "master/gateway/command/commands.hpp"

#include <cstdint>
#include <gtest/gtest.h>
#include <map>
#include <string>
#include <vector>

#include "master/core/set_point.hpp"
#include "test/unit/master/gateway/a_plan.hpp"

namespace takt {
namespace {

class CommandsTest : public testing::Test {
 protected:
  CommandsTest() {
    for (NodeStatus& node : nodes) {
      node.nmt = NmtState::operational;
      node.boot = BootState::ready;
    }
  }

  command_t command(std::vector<std::int32_t> signals, std::vector<std::int64_t> values) {
    command_t message{};
    message.schema = 2;
    message.instance = 1;
    message.session = 42;
    message.sender = "move";
    message.cycle = 100;
    message.time_to_live = 5;
    message.num_values = static_cast<std::int32_t>(values.size());
    message.signals = std::move(signals);
    message.values = std::move(values);
    return message;
  }

  bool take(const command_t& message, std::uint64_t cycle = 100) {
    return commands.take(message, {.cycle = cycle, .now = now, .nodes = nodes});
  }
  /// Makes a release that was computed from this cycle.
  command_t release(std::int64_t cycle) {
    command_t message = command({}, {});
    message.release = 1;
    message.cycle = cycle;
    message.time_to_live = 0;
    return message;
  }
  bool reported(const std::string& part) const {
    return !notices.empty() && notices.back().text.find(part) != std::string::npos;
  }

  BusPlan plan = test::a_plan();
  std::vector<NodeStatus> nodes = std::vector<NodeStatus>(2);
  std::map<SignalIndex, std::int64_t> outputs;
  std::uint32_t last_time_to_live = 0;
  std::vector<Notice> notices;
  Time now = std::chrono::seconds{10};
  Commands commands{plan,
                    {.session = 42, .observe = false},
                    [this](SignalIndex signal, std::int64_t value, std::uint32_t cycles) {
                      outputs[signal] = value;
                      last_time_to_live = cycles;
                    },
                    [this](const Notice& notice) { notices.push_back(notice); }};
};

TEST_F(CommandsTest, GoodCommandIsStagedWithWhatIsLeftOfItsTimeToLive) {
  EXPECT_TRUE(take(command({1, 2}, {0x0F, -5}), 102));

  EXPECT_EQ(outputs, (std::map<SignalIndex, std::int64_t>{{1, 0x0F}, {2, -5}}));
  EXPECT_EQ(last_time_to_live, 3U);
  EXPECT_EQ(commands.holder(0, 102), "move");
  EXPECT_TRUE(notices.empty());
}

TEST_F(CommandsTest, InputsAndSignalsThatAreNotThereAreRefusedAsAWhole) {
  for (const int wrong : {0, 4, -1, 32767, 65537}) {
    EXPECT_FALSE(take(command({1, wrong}, {1, 1})));
  }

  EXPECT_TRUE(outputs.empty());
  EXPECT_TRUE(reported("not an output"));
}

TEST_F(CommandsTest, ValueThatDoesNotFitItsBitsIsRefusedAsAWhole) {
  EXPECT_FALSE(take(command({2, 1}, {5, 65536})));

  EXPECT_TRUE(outputs.empty());
  EXPECT_TRUE(reported("does not fit its 16 bits"));
}

TEST_F(CommandsTest, RefusalsAreCountedByTheirReason) {
  take(command({0}, {1}));
  take(command({1}, {65536}));
  take(command({1}, {1}), 105);
  take(command({1}, {1}), 105);
  commands.discard();

  EXPECT_EQ(commands.refused(), 5U);
  EXPECT_EQ(commands.refusals()[std::to_underlying(CommandRefusal::bad_signal)], 1U);
  EXPECT_EQ(commands.refusals()[std::to_underlying(CommandRefusal::bad_value)], 1U);
  EXPECT_EQ(commands.refusals()[std::to_underlying(CommandRefusal::too_old)], 2U);
  EXPECT_EQ(commands.refusals()[std::to_underlying(CommandRefusal::waited)], 1U);
  EXPECT_EQ(name(CommandRefusal::observing), "observing");
  EXPECT_EQ(name(CommandRefusal::too_old), "too_old");
  EXPECT_EQ(name(CommandRefusal::waited), "waited");
}

TEST_F(CommandsTest, ReplayedLogDoesNotMoveTheMachine) {
  command_t replayed = command({1}, {0x0F});
  replayed.session = 41;

  EXPECT_FALSE(take(replayed));
  EXPECT_TRUE(outputs.empty());
  EXPECT_TRUE(reported("another session"));
}

TEST_F(CommandsTest, AProgramOfAnotherSchemaIsReportedWhatToDo) {
  command_t old = command({1}, {0x0F});
  old.schema = 1;

  EXPECT_FALSE(take(old));
  EXPECT_TRUE(reported("message of schema 1: rebuild the application against this takt"));
}

TEST_F(CommandsTest, CommandThatWaitedLongerThanItsTimeToLiveIsRefused) {
  EXPECT_FALSE(take(command({1}, {0x0F}), 105));

  EXPECT_TRUE(reported("too old"));
}

TEST_F(CommandsTest, NodeThatIsNotReadyTakesNothingAndTheOtherNodeDoes) {
  nodes[0].boot = BootState::booting;

  EXPECT_TRUE(take(command({1, 3}, {0x0F, 1})));

  EXPECT_EQ(outputs, (std::map<SignalIndex, std::int64_t>{{3, 1}}));
  EXPECT_TRUE(reported("node 5 (shoulder): the node has not booted"));
}

TEST_F(CommandsTest, SecondSenderWaitsForTheEndOfTheLease) {
  take(command({1}, {0x06}));
  command_t other = command({1}, {0x0F});
  other.sender = "other";
  other.instance = 2;

  EXPECT_FALSE(take(other, 101));
  EXPECT_TRUE(reported("belong to 'move'"));
  other.cycle = 105;
  EXPECT_TRUE(take(other, 105));
  EXPECT_EQ(outputs[1], 0x0F);
}

TEST_F(CommandsTest, SecondProgramOfTheSameNameIsRefusedAndReportedSo) {
  EXPECT_TRUE(take(command({1}, {0x06})));
  command_t other = command({1}, {0x0F});
  other.instance = 2;

  EXPECT_FALSE(take(other, 101));

  EXPECT_EQ(outputs[1], 0x06);
  EXPECT_TRUE(reported("belong to another program of the same name, 'move'"));
}

TEST_F(CommandsTest, SenderWithoutAnInstanceIsRefused) {
  command_t nobody = command({1}, {0x06});
  nobody.instance = 0;

  EXPECT_FALSE(take(nobody));
  EXPECT_TRUE(reported("the command has instance 0"));
}

TEST_F(CommandsTest, CommandOfNoCycleIsRefused) {
  for (const std::int64_t none : {std::int64_t{0}, std::int64_t{-1}, INT64_MIN}) {
    command_t replayed = command({1}, {0x0F});
    replayed.cycle = none;
    EXPECT_FALSE(take(replayed)) << none;
  }

  EXPECT_TRUE(outputs.empty());
  EXPECT_TRUE(reported("computed from cycle"));
}

TEST_F(CommandsTest, CommandFromTheFutureIsRefused) {
  EXPECT_TRUE(take(command({1}, {0x0F}), 99)) << "the next cycle may have begun";
  command_t future = command({1}, {0x07});
  for (const std::int64_t cycle : {std::int64_t{101}, INT64_MAX}) {
    future.cycle = cycle;
    EXPECT_FALSE(take(future, 99)) << cycle;
  }

  EXPECT_EQ(outputs[1], 0x0F);
  EXPECT_TRUE(reported("the command is ahead of taktd"));
}

TEST_F(CommandsTest, LongestTimeToLiveGivesALeaseOfOneSecond) {
  command_t greedy = command({1}, {0x06});
  greedy.time_to_live = 2147483647;
  EXPECT_TRUE(take(greedy));
  EXPECT_EQ(last_time_to_live, 500U) << "1 s of 2 ms";

  EXPECT_EQ(commands.holder(0, 599), "move");
  EXPECT_EQ(commands.holder(0, 600), "");
}

TEST_F(CommandsTest, ReleasedOutputsAreGivenUpAtOnce) {
  EXPECT_TRUE(take(command({1, 2}, {0x0F, 5})));
  command_t end = command({}, {});
  end.release = 1;
  end.instance = 2;
  EXPECT_FALSE(take(end, 101)) << "another sender holds them";

  end.instance = 1;
  EXPECT_TRUE(take(end, 101));

  EXPECT_EQ(last_time_to_live, output_released);
  EXPECT_EQ(commands.holder(0, 101), "");
  EXPECT_TRUE(reported("'move' has released the outputs of shoulder"));
  EXPECT_EQ(notices.back().weight, Weight::note);
}

TEST_F(CommandsTest, AnOldReleaseReleasesNothing) {
  command_t fresh = command({1}, {0x0F});
  EXPECT_TRUE(take(fresh));
  fresh.cycle = 103;
  EXPECT_TRUE(take(fresh, 103));

  EXPECT_FALSE(take(release(102), 103)) << "a later command has overtaken it";
  EXPECT_TRUE(
      reported("node 5 (shoulder): the command is older than the newest command to the node: it "
               "was computed "
               "from cycle 102"));
  EXPECT_FALSE(take(release(0), 103));
  EXPECT_TRUE(reported("was computed from cycle 0"));
  EXPECT_FALSE(take(release(105), 103));
  EXPECT_TRUE(reported("the command is ahead of taktd"));

  EXPECT_EQ(commands.holder(0, 103), "move");
  EXPECT_EQ(last_time_to_live, 5U);
  EXPECT_EQ(commands.refusals()[std::to_underlying(CommandRefusal::overtaken)], 1U);
}

TEST_F(CommandsTest, ACommandOfTheCycleOfItsReleaseIsNotCalledOlder) {
  EXPECT_TRUE(take(command({1}, {0x0F})));
  EXPECT_TRUE(take(release(100)));

  EXPECT_FALSE(take(command({1}, {0x0F})));

  EXPECT_TRUE(reported(
      "node 5 (shoulder): the command is not newer than the release of its sender: both are "
      "computed from cycle 100"));
  EXPECT_EQ(commands.refusals()[std::to_underlying(CommandRefusal::overtaken)], 1U);
}

TEST_F(CommandsTest, AReleaseHasATimeToLiveToo) {
  EXPECT_TRUE(take(command({1}, {0x0F})));
  command_t end = release(100);
  end.time_to_live = 3;

  EXPECT_FALSE(take(end, 103));

  EXPECT_TRUE(
      reported("the command is too old: it was computed from cycle 100, the present cycle is 103"));
  EXPECT_EQ(commands.holder(0, 103), "move");
}

TEST_F(CommandsTest, AReleaseOnTheChannelOfOneNodeReachesThisNodeOnly) {
  EXPECT_TRUE(take(command({1, 3}, {0x0F, 1})));
  CommandContext context{.cycle = 101, .now = now, .nodes = nodes, .only_node = 1};

  EXPECT_TRUE(commands.take(release(101), context));

  EXPECT_EQ(commands.holder(0, 101), "move");
  EXPECT_EQ(commands.holder(1, 101), "");
  EXPECT_TRUE(reported("'move' has released the outputs of")) << notices.back().text;
  EXPECT_FALSE(reported("shoulder"));
}

TEST_F(CommandsTest, AnOlderCommandDoesNotOvertakeANewerOne) {
  EXPECT_TRUE(take(command({1}, {1}), 101));
  command_t newer = command({1}, {2});
  newer.cycle = 101;
  EXPECT_TRUE(take(newer, 102));

  EXPECT_FALSE(take(command({1}, {1}), 102)) << "a copy of the first one, within its time to live";

  EXPECT_EQ(outputs[1], 2);
  EXPECT_TRUE(reported(
      "the command is older than the newest command to the node: it was computed from cycle 100"));
  for (int i = 0; i < 100; ++i) take(command({1}, {1}), 102);
  EXPECT_EQ(notices.size(), 1U) << "at most one a second";
  newer.values = {3};
  EXPECT_TRUE(take(newer, 102)) << "twice in a cycle";
  EXPECT_EQ(outputs[1], 3);
}

TEST_F(CommandsTest, TheLimitOfTheNewestCommandIsKnownForEachOutput) {
  EXPECT_EQ(commands.newest_limit(1), std::nullopt);
  EXPECT_TRUE(take(command({1}, {1}), 102));

  ASSERT_TRUE(commands.newest_limit(1));
  EXPECT_EQ(commands.newest_limit(1)->cycles, 5U);
  EXPECT_EQ(commands.newest_limit(1)->origin, LimitOrigin::command);
  EXPECT_EQ(commands.newest_limit(2), std::nullopt);
  EXPECT_EQ(commands.newest_limit(-1), std::nullopt);
  EXPECT_EQ(commands.newest_limit(99), std::nullopt);
}

TEST_F(CommandsTest, ControlCharactersOfASenderReachNoTerminal) {
  command_t message = command({1}, {0x06});
  message.sender = "a\n\x1b[2Jb";

  EXPECT_FALSE(take(message));
  EXPECT_TRUE(reported("command of 'a??[2Jb' refused"));
}

TEST_F(CommandsTest, SameRefusalIsReportedOnceASecond) {
  command_t replayed = command({1}, {0x0F});
  replayed.session = 41;
  for (int i = 0; i < 500; ++i) take(replayed);

  EXPECT_EQ(notices.size(), 1U);
  EXPECT_EQ(commands.refused(), 500U);

  now += std::chrono::seconds{2};
  take(replayed);
  EXPECT_TRUE(reported("(499 earlier ones were not reported)"));
}

TEST_F(CommandsTest, ObservingTakesNothing) {
  Commands observing{plan,
                     {.session = 42, .observe = true},
                     [](SignalIndex, std::int64_t, std::uint32_t) { FAIL(); },
                     [this](const Notice& notice) { notices.push_back(notice); }};

  EXPECT_FALSE(observing.take(command({1}, {1}), {.cycle = 100, .now = now, .nodes = nodes}));
  EXPECT_TRUE(reported("only observes"));
}

}  // namespace
}  // namespace takt
