#include <gtest/gtest.h>
#include <vector>

#include "master/gateway/bridge.hpp"
#include "test/unit/master/gateway/restless_port.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time work = 100us;  // cost of each answer and each event

/// The time of a rig plus the work of the front thread, which takes no time in the rig itself.
class WorkClocks final : public Clocks {
 public:
  explicit WorkClocks(const test::Rig& rig) : rig_{rig} {}
  Time now() const noexcept override { return rig_.world->now() + worked; }
  Time wall_offset() const noexcept override { return {}; }

  Time worked{};

 private:
  const test::Rig& rig_;
};

/// A transport that hands over requests. Each published answer costs work.
class SlowTransport final : public Transport {
 public:
  explicit SlowTransport(WorkClocks& clocks) : clocks_{clocks} {}
  bool publish(const std::string& channel, std::span<const std::byte>) override {
    if (channel == "TEST_REPLY") {
      clocks_.worked += work;
      ++replies;
    }
    images += channel == "TEST_IMAGE" ? 1 : 0;
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler& handler) override {
    for (const request_t& request : std::exchange(requests, {})) {
      handler("TEST_REQUEST", encode(request, buffer_));
    }
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  std::vector<request_t> requests;
  int replies = 0;
  int images = 0;

 private:
  WorkClocks& clocks_;
  std::vector<std::byte> buffer_;
};

/// A guest for which each event costs work.
class SlowGuest final : public FrontGuest {
 public:
  explicit SlowGuest(WorkClocks& clocks) : clocks_{clocks} {}
  void take(const Reply&) override {}
  void hear(const Event&) override {
    clocks_.worked += work;
    ++events;
  }
  void see(const ImageView&) override {}

  std::uint64_t events = 0;

 private:
  WorkClocks& clocks_;
};

request_t upload(std::int64_t id, Time now) {
  request_t request{};
  request.schema = message_schema;
  request.utime = now / 1us;
  request.id = id;
  request.sender = "a program";
  request.service = "sdo_upload";
  request.node_id = 1;
  request.index = 0x1000;
  return request;
}

TEST(FrontBudget, ManyAnswersAtOnceDoNotHoldUpTheNextImage) {
  test::Rig rig{test::axes({.nodes = 1, .period = 4ms})};
  ASSERT_TRUE(rig.boot());
  WorkClocks clocks{rig};
  SlowTransport lcm{clocks};
  Bridge bridge{*rig.master, lcm, clocks, {}, [](const Notice&) {}};
  while (bridge.serve() || bridge.has_unsent_reports()) {
  }
  for (int id = 1; id <= 12; ++id) lcm.requests.push_back(upload(id, clocks.now()));
  bridge.serve();
  ASSERT_EQ(lcm.replies, 0);
  rig.run(60);  // the bus thread has answered all of them

  std::vector<int> each_round;
  int answered = 0;
  for (int round = 0; round < 5; ++round) {
    rig.master->cycle();
    lcm.images = 0;
    bridge.serve();
    EXPECT_GE(lcm.images, round == 4 ? 0 : 1) << "round " << round;
    EXPECT_EQ(bridge.next_message() == Time{}, bridge.has_unsent_reports()) << "round " << round;
    each_round.push_back(lcm.replies - answered);
    answered = lcm.replies;
  }

  EXPECT_EQ(each_round, (std::vector<int>{3, 3, 3, 3, 0})) << "300 us are beyond 250 us";
  EXPECT_FALSE(bridge.has_unsent_reports());
}

TEST(FrontBudget, AStormOfEventsIsTakenInPiecesAndNoneIsLost) {
  test::Rig rig{test::axes({.period = 4ms})};
  test::RestlessPort port{*rig.port};
  rig.use(port);
  WorkClocks clocks{rig};
  SlowTransport lcm{clocks};
  SlowGuest guest{clocks};
  Bridge bridge{*rig.master, lcm, clocks, {}, [](const Notice&) {}};
  bridge.register_guest(guest);
  for (int i = 0; i < 500; ++i) rig.master->cycle();  // the front thread sleeps meanwhile

  bridge.serve();
  EXPECT_EQ(guest.events, 3U) << "in one round";
  EXPECT_TRUE(bridge.has_unsent_reports());
  EXPECT_EQ(bridge.next_message(), Time{}) << "the next round begins at once";
  int rounds = 0;
  for (; bridge.has_unsent_reports() && rounds < 1000; ++rounds) bridge.serve();

  EXPECT_GT(guest.events, 450U);
  EXPECT_LT(rounds, 400);
  EXPECT_EQ(rig.master->event_overruns(), 0U);
}

}  // namespace
}  // namespace takt
