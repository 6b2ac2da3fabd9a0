#include <algorithm>
#include <chrono>
#include <fstream>
#include <gtest/gtest.h>
#include <regex>
#include <string>

#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/clock.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/e2e/terminal.hpp"
#include "test/support/folder.hpp"
#include "test/support/time_limit.hpp"

namespace takt::test {
namespace {

using std::chrono::milliseconds;

/// The demo's devices on a unix bus, without a daemon.
class ToolsAlone : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(devices_.says("3 devices on"));  // from here on the devices own the bus
    const Time until = monotonic_now() + time_limit;
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
    const Time until = monotonic_now() + time_limit;
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

TEST_F(ToolsAlone, SdoReportsTheAbortInWordsAndExitsWith1) {
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

TEST_F(ToolsAlone, ScanReportsWhoIsThereAndWhichFileFits) {
  const std::string files = std::string{TAKT_SOURCE_DIR} + "/share/eds";

  const Ended ended = takt({"scan", "--eds-dir", files, "--json"});

  EXPECT_EQ(ended.exit_code, 0) << ended.output;
  for (const char* text :
       {"\"node_id\": 1", "\"node_id\": 2", "\"node_id\": 10", "\"vendor_id\": 43981",
        "\"product_code\": 1026", "takt_drive402.eds\"", "takt_io401.eds\""}) {
    EXPECT_NE(ended.output.find(text), std::string::npos) << text << "\n" << ended.output;
  }
  EXPECT_EQ(ended.output.find("\"node_id\": 3"), std::string::npos);
}

TEST_F(ToolsAlone, OdReadsTheValuesOfADevice) {
  const std::string eds = std::string{TAKT_SOURCE_DIR} + "/share/eds/takt_drive402.eds";
  ASSERT_EQ(takt({"sdo", "write", "1", "6081", "u32", "123456"}).exit_code, 0);

  const Ended live = takt({"od", "--node", "1", "--eds", eds, "6040..6081"});
  const Ended file = run({TAKT, "od", "--eds", eds, "6081"}, folder_.path());

  EXPECT_EQ(live.exit_code, 0) << live.output;
  for (const char* text : {"6041:00  statusword", "0x0250  switch on", "123456"}) {
    EXPECT_NE(live.output.find(text), std::string::npos) << text << "\n" << live.output;
  }
  EXPECT_EQ(file.exit_code, 0) << file.output;
  EXPECT_EQ(file.output.find("123456"), std::string::npos) << file.output;
  EXPECT_NE(file.output.find("no device was asked"), std::string::npos) << file.output;
  EXPECT_EQ(takt({"od", "1", "--eds", eds, "--search", "zzzz"}).exit_code, 1);
}

TEST_F(ToolsAlone, InitWritesANetworkFileThatPlansAndOverwritesNothing) {
  const std::string files = std::string{TAKT_SOURCE_DIR} + "/share/eds";
  const std::string file = (folder_ / "machine.yaml").string();

  const Ended made = takt({"init", "--eds-dir", files, "-o", file});
  const Ended again = takt({"init", "--eds-dir", files, "-o", file});

  EXPECT_EQ(made.exit_code, 0) << made.output;
  const Ended plan = run({TAKT, "plan", file}, folder_.path());
  EXPECT_EQ(plan.exit_code, 0) << plan.output;
  for (const char* text : {"node 1 axis_1", "node 2 axis_2", "node 10 io_10"}) {
    EXPECT_NE(plan.output.find(text), std::string::npos) << text << "\n" << plan.output;
  }
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.output.find("exists already"), std::string::npos) << again.output;
  EXPECT_EQ(takt({"init", "--eds-dir", files, "-o", file, "--force"}).exit_code, 0);
}

TEST(Scan, ExitsWith1WhereNobodyAnswers) {
  const Folder folder;

  const Ended ended = run({TAKT, "scan", "--timeout", "5", "--listen", "0", "--bus",
                           "unix:" + (folder / "empty").string()},
                          folder.path());

  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.output.find("no device answers"), std::string::npos) << ended.output;
}

TEST(Timing, ShowsTheHistogramsOfTheLastSecond) {
  const Folder folder;
  DaemonProcess daemon{slow_network(folder.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  const Ended table = run({TAKT, "timing", "--lcm-url", daemon.lcm_url()}, folder.path());
  const Ended json = run({TAKT, "timing", "--json", "--lcm-url", daemon.lcm_url()}, folder.path());

  EXPECT_EQ(table.exit_code, 0);
  for (const char* text :
       {"SYNC late by", "last PDO after", "image after", "on LCM after", "received after", "█"}) {
    EXPECT_NE(table.output.find(text), std::string::npos) << text << "\n" << table.output;
  }
  EXPECT_EQ(json.exit_code, 0);
  for (const char* text : {"\"sync_lateness\"", "\"sync_to_lcm\"", "\"sync_to_callback\""}) {
    EXPECT_NE(json.output.find(text), std::string::npos) << text << "\n" << json.output;
  }
}

TEST(TwoDevicesOfOneId, AreReportedByTheDaemon) {
  Folder folder;
  const std::string bus = "unix:" + (folder / "bus").string();
  const auto network = slow_network(folder.path());
  DaemonProcess daemon{network, {"--bus", bus}};
  std::vector<std::string> devices{TAKT, "sim", network.string(), "--bus", bus};
  const Process all{devices, folder / "all"};
  devices.insert(devices.end(), {"--only", "elbow"});
  const Process twin{devices, folder / "twin"};

  // The daemon detects the duplicates by their answers, heartbeats or TPDOs. This may happen before
  // the test receives messages, because such a boot may fail at once.
  const auto reported = [&] {
    return daemon.events_in_file("duplicate_node") + daemon.events_in_file("duplicate_cob_id") > 0;
  };
  EXPECT_TRUE(daemon.hear(reported))
      << daemon.log() << "\nall: " << all.output() << "\ntwin: " << twin.output();
}

TEST(Programs, ReportTheirVersion) {
  const Folder folder;
  for (const char* program : {TAKT, TAKTD}) {
    const Ended ended = run({program, "--version"}, folder.path());

    EXPECT_EQ(ended.exit_code, 0);
    EXPECT_TRUE(std::regex_match(ended.output, std::regex{"taktd? \\d+\\.\\d+\\.\\d+\n"}))
        << ended.output;
  }
}

TEST(ToolsWithoutABus, ExitWith3) {
  const Folder folder;

  const Ended ended = run({TAKT, "sdo", "read", "1", "1000", "--bus", "nocan7"}, folder.path());

  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_NE(ended.output.find("nocan7"), std::string::npos);
}

// A script may pass a variable that is not set.
TEST(AnEmptyBus, IsWrongUseForEachProgram) {
  const Folder folder;
  const std::string network = slow_network(folder.path()).string();

  for (std::vector<std::string> line : {std::vector<std::string>{TAKTD, network, "--check"},
                                        {TAKTD, network, "--for", "1s"},
                                        {TAKT, "audit", network},
                                        {TAKT, "doctor"},
                                        {TAKT, "dump", network},
                                        {TAKT, "lss", "find"},
                                        {TAKT, "nmt", "start", "1"},
                                        {TAKT, "scan"},
                                        {TAKT, "sdo", "read", "1", "1000"},
                                        {TAKT, "sim", network, "--for", "1s"}}) {
    line.insert(line.end(), {"--bus", ""});
    const Ended ended = run(line, folder.path());
    EXPECT_EQ(ended.exit_code, 2) << line[0] << " " << line[1];
    EXPECT_NE(ended.output.find("the name of the bus is empty: name a bus, such as can0, or leave "
                                "--bus out (`interface:` in a network file names the bus, too)"),
              std::string::npos)
        << line[1] << ": " << ended.output;
  }
}

TEST(Top, TurnsItsPagesScrollsByArrowsAndQuitsOnQ) {
  const Folder folder;
  DaemonProcess daemon{slow_network(folder.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  Terminal top{{TAKT, "top", "--lcm-url", daemon.lcm_url()}};

  for (const char* text : {"shoulder", "switch on disabled", "elbow", " rad/s", "stat "}) {
    EXPECT_TRUE(top.shows(text));
  }
  top.press("6");
  EXPECT_TRUE(top.shows("operational"));
  top.press("5");
  EXPECT_TRUE(top.shows("SYNC late by"));
  top.press("3");
  for (const char* text : {"io.inputs_1_to_8", "arrows scroll", "[1-"}) {
    EXPECT_TRUE(top.shows(text));
  }
  top.press("\033[B\033[B");
  EXPECT_TRUE(top.shows("[3-"));
  top.press("k");
  EXPECT_TRUE(top.shows("[2-"));
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

TEST(Top, LeavesTheTerminalAsItWasAfterEachSignalThatEndsIt) {
  for (const int number : {SIGINT, SIGTERM, SIGQUIT, SIGHUP}) {
    Terminal top{{TAKT, "top", "--lcm-url", "tcpq://127.0.0.1:9"}};
    EXPECT_TRUE(top.shows("no daemon"));
    top.signal(number);
    EXPECT_TRUE(top.shows("\033[?1049l")) << number;
    EXPECT_EQ(top.wait(), 0) << number;
    EXPECT_TRUE(top.is_as_before()) << number;
  }
}

}  // namespace
}  // namespace takt::test
