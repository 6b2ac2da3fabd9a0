#include <algorithm>
#include <gtest/gtest.h>
#include <memory>
#include <span>
#include <vector>

#include "master/rt/bus_loop.hpp"
#include "master/rt/journal/recorded_link.hpp"
#include "master/rt/journal/recorded_port.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"
#include "test/unit/master/rt/fake_port.hpp"

namespace takt {
namespace {

using test::FakeNetwork;
using test::FakePort;

/// A loop that records to a journal.
struct RecordingLoop {
  BusPlan plan = test::axes();
  FakePort port;
  Journal journal{1 << 20};
  RecordedPort<FakePort> recorded{port, &journal};
  std::unique_ptr<Exchange> exchange = std::make_unique<Exchange>(plan);
  using Loop = BusLoop<RecordedPort<FakePort>, RecordedLink, FakeNetwork>;
  std::unique_ptr<Loop> loop =
      std::make_unique<Loop>(plan, recorded, RecordedLink{*exchange, &journal});
};

std::vector<std::uint64_t> first_checkpoint() {
  RecordingLoop run;
  run.loop->start();
  for (int i = 0; i < 3; ++i) run.loop->cycle();
  const std::vector<std::uint64_t> words = run.journal.last().read();
  const auto layout = std::ranges::find(words, checkpoint_layout);
  if (layout == words.begin() || layout == words.end()) return {};
  const auto count = static_cast<std::ptrdiff_t>(journal::payload_of(*(layout - 1)));
  return {layout, layout + count};
}

TEST(BusLoopCheckpoint, ContinuesTheRun) {
  const std::vector<std::uint64_t> checkpoint = first_checkpoint();
  ASSERT_FALSE(checkpoint.empty());
  RecordingLoop other;
  EXPECT_TRUE(other.loop->resume(checkpoint));
  other.loop->cycle();
  EXPECT_EQ(other.port.sent_with(0x080).size(), 1U);
}

TEST(BusLoopCheckpoint, IsRefusedIfItHasAnotherLayoutOrSize) {
  std::vector<std::uint64_t> checkpoint = first_checkpoint();
  ASSERT_FALSE(checkpoint.empty());
  RecordingLoop other;
  EXPECT_FALSE(other.loop->resume(std::span{checkpoint}.first(checkpoint.size() - 1)));
  EXPECT_FALSE(other.loop->resume({}));
  ++checkpoint.front();
  EXPECT_FALSE(other.loop->resume(checkpoint));
}

}  // namespace
}  // namespace takt
