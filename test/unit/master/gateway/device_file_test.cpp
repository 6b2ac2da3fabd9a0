// The service that tells programs where the device file of a node is.
#include <gtest/gtest.h>
#include <optional>

#include "master/gateway/bridge.hpp"
#include "test/unit/master/gateway/rig_clocks.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// Hands one request to the daemon and keeps its answer.
class OneRequest final : public Transport {
 public:
  bool publish(const std::string&, std::span<const std::byte> data) override {
    if (const auto reply = decode<reply_t>(data)) answer = *reply;
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler& handler) override {
    if (!waiting) return;
    std::vector<std::byte> bytes;
    encode(*waiting, bytes);
    waiting.reset();
    handler(channel, bytes);
  }
  bool drained() const override { return !waiting; }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  std::string channel;
  std::optional<request_t> waiting;
  std::optional<reply_t> answer;
};

class DeviceFile : public testing::Test {
 protected:
  reply_t ask(std::int16_t node) {
    request_t request{};
    request.schema = message_schema;
    request.service = "device_file";
    request.node_id = node;
    request.id = ++id;
    request.utime = clocks.now() / std::chrono::microseconds{1};
    lcm.channel = bridge.channels().request;
    lcm.waiting = request;
    lcm.answer.reset();
    for (int i = 0; i < 20 && !lcm.answer; ++i) {
      rig.master->cycle();
      bridge.serve();
    }
    EXPECT_TRUE(lcm.answer);
    return lcm.answer.value_or(reply_t{});
  }

  test::Rig rig{test::axes({.nodes = 2, .period = 4ms})};
  test::RigClocks clocks{rig};
  OneRequest lcm;
  std::int64_t id = 0;
  Bridge bridge{
      *rig.master,
      lcm,
      clocks,
      {.session = 7, .interface = {}, .realtime = {}, .device_files = {"/eds/first.eds", ""}},
      [](const Notice&) {}};
};

TEST_F(DeviceFile, IsTheAnswerForANodeThatHasOne) {
  const reply_t known = ask(1);
  EXPECT_NE(known.good, 0);
  EXPECT_EQ(known.text, "/eds/first.eds");
}

TEST_F(DeviceFile, IsRefusedForOtherNodes) {
  for (const int node : {2, 3, 0, -1, 32767}) {
    const reply_t unknown = ask(static_cast<std::int16_t>(node));
    EXPECT_EQ(unknown.good, 0) << node;
    EXPECT_EQ(unknown.text, "no device file of node " + std::to_string(node) + " is known");
  }
}

}  // namespace
}  // namespace takt
