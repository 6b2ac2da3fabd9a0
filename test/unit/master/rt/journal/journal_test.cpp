#include "master/rt/journal/journal.hpp"

#include <atomic>
#include <gtest/gtest.h>
#include <memory>
#include <thread>

#include "master/rt/journal/journal_request.hpp"
#include "master/rt/journal/recorded_link.hpp"
#include "master/rt/journal/replay_port.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {
namespace {

using journal::word;

TEST(Tape, GivesBackItsRecordsInOrder) {
  Tape tape{1024};
  tape.mark_cycle();
  tape.put(word(Mark::cycle, 1));
  std::uint64_t* const room = tape.claim(3);
  room[0] = word(Mark::receive, 0);
  room[1] = 11;
  room[2] = 12;

  EXPECT_TRUE(tape.whole());
  EXPECT_EQ(tape.read(),
            (std::vector<std::uint64_t>{0x0100'0000'0000'0001, 0x0400'0000'0000'0000, 11, 12}));
}

TEST(Tape, OverwritesItsOldestCyclesAndBeginsWithACycle) {
  Tape tape{1024};
  for (std::uint64_t cycle = 1; cycle <= 2000; ++cycle) {
    tape.mark_cycle();
    tape.put(word(Mark::cycle, cycle));
    std::uint64_t* const room = tape.claim(6);  // 7 words per cycle; the end of the tape cuts none
    for (int i = 0; i < 6; ++i) room[i] = word(Mark::now, cycle);
  }

  const std::vector<std::uint64_t> records = tape.read();

  EXPECT_FALSE(tape.whole());
  ASSERT_EQ(records.size() % 7, 0U);
  EXPECT_GT(records.size(), 1024U * 9 / 10);
  const std::uint64_t first = 2001 - records.size() / 7;
  for (std::size_t i = 0; i < records.size(); i += 7) {
    EXPECT_EQ(records[i], word(Mark::cycle, first + i / 7));
    EXPECT_EQ(records[i + 6], word(Mark::now, first + i / 7));
  }
}

TEST(Tape, RefusesARecordThatWouldEatItUp) {
  Tape tape{1024};
  for (int i = 0; i < 1000; ++i) tape.put(word(Mark::now, 1));
  EXPECT_EQ(tape.claim(257), nullptr);
  EXPECT_NE(tape.claim(256), nullptr);
}

TEST(Journal, GivesTheRunningTapeAwayAtTheNextCycleAndGoesOnWithTheOther) {
  Journal journal{8192};
  journal.put(Mark::now, std::uint64_t{5});
  journal.begin_cycle(1);
  journal.want();
  EXPECT_EQ(journal.wanted(), nullptr);

  journal.begin_cycle(2);

  ASSERT_NE(journal.wanted(), nullptr);
  EXPECT_EQ(journal.wanted()->read(),
            (std::vector<std::uint64_t>{word(Mark::now, 5), word(Mark::cycle, 1)}));
  journal.begin_cycle(3);
  EXPECT_EQ(journal.last().read(),
            (std::vector<std::uint64_t>{word(Mark::cycle, 2), word(Mark::cycle, 3)}));
  journal.give_back();
  EXPECT_EQ(journal.wanted(), nullptr);
}

/// The thread sanitizer checks here that words are not overwritten while they are read.
TEST(Journal, IsReadByOneThreadWhileTheOtherRecords) {
  Journal journal{8192};
  std::atomic<bool> done{false};
  std::thread bus{[&] {
    for (std::uint64_t cycle = 1; !done; ++cycle) {
      journal.begin_cycle(cycle);
      journal.put(Mark::now, cycle);
    }
  }};

  for (int i = 0; i < 50; ++i) {
    journal.want();
    const Tape* tape = nullptr;
    while ((tape = journal.wanted()) == nullptr) std::this_thread::yield();
    const std::vector<std::uint64_t> records = tape->read();
    EXPECT_TRUE(records.empty() || journal::mark_of(records.front()) == Mark::cycle);
    journal.give_back();
  }
  done = true;
  bus.join();
}

TEST(Journal, MarksAGapWhereARecordIsTooLong) {
  Journal journal{8192};
  for (int i = 0; i < 1000; ++i) journal.put(Mark::now, std::uint64_t{1});

  EXPECT_EQ(journal.claim(Mark::request, 300, 300), nullptr);

  EXPECT_EQ(journal.last().read().back(), word(Mark::gap, 0));
}

TEST(JournalRequest, ComesBackAsItWas) {
  Journal journal{65536};
  SdoTransfers transfers;
  Request request{.id = 77,
                  .kind = RequestKind::sdo_download,
                  .node = 5,
                  .object = {0x6081, 2},
                  .timeout = std::chrono::milliseconds{30},
                  .size = 4};
  request.data[0] = std::byte{0xE8};
  request.data[3] = std::byte{0x11};

  put_request(journal, request, transfers);
  const auto records = journal.last().read();
  Request back;
  ASSERT_TRUE(get_request(std::span{records}.subspan(1), back, transfers));

  EXPECT_EQ(back.id, 77U);
  EXPECT_EQ(back.kind, RequestKind::sdo_download);
  EXPECT_EQ(back.node, 5);
  EXPECT_EQ(back.object, (ObjectKey{0x6081, 2}));
  EXPECT_EQ(back.timeout, std::chrono::milliseconds{30});
  EXPECT_EQ(back.size, 4);
  EXPECT_EQ(back.data, request.data);
  EXPECT_EQ(back.transfer, nullptr);
}

TEST(JournalRequest, KeepsTheValueOfALongDownload) {
  Journal journal{65536};
  SdoTransfers transfers;
  transfers[2].data = {std::byte{1}, std::byte{2}, std::byte{3}};
  const Request request{.kind = RequestKind::sdo_download, .transfer = &transfers[2]};

  put_request(journal, request, transfers);
  const auto records = journal.last().read();
  SdoTransfers other;
  Request back;
  ASSERT_TRUE(get_request(std::span{records}.subspan(1), back, other));

  EXPECT_EQ(back.transfer, &other[2]);
  EXPECT_EQ(other[2].data, transfers[2].data);
}

/// The bus thread would have to copy such a download in one cycle.
TEST(JournalRequest, LeavesAGapForADownloadOfMegabytes) {
  Journal journal{32 << 20};
  SdoTransfers transfers;
  transfers[0].data.resize(4 << 20);
  const Request request{.kind = RequestKind::sdo_download, .transfer = &transfers[0]};

  put_request(journal, request, transfers);

  EXPECT_EQ(journal.last().read(), (std::vector<std::uint64_t>{word(Mark::gap, 0)}));
}

TEST(JournalRequest, RefusesWhatIsNone) {
  SdoTransfers transfers;
  Request back;
  EXPECT_FALSE(get_request({}, back, transfers));
  const std::vector<std::uint64_t> garbage(8, ~0ULL);
  EXPECT_FALSE(get_request(garbage, back, transfers));
  const std::vector<std::uint64_t> huge{1, std::uint64_t{1} << 48, 0, ~0ULL};
  EXPECT_FALSE(get_request(huge, back, transfers));
}

struct RecordedLinkTest : testing::Test {
  BusPlan plan = test::axes({.nodes = 1});  // two outputs
  Journal journal{65536};
  std::unique_ptr<Exchange> exchange = std::make_unique<Exchange>(plan);
  RecordedLink link{*exchange, &journal};
};

TEST_F(RecordedLinkTest, RecordsASetOnceAndAgainBehindEachCheckpoint) {
  SetPoints& set_points = exchange->set_points;
  set_points.publish(Time{1000});
  const SetPointFrame& frame = link.set_points();
  EXPECT_EQ(frame.when, Time{1000});
  EXPECT_EQ(&link.set_points(), &frame);
  ASSERT_TRUE(link.checkpoint_due());
  ASSERT_NE(link.checkpoint(2), nullptr);
  link.set_points();

  const std::vector<std::uint64_t> words = journal.last().read();
  constexpr std::size_t set = 2 + 2 * sizeof(SetPoint) / 8;
  ASSERT_EQ(words.size(), set + 1 + 3 + set);
  EXPECT_EQ(words[0], word(Mark::set_points, 2));
  EXPECT_EQ(words[1], 1000U);
  EXPECT_EQ(words[set], word(Mark::set_points, 0));
  EXPECT_EQ(words[set + 1], word(Mark::checkpoint, 2));
  EXPECT_EQ(words[set + 4], word(Mark::set_points, 2)) << "the set is recorded again";
}

/// A set without set-points looks like an unchanged one, so it has no words.
TEST_F(RecordedLinkTest, RecordsNoContentForABusWithoutOutputs) {
  const auto without = std::make_unique<Exchange>(BusPlan{});
  RecordedLink empty{*without, &journal};
  without->set_points.publish(Time{1000});
  empty.set_points();
  EXPECT_EQ(journal.last().read(), std::vector{word(Mark::set_points, 0)});
}

TEST_F(RecordedLinkTest, RecordsOnlyWhatTheFrontThreadHasDone) {
  Request request;
  EXPECT_FALSE(link.take_request(request));
  EXPECT_FALSE(link.stop_requested());
  EXPECT_TRUE(link.give_reply({}));
  EXPECT_TRUE(journal.last().read().empty());

  exchange->stop_requested = true;
  EXPECT_TRUE(link.stop_requested());
  for (int i = 1; i < 16; ++i) EXPECT_TRUE(link.give_reply({}));
  EXPECT_FALSE(link.give_reply({}));
  EXPECT_EQ(journal.last().read(),
            (std::vector<std::uint64_t>{word(Mark::stop, 0), word(Mark::replies_full, 0)}));
}

TEST_F(RecordedLinkTest, OnlyForwardsWithoutAJournal) {
  RecordedLink plain{*exchange, nullptr};
  exchange->set_points.publish(Time{1000});
  EXPECT_EQ(plain.set_points().when, Time{1000});
  EXPECT_FALSE(plain.checkpoint_due());
  plain.announce({.kind = EventKind::stopping});
  Event event;
  ASSERT_TRUE(exchange->events.pop(event));
  EXPECT_EQ(event.kind, EventKind::stopping);
}

/// If a frame differs from the recorded one, the replay ends and keeps the difference.
TEST(ReplayPort, NamesTheFrameThatDiffers) {
  const Recording recording{.words = {word(Mark::now, 1000), word(Mark::send, 0x0000'0001'0001), 0,
                                      word(Mark::now, 2000)},
                            .frames = {make_frame(CobId::base(0x601), {0x40})}};
  ReplayPort port{{&recording, 1}, 0};
  EXPECT_EQ(port.now(), Time{1000});

  const Frame other = make_frame(CobId::base(0x601), {0x80});
  port.send({&other, 1});

  ASSERT_TRUE(port.difference());
  EXPECT_EQ(port.difference()->what, ReplayDifference::What::frame);
  EXPECT_EQ(port.difference()->sent, other);
  EXPECT_EQ(port.difference()->expected, recording.frames[0]);
  EXPECT_TRUE(port.over());
  EXPECT_GT(port.now(), Time{1000});
  EXPECT_LT(port.now(), Time{4000});
  EXPECT_FALSE(port.wait_frame(Time{5000}));
  EXPECT_GE(port.now(), Time{5000});
}

TEST(ReplayPort, TakesNoFrameThatIsNotThere) {
  const Recording recording{.words = {word(Mark::receive, 1), 5, 1}, .frames = {Frame{}}};
  ReplayPort port{{&recording, 1}, 0};
  std::vector<StampedFrame> in(4);

  EXPECT_EQ(port.receive(in), 0U);

  ASSERT_TRUE(port.difference());
  EXPECT_EQ(port.difference()->what, ReplayDifference::What::broken);
}

}  // namespace
}  // namespace takt
