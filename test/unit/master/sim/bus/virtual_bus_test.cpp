#include "master/sim/bus/virtual_bus.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "master/sim/bus/frame_bits.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

class Bus : public testing::Test {
 protected:
  Bus() {
    for (int i = 0; i < 4; ++i) bus_.attach({});
  }

  /// Returns all frames that leave the wire until `end`.
  std::vector<WireFrame> run(Time end) {
    std::vector<WireFrame> frames;
    const WireFrame& wire = bus_.wire();
    while (bus_.next_event() <= end) {
      if (bus_.step(bus_.next_event())) frames.push_back(wire);
    }
    return frames;
  }
  static Frame frame(std::uint32_t id) { return make_frame(CobId::base(id), {}); }

  VirtualBus bus_{1'000'000, Random{1}};
};

TEST_F(Bus, SendsTheLowestIdentifierFirst) {
  bus_.queue(0, frame(0x205), 0ns);
  bus_.queue(1, frame(0x080), 0ns);
  bus_.queue(2, frame(0x185), 0ns);

  const auto sent = run(1ms);

  ASSERT_EQ(sent.size(), 3u);
  EXPECT_EQ(sent[0].frame.id, CobId::base(0x080));
  EXPECT_EQ(sent[1].frame.id, CobId::base(0x185));
  EXPECT_EQ(sent[2].frame.id, CobId::base(0x205));
  EXPECT_EQ(sent[0].end, 48us);
  EXPECT_EQ(sent[1].start, 51us);  // three bits of interframe space
}

TEST_F(Bus, CountsTheBitsOfEachFrameThatDiffersFromTheOneBefore) {
  Frame remote = make_frame(CobId::base(0x181), {0, 0});
  remote.rtr = true;
  const std::vector<Frame> frames = {make_frame(CobId::base(0x181), {0, 0}),
                                     make_frame(CobId::base(0x181), {0, 0}),
                                     make_frame(CobId::base(0x181), {0x55, 0xAA}),
                                     make_frame(CobId::base(0x181), {0x55}),
                                     make_frame(CobId::extended(0x181), {0, 0, 0}),
                                     make_frame(CobId::base(0x181), {0, 0}),
                                     remote};
  for (const Frame& sent : frames) {
    bus_.queue(0, sent, 0ns);

    const auto wire = run(1s);

    ASSERT_EQ(wire.size(), 1u);
    EXPECT_EQ(wire[0].frame, sent);
    EXPECT_EQ(wire[0].bits, frame_bits(sent).total);
  }
}

TEST_F(Bus, DoesNotInterruptAFrame) {
  bus_.queue(0, frame(0x700), 0ns);
  bus_.queue(1, frame(0x000), 1us);

  const auto sent = run(1ms);

  EXPECT_EQ(sent[0].frame.id, CobId::base(0x700));
}

TEST_F(Bus, PrefersShortIdentifiersAndDataToRemoteFrames) {
  const Frame data = frame(0x123);
  Frame remote = data;
  remote.rtr = true;
  const Frame extended = make_frame(CobId::extended(0x123u << 18), {});
  bus_.queue(0, extended, 0ns);
  bus_.queue(1, remote, 0ns);
  bus_.queue(2, data, 0ns);

  const auto sent = run(1ms);

  EXPECT_EQ(sent[0].frame, data);
  EXPECT_EQ(sent[1].frame, remote);
  EXPECT_EQ(sent[2].frame, extended);
}

TEST_F(Bus, TakesTheOldestOfAFifoEvenIfItsIdentifierIsHigh) {
  VirtualBus bus{1'000'000, Random{1}};
  bus.attach({.order = QueueOrder::fifo});
  bus.attach({});
  bus.queue(0, frame(0x600), 0ns);
  bus.queue(0, frame(0x080), 0ns);
  bus.queue(1, frame(0x300), 0ns);

  const WireFrame& wire = bus.wire();
  while (!bus.step(bus.next_event())) {
  }
  EXPECT_EQ(wire.frame.id, CobId::base(0x300));
  while (!bus.step(bus.next_event())) {
  }
  EXPECT_EQ(wire.frame.id, CobId::base(0x600));
}

TEST_F(Bus, LetsNoFrameWaitForALowerOneThatIsNotReady) {
  bus_.queue(2, frame(0x100), 1ms);
  bus_.queue(2, frame(0x300), 0ns);
  bus_.queue(3, frame(0x200), 0ns);

  const auto sent = run(2ms);

  ASSERT_EQ(sent.size(), 3u);
  EXPECT_EQ(sent[0].frame.id, CobId::base(0x200));
  EXPECT_EQ(sent[1].frame.id, CobId::base(0x300));
  EXPECT_EQ(sent[2].frame.id, CobId::base(0x100));
}

TEST_F(Bus, MergesEqualFramesAlsoOfANodeThatWaitsWithALowerOne) {
  bus_.queue(2, frame(0x100), 1ms);
  bus_.queue(2, frame(0x200), 0ns);
  bus_.queue(1, frame(0x200), 0ns);

  const auto sent = run(2ms);

  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].frame.id, CobId::base(0x200));
  EXPECT_EQ(sent[0].sender, 1);
  EXPECT_EQ(sent[1].frame.id, CobId::base(0x100));
}

TEST_F(Bus, StretchesTimeWithTheBitRate) {
  VirtualBus bus{125'000, Random{1}};
  bus.attach({});
  bus.attach({});
  bus.queue(0, frame(0x080), 0ns);

  const WireFrame& wire = bus.wire();
  while (!bus.step(bus.next_event())) {
  }
  EXPECT_EQ(wire.end, 48 * 8us);
}

TEST_F(Bus, DropsAFrameWhoseTimeIsOver) {
  bus_.queue(0, make_frame(CobId::base(0x080), {0, 0, 0, 0, 0, 0, 0, 0}), 0ns);
  bus_.queue(1, frame(0x185), 0ns, 50us);

  EXPECT_EQ(run(1ms).size(), 1u);
  EXPECT_EQ(bus_.counters().expired, 1u);
}

TEST_F(Bus, RefusesWhatTheQueueCanNotHold) {
  VirtualBus bus{1'000'000, Random{1}};
  bus.attach({.order = QueueOrder::fifo, .capacity = 2});
  EXPECT_TRUE(bus.queue(0, frame(1), 0ns));
  EXPECT_TRUE(bus.queue(0, frame(2), 0ns));
  EXPECT_FALSE(bus.queue(0, frame(3), 0ns));
}

TEST_F(Bus, RepeatsADestroyedFrame) {
  bus_.node(0).faults.error = 0.08;
  for (int i = 0; i < 60; ++i) bus_.queue(0, frame(0x100u + static_cast<unsigned>(i)), 0ns);

  std::size_t good = 0;
  std::size_t bad = 0;
  for (const WireFrame& wire : run(1s)) {
    ++(wire.result == WireResult::sent ? good : bad);
    if (wire.result == WireResult::destroyed) {
      EXPECT_GE(wire.bits, 15);       // one bit, error flag and delimiter
      EXPECT_LE(wire.bits, 55 + 20);  // the longest frame without data, flags with echoes
    }
  }
  EXPECT_EQ(good, 60u);
  EXPECT_GT(bad, 1u);
  EXPECT_EQ(bus_.counters().error_frames, bad);
}

TEST_F(Bus, CountsErrorsUpToBusOffAndRecovers) {
  bus_.node(0).faults.error = 1.0;
  bus_.queue(0, frame(0x100), 0ns);

  std::uint32_t steps = 0;
  const WireFrame& wire = bus_.wire();
  while (!bus_.node(0).bus_off) {
    if (bus_.step(bus_.next_event())) ++steps;
    if (steps == 16) {
      EXPECT_TRUE(bus_.node(0).error_passive(bus_.counters().frames));
    }
  }

  EXPECT_EQ(steps, 32u);  // 32 x 8 = 256
  EXPECT_EQ(bus_.take_change(), 0);
  EXPECT_EQ(bus_.node(1).receive_errors(bus_.counters().frames), 32u);
  EXPECT_FALSE(bus_.queue(0, frame(0x100), wire.end));
  EXPECT_EQ(bus_.node(0).recovers, wire.end + 1408us);  // 128 x 11 bits

  run(wire.end + 2ms);
  EXPECT_FALSE(bus_.node(0).bus_off);
  EXPECT_EQ(bus_.take_change(), 0);
  EXPECT_TRUE(bus_.queue(0, frame(0x100), 10ms));
}

TEST_F(Bus, CountsOneDownWithEachGoodFrame) {
  bus_.node(0).faults.error = 1.0;
  bus_.queue(0, frame(0x100), 0ns);
  while (!bus_.step(bus_.next_event())) {
  }
  bus_.node(0).faults.error = 0.0;
  EXPECT_EQ(bus_.node(0).transmit_errors, 8u);
  EXPECT_EQ(bus_.node(1).receive_errors(bus_.counters().frames), 1u);

  run(1ms);
  EXPECT_EQ(bus_.node(0).transmit_errors, 7u);
  EXPECT_EQ(bus_.node(1).receive_errors(bus_.counters().frames), 0u);
}

TEST_F(Bus, LeavesALoneNodeErrorPassiveButNeverBusOff) {
  for (BusNodeIndex i = 1; i < 4; ++i) bus_.set_powered(i, false, 0ns);
  bus_.queue(0, frame(0x080), 0ns);

  for (const WireFrame& wire : run(100ms)) EXPECT_EQ(wire.result, WireResult::unacknowledged);

  EXPECT_FALSE(bus_.node(0).bus_off);
  EXPECT_EQ(bus_.node(0).transmit_errors, 128u);
  EXPECT_GT(bus_.counters().error_frames, 100u);

  bus_.set_powered(1, true, 100ms);
  const auto later = run(101ms);
  EXPECT_EQ(later.back().result, WireResult::sent);
}

TEST_F(Bus, DestroysTwoDifferentFramesOfOneIdentifier) {
  bus_.queue(0, make_frame(CobId::base(0x185), {1, 2}), 0ns);
  bus_.queue(1, make_frame(CobId::base(0x185), {1, 3}), 0ns);

  const auto first = run(100us);

  ASSERT_FALSE(first.empty());
  EXPECT_EQ(first[0].result, WireResult::destroyed);
  EXPECT_EQ(bus_.node(0).transmit_errors, 8u);
  EXPECT_EQ(bus_.node(1).transmit_errors, 8u);
  run(100ms);
  EXPECT_EQ(bus_.node(0).times_bus_off + bus_.node(1).times_bus_off, 2u);
}

TEST_F(Bus, MergesTwoEqualFramesOfOneIdentifier) {
  bus_.queue(0, frame(0x185), 0ns);
  bus_.queue(1, frame(0x185), 0ns);

  EXPECT_EQ(run(1ms).size(), 1u);
}

TEST_F(Bus, LetsNothingCollideWithAFrameThatWasOnAnotherWire) {
  const BusNodeIndex relay = bus_.attach({.order = QueueOrder::fifo, .relays = true});
  const Frame heartbeat = make_frame(CobId::base(0x702), {0x05});
  const Frame boot_up = make_frame(CobId::base(0x702), {0x00});
  bus_.queue(0, boot_up, 0ns);
  bus_.queue(relay, heartbeat, 0ns);
  bus_.queue(relay, boot_up, 0ns);

  const auto sent = run(1ms);

  ASSERT_EQ(sent.size(), 3u);
  for (const WireFrame& wire : sent) EXPECT_EQ(wire.result, WireResult::sent);
  EXPECT_EQ(sent[0].frame, boot_up);
  EXPECT_EQ(sent[1].frame, heartbeat);
  EXPECT_EQ(sent[2].frame, boot_up);
  EXPECT_EQ(bus_.node(0).transmit_errors, 0u);
}

TEST_F(Bus, DelaysTheFramesOfANodeUpToTheTimeGiven) {
  bus_.node(0).faults.delay = 300us;
  Time longest{};
  for (int i = 0; i < 100; ++i) {
    const Time queued = i * 1ms;
    bus_.queue(0, frame(0x185), queued);
    for (const WireFrame& wire : run(queued + 900us)) {
      longest = std::max(longest, wire.start - queued);
    }
  }

  EXPECT_GT(longest, 200us);
  EXPECT_LE(longest, 300us);
}

TEST_F(Bus, GivesTheSameRunForTheSameSeed) {
  const auto run_once = [](std::uint64_t seed) {
    VirtualBus bus{500'000, Random{seed}};
    for (int i = 0; i < 3; ++i) bus.attach({});
    bus.node(0).faults = {.error = 0.3, .delay = 300us};
    bus.node(1).faults = {.loss = 0.2, .duplicate = 0.2};
    std::vector<Time> ends;
    const WireFrame& wire = bus.wire();
    for (unsigned i = 0; i < 50; ++i) {
      bus.queue(0, make_frame(CobId::base(0x100 + i), {1}), i * 1ms);
      bus.queue(1, make_frame(CobId::base(0x200 + i), {2}), i * 1ms);
      while (bus.next_event() < (i + 1) * 1ms) {
        if (bus.step(bus.next_event())) ends.push_back(wire.end);
      }
    }
    return ends;
  };

  EXPECT_EQ(run_once(5), run_once(5));
  EXPECT_NE(run_once(5), run_once(6));
}

TEST(Random, GivesTheNumbersOfSplitMix64) {
  Random random{1234567};  // reference values of the published algorithm

  EXPECT_EQ(random.next(), 6457827717110365317u);
  EXPECT_EQ(random.next(), 3203168211198807973u);
  EXPECT_EQ(random.next(), 9817491932198370423u);
}

}  // namespace
}  // namespace takt::sim
