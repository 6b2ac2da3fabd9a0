#include <gtest/gtest.h>
#include <vector>

#include "master/gateway/bridge.hpp"
#include "test/unit/master/gateway/restless_port.hpp"
#include "test/unit/master/gateway/rig_clocks.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

class NobodyHears final : public Transport {
 public:
  bool publish(const std::string&, std::span<const std::byte>) override { return true; }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler&) override {}
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }
};

TEST(LostEvents, AreReportedOnceWithTheirNumber) {
  test::Rig rig{test::axes({.period = 4ms})};
  test::RestlessPort port{*rig.port};
  rig.use(port);
  NobodyHears lcm;
  std::vector<std::string> texts;
  const test::RigClocks clocks{rig};
  Bridge bridge{*rig.master, lcm, clocks, {}, [&](const Notice& notice) {
                  if (notice.kind == "events_lost") texts.push_back(notice.text);
                }};

  for (int i = 0; i < 1200; ++i) rig.master->cycle();  // the front thread sleeps meanwhile
  const std::uint64_t lost = rig.master->event_overruns();
  bridge.serve();
  bridge.serve();

  EXPECT_GT(lost, 100U);
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_EQ(texts[0], "bus 'test': " + std::to_string(lost) +
                          " events were lost: more events came at once than the queue holds");
}

TEST(Notices, CarryNoControlCharacterToATerminal) {
  test::Rig rig{test::axes({.period = 4ms})};
  NobodyHears lcm;
  std::vector<std::string> texts;
  const test::RigClocks clocks{rig};
  Bridge bridge{
      *rig.master, lcm, clocks, {}, [&](const Notice& notice) { texts.push_back(notice.text); }};

  bridge.announce(
      Notice{.node = 0, .kind = "test", .weight = Weight::note, .text = "a\x1B[2J\n  b"});

  EXPECT_EQ(texts, (std::vector<std::string>{"a?[2J\n  b"}));
}

}  // namespace
}  // namespace takt
