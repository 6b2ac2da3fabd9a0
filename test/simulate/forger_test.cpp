#include "apps/takt/simulate/program/forger.hpp"

#include <gtest/gtest.h>

#include "apps/takt/simulate/program/virtual_daemon.hpp"
#include "master/lcm/messages.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// A bus with a cycle of 2 ms whose programs have sent one image and one command, both of cycle
/// 500.
class ForgedMessages : public testing::Test {
 protected:
  ForgedMessages() {
    listener.subscribe(channels.command);
    listener.subscribe(channels.image);
    world.advance_to(1s);
    speak();
  }

  void speak() {
    image_t image{};
    image.session = 7;
    image.cycle = world.now() / 2ms;
    image.sync_mono_ns = world.now().count();
    speaker.publish(channels.image, encode(image, buffer));
    command_t command{};
    command.session = 7;
    command.cycle = image.cycle;
    command.sender = "genuine";
    speaker.publish(channels.command, encode(command, buffer));
    pass(1ms);
    listener.serve([](std::string_view, Bytes) {});
  }
  void pass(Time span) {
    world.advance_to(world.now() + span);
    if (forger.next() <= world.now()) forger.act(world.now());
  }
  std::vector<std::int64_t> forged_cycles() {
    std::vector<std::int64_t> cycles;
    listener.serve([&](std::string_view channel, Bytes data) {
      if (channel == channels.image) {
        cycles.push_back(decode<image_t>(data)->cycle);
      } else if (const auto command = decode<command_t>(data); command->session == 7) {
        cycles.push_back(command->cycle);
      }
    });
    return cycles;
  }

  BusPlan plan = test::axes();
  sim::World world{{}, {}};
  VirtualLcm lcm{world, sim::Random{1}};
  Channels channels{plan.name};
  VirtualEndpoint& speaker = lcm.join(10);
  VirtualEndpoint& listener = lcm.join(10'000);
  Forger forger{plan, lcm, [](SignalIndex, std::int64_t) {}, sim::Random{2}};
  std::vector<std::byte> buffer;
};

/// 200 s are 100,000 cycles, so a cycle that was far ahead of the command becomes the true cycle.
TEST_F(ForgedMessages, HaveACycleThatIsFarFromTheTrueOneHoweverOldTheCommandIs) {
  std::size_t seen = 0;
  for (unsigned second = 0; second < 200; ++second) {
    for (int i = 0; i < 20; ++i) {
      forger.forge_command(world.now());
      forger.forge_image(world.now());
    }
    pass(1s);
    for (const std::int64_t cycle : forged_cycles()) {
      if (cycle <= 0) continue;  // refused with any true cycle
      ++seen;
      EXPECT_GT(std::abs(cycle - world.now() / 2ms), 2000) << cycle;
    }
  }
  EXPECT_GT(seen, 2000U);
}

TEST_F(ForgedMessages, AreNothingToLearnFrom) {
  for (int i = 0; i < 300; ++i) {
    forger.forge_command(world.now());
    pass(10ms);
  }
  forged_cycles();
  pass(3s);

  for (int i = 0; i < 20; ++i) forger.replay(world.now());
  pass(1ms);

  for (const std::int64_t cycle : forged_cycles()) EXPECT_TRUE(cycle == 500 || cycle == 0) << cycle;
  EXPECT_EQ(forger.sent(), 320U) << "a replay has more than the one genuine command";
}

}  // namespace
}  // namespace takt
