#include <algorithm>
#include <chrono>
#include <gtest/gtest.h>
#include <regex>
#include <string>

#include "master/linux/clock.hpp"
#include "master/linux/frame_channel.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/e2e/terminal.hpp"

namespace takt::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// The demo's devices on a unix bus, without a daemon.
class ToolsAlone : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(devices_.says("3 devices on"));  // from here on they hold the bus
    const Time until = monotonic_now() + seconds{60};
    while (takt({"sdo", "read", "1", "1000", "--timeout", "100"}).exit_code != 0) {
      ASSERT_LT(monotonic_now(), until) << devices_.output();
    }
  }

  Ended takt(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), TAKT);
    arguments.insert(arguments.end(), {"--bus", bus_});
    return run(std::move(arguments), folder_.path());
  }
  /// Waits for this frame on the bus.
  static bool comes(FrameChannel& channel, CobId id, std::uint8_t first_byte) {
    const Time until = monotonic_now() + seconds{60};
    StampedFrame got;
    while (monotonic_now() < until) {
      if (!channel.receive(got, milliseconds{100})) continue;
      if (got.frame.id == id && got.frame.length == 1 && got.frame.data[0] == first_byte) {
        return true;
      }
    }
    return false;
  }

  Folder folder_;
  std::string bus_ = "unix:" + (folder_ / "bus").string();
  Process devices_{{TAKT, "sim", slow_network(folder_.path()).string(), "--bus", bus_},
                   folder_ / "devices"};
};

TEST_F(ToolsAlone, SdoReadsAndWritesADeviceWithoutADaemon) {
  EXPECT_EQ(takt({"sdo", "write", "1", "6081", "u32", "123456"}).exit_code, 0);

  const Ended read = takt({"sdo", "read", "1", "6081", "u32"});

  EXPECT_EQ(read.exit_code, 0);
  EXPECT_EQ(read.output, "123456\n");
}

TEST_F(ToolsAlone, SdoTellsTheAbortInWordsAndExitsWith1) {
  const Ended refused = takt({"sdo", "write", "1", "1000", "u32", "0"});
  const Ended mute = takt({"sdo", "read", "99", "1000", "u32", "--timeout", "50"});

  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.output.find("0x06010002 (attempt to write a read-only object)"),
            std::string::npos)
      << refused.output;
  EXPECT_EQ(mute.exit_code, 1);
  EXPECT_NE(mute.output.find("node 99 1000:00"), std::string::npos) << mute.output;
}

TEST_F(ToolsAlone, NmtStartsAndStopsADeviceWithoutADaemon) {
  auto channel = FrameChannel::open(bus_);
  ASSERT_TRUE(channel.has_value());
  ASSERT_EQ(takt({"sdo", "write", "1", "1017", "u16", "20"}).exit_code, 0);
  const CobId heartbeat = CobId::base(0x701);

  ASSERT_TRUE(comes(*channel, heartbeat, 0x7F));  // pre-operational
  EXPECT_EQ(takt({"nmt", "start", "1"}).exit_code, 0);
  EXPECT_TRUE(comes(*channel, heartbeat, 0x05));  // operational
  EXPECT_EQ(takt({"nmt", "stop", "all"}).exit_code, 0);
  EXPECT_TRUE(comes(*channel, heartbeat, 0x04));  // stopped
}

TEST(ToolsWithoutABus, ExitWith3) {
  const Folder folder;

  const Ended ended = run({TAKT, "sdo", "read", "1", "1000", "--bus", "nocan7"}, folder.path());

  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_NE(ended.output.find("nocan7"), std::string::npos);
}

TEST(Top, ShowsNodesAndValuesScrollsByArrowsAndQuitsOnQ) {
  const Folder folder;
  DaemonProcess daemon{slow_network(folder.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  Terminal top{{TAKT, "top", "--lcm-url", daemon.lcm_url()}};

  for (const char* text : {"shoulder", "operational", "elbow", "position_actual_value", " rad",
                           "SYNC late by", "arrows scroll"}) {
    EXPECT_TRUE(top.shows(text));
  }
  std::smatch at;
  const std::string before = top.shown();
  ASSERT_TRUE(std::regex_search(before, at, std::regex{"\\[(\\d+) of"}));
  top.press("\033[B\033[B");
  EXPECT_TRUE(top.shows("[" + std::to_string(std::stoi(at[1]) + 2) + " of"));
  top.press("k");
  EXPECT_TRUE(top.shows("[" + std::to_string(std::stoi(at[1]) + 1) + " of"));
  top.press("q");
  EXPECT_EQ(top.wait(), 0);
  EXPECT_TRUE(top.is_as_before());
}

TEST(Top, SaysWhereItLooksWhenNoDaemonAnswersAndQuits) {
  Terminal top{{TAKT, "top", "--lcm-url", "tcpq://127.0.0.1:9"}};

  EXPECT_TRUE(top.shows("no daemon"));
  top.press("q");
  EXPECT_EQ(top.wait(), 0);
}

}  // namespace
}  // namespace takt::test
