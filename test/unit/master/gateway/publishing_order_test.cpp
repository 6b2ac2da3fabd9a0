#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

#include "master/gateway/bridge.hpp"
#include "test/unit/master/gateway/rig_clocks.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// Records the channels of the published messages in order.
class SentChannels final : public Transport {
 public:
  bool publish(const std::string& channel, std::span<const std::byte>) override {
    sent.push_back(channel);
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler&) override {}
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  std::vector<std::string> sent;
};

TEST(PublishingOrder, NothingOfACycleGoesOutBeforeItsImage) {
  test::Rig rig{test::axes({.nodes = 3, .period = 4ms})};
  ASSERT_TRUE(rig.boot());
  SentChannels lcm;
  BridgeOptions options;
  options.session = 7;
  const test::RigClocks clocks{rig};
  Bridge bridge{*rig.master, lcm, clocks, options, [](const Notice&) {}};
  bridge.serve();

  for (int cycle = 0; cycle < 50; ++cycle) {
    rig.master->cycle();
    lcm.sent.clear();
    ASSERT_TRUE(bridge.serve());

    const auto typed = std::ranges::count_if(
        lcm.sent, [](const std::string& channel) { return channel.ends_with("_STATE"); });
    EXPECT_EQ(typed, 3);
    EXPECT_EQ(lcm.sent.front(), bridge.channels().image);
    EXPECT_EQ(std::ranges::count(lcm.sent, bridge.channels().image), 1);
  }
}

/// Returns the number of kinds of states that were sent. A state may have several parts.
int states(const Bridge& bridge, const SentChannels& lcm) {
  const Channels& names = bridge.channels();
  int kinds = 0;
  for (const std::string& name : {names.layout, names.status, names.pdos, names.timing}) {
    kinds += std::ranges::count(lcm.sent, name) != 0 ? 1 : 0;
  }
  return kinds;
}

TEST(PublishingOrder, AStateFollowsAnImageAndNeverComesJustBeforeOne) {
  test::Rig rig{test::axes({.nodes = 3, .period = 4ms})};
  ASSERT_TRUE(rig.boot());
  SentChannels lcm;
  const test::RigClocks clocks{rig};
  Bridge bridge{*rig.master, lcm, clocks, {}, [](const Notice&) {}};
  bridge.serve();

  int all = 0;
  for (int cycle = 0; cycle < 1000; ++cycle) {
    lcm.sent.clear();
    EXPECT_FALSE(bridge.serve());
    EXPECT_EQ(states(bridge, lcm), 0) << "cycle " << cycle;
    rig.master->cycle();
    ASSERT_TRUE(bridge.serve());
    EXPECT_LE(states(bridge, lcm), 1) << "cycle " << cycle;
    all += states(bridge, lcm);
  }
  EXPECT_NEAR(all, 40 + 8 + 4 + 4, 4);  // in 4 s
}

}  // namespace
}  // namespace takt
