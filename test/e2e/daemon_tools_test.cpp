// Tools that work through a running daemon, and tools that work beside it.
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "master/core/node_status.hpp"
#include "master/lcm/link/lcm_client.hpp"
#include "master/lcm/messages.hpp"
#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/clock.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"
#include "test/support/time_limit.hpp"

namespace takt::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class ToolsAndDaemon : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(daemon_.hear([&] { return daemon_.all_ready(); })) << daemon_.log();
  }
  Ended takt(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), TAKT);
    arguments.insert(arguments.end(), {"--lcm-url", daemon_.lcm_url()});
    return run(std::move(arguments), folder_.path());
  }
  bool is(const std::string& node, NmtState state) {
    for (const node_status_t& status : daemon_.bus().status()->nodes) {
      if (status.name == node) return status.nmt_state == static_cast<int>(state);
    }
    return false;
  }

  Folder folder_;
  DaemonProcess daemon_{slow_network(folder_.path())};
};

TEST_F(ToolsAndDaemon, SdoReadsAndWritesANodeByItsName) {
  const Ended written = takt({"sdo", "write", "elbow", "6081", "u32", "123456"});
  EXPECT_EQ(written.exit_code, 0) << written.output;

  const Ended read = takt({"sdo", "read", "elbow", "6081", "u32"});
  EXPECT_EQ(read.exit_code, 0);
  EXPECT_EQ(read.output, "123456\n");
  EXPECT_EQ(takt({"sdo", "read", "shoulder", "6081", "u32"}).output, "100000\n");

  const Ended refused = takt({"sdo", "write", "elbow", "1000", "u32", "0"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.output.find("0x06010002"), std::string::npos) << refused.output;
}

TEST_F(ToolsAndDaemon, SdoKnowsTheObjectsOfTheDeviceFileAndOfTheImageByTheirNames) {
  const Ended written = takt({"sdo", "write", "elbow", "profile_velocity", "123456"});
  EXPECT_EQ(written.exit_code, 0) << written.output;
  EXPECT_EQ(takt({"sdo", "read", "elbow", "profile_velocity"}).output, "123456\n");
  EXPECT_EQ(takt({"sdo", "read", "2", "6081", "u32"}).output, "123456\n");
  EXPECT_EQ(takt({"sdo", "read", "elbow", "identity_object.vendor_id"}).output, "43981\n");

  const Ended unknown = takt({"sdo", "read", "elbow", "statuswrd"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.output.find("did you mean 'statusword'?"), std::string::npos) << unknown.output;
  const Ended mapped = takt({"sdo", "read", "elbow", "statusword", "--json"});
  EXPECT_EQ(nlohmann::json::parse(mapped.output, nullptr, false)["index"], 0x6041) << mapped.output;
}

TEST_F(ToolsAndDaemon, OdShowsLiveValuesWithUnitsAndMeanings) {
  const Ended state = takt({"od", "elbow", "--search", "statusword"});
  EXPECT_EQ(state.exit_code, 0) << state.output;
  EXPECT_NE(state.output.find("0x0250  switch on"), std::string::npos) << state.output;

  const Ended limits = takt({"od", "elbow", "6081", "--json"});
  const auto json = nlohmann::json::parse(limits.output, nullptr, false);
  ASSERT_TRUE(json.is_object()) << limits.output;
  EXPECT_EQ(json["node"], "elbow");
  EXPECT_EQ(json["objects"][0]["value"], 100000);
  EXPECT_EQ(json["objects"][0]["unit"], "rad/s");
  EXPECT_EQ(takt({"od", "nobody"}).exit_code, 2);
}

TEST_F(ToolsAndDaemon, SdoLeavesTheTimeOutToTheNodeUnlessOneIsGiven) {
  auto lcm = LcmClient::open(daemon_.lcm_url(), {".*_STATUS", ".*_REQUEST"}).value();
  std::vector<std::int32_t> timeouts;
  int statuses = 0;
  const auto take = [&](std::string_view channel, std::span<const std::byte> data) {
    statuses += channel.ends_with("_STATUS");
    if (!channel.ends_with("_REQUEST")) return;
    if (const auto request = decode<request_t>(data)) timeouts.push_back(request->timeout_ms);
  };
  const Time until = monotonic_now() + time_limit;
  while (statuses == 0 && monotonic_now() < until) lcm.serve(take, monotonic_now() + seconds{1});

  EXPECT_EQ(takt({"sdo", "read", "elbow", "6081", "u32"}).exit_code, 0);
  EXPECT_EQ(takt({"sdo", "read", "elbow", "6081", "u32", "--timeout", "20000"}).exit_code, 0);

  while (timeouts.size() < 2 && monotonic_now() < until) {
    lcm.serve(take, monotonic_now() + seconds{1});
  }
  EXPECT_EQ(timeouts, (std::vector<std::int32_t>{0, 20000}));
}

TEST_F(ToolsAndDaemon, NmtStopsAndStartsANodeByItsName) {
  const Ended preop = takt({"nmt", "preop", "io"});
  EXPECT_EQ(preop.exit_code, 0) << preop.output;
  EXPECT_TRUE(daemon_.hear([&] { return is("io", NmtState::preoperational); })) << daemon_.log();
  EXPECT_TRUE(is("elbow", NmtState::operational));

  const Ended start = takt({"nmt", "start", "io"});
  EXPECT_EQ(start.exit_code, 0) << start.output;
  EXPECT_TRUE(daemon_.hear([&] { return is("io", NmtState::operational); })) << daemon_.log();

  const Ended unknown = takt({"nmt", "start", "nobody"});
  EXPECT_NE(unknown.exit_code, 0);
  EXPECT_NE(unknown.output.find("nobody"), std::string::npos) << unknown.output;
}

TEST_F(ToolsAndDaemon, StatusReportsBusAndNodes) {
  const Ended plain = takt({"status"});
  EXPECT_EQ(plain.exit_code, 0) << plain.output;
  for (const char* text :
       {"demo  on sim", "1000 kbit/s", "error active", "shoulder", "elbow", "operational"}) {
    EXPECT_NE(plain.output.find(text), std::string::npos) << text << '\n' << plain.output;
  }

  const Ended json = takt({"status", "--json"});
  EXPECT_EQ(json.exit_code, 0);
  const auto document = nlohmann::json::parse(json.output, nullptr, false);
  ASSERT_TRUE(document.is_object()) << json.output;
  ASSERT_EQ(document["buses"].size(), 1U);
  const auto& bus = document["buses"][0];
  EXPECT_EQ(bus["bus"], "demo");
  EXPECT_EQ(bus["period_ns"], slow_period * 1000);
  EXPECT_EQ(bus["event_overruns"], 0);
  EXPECT_EQ(bus["sync"]["state"], "made");
  ASSERT_EQ(bus["nodes"].size(), 3U);
  EXPECT_EQ(bus["nodes"][2]["name"], "io");
  EXPECT_EQ(bus["nodes"][2]["nmt_state"], "operational");
  EXPECT_EQ(bus["nodes"][2]["boot"], "ready");
}

/// On a bus of other nodes, their frames fill the image, and the observing daemon sends nothing.
TEST(ObservingDaemon, FillsItsImageAndSendsNothing) {
  const Folder folder;
  const std::string bus = "unix:" + (folder / "bus").string();
  auto others = FrameChannel::open(bus);
  ASSERT_TRUE(others.has_value());
  DaemonProcess daemon{slow_network(folder.path()), {"--bus", bus, "--observe"}};
  const std::array<Frame, 3> frames{
      make_frame(CobId::base(0x701), {0x05}),
      make_frame(CobId::base(0x181), {0x37, 0x02, 0xD2, 0x04, 0, 0}),  // 1234 counts
      make_frame(CobId::base(0x080), {})};
  std::size_t heard = 0;
  const auto traffic = [&] {
    others->send(frames);
    for (StampedFrame got; others->receive(got, Time{0});) ++heard;
  };

  EXPECT_TRUE(daemon.work(traffic, [&] {
    return !daemon.bus().values().empty() &&
           daemon.value("shoulder", "position_actual_value") == 1234 &&
           daemon.value("shoulder", "statusword") == 0x0237;
  })) << daemon.log();
  const std::int64_t cycle = daemon.bus().cycle();
  EXPECT_TRUE(daemon.work(traffic, [&] { return daemon.bus().cycle() > cycle + 50; }));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
  traffic();
  EXPECT_EQ(heard, 0U);
}

TEST(Dump, ShowsTheFramesOfAUnixBus) {
  const Folder folder;
  const std::string bus = "unix:" + (folder / "bus").string();
  auto others = FrameChannel::open(bus);
  ASSERT_TRUE(others.has_value());
  Process dump{{TAKT, "dump", "--bus", bus, "--count", "3"}, folder / "dump"};

  const Frame heartbeat = make_frame(CobId::base(0x705), {0x05});
  const auto exit_code = dump.wait([&] { others->send(heartbeat); });

  EXPECT_EQ(exit_code, 0) << dump.output();
  EXPECT_NE(dump.output().find("705"), std::string::npos) << dump.output();
  EXPECT_NE(dump.output().find("operational"), std::string::npos) << dump.output();
}

TEST(EdsCheck, ExitsWith1WhereAFileHasAnError) {
  const Folder folder;
  std::string text = read_file(TAKT_SOURCE_DIR "/share/eds/takt_io401.eds");
  std::ofstream{folder / "good.eds"} << text;
  const std::string rpdo1 = "DefaultValue=$NODEID+0x00000200";
  text.replace(text.find(rpdo1), rpdo1.size(), "DefaultValue=0x585");  // an SDO answer
  std::ofstream{folder / "bad.eds"} << text;

  const Ended good = run({TAKT, "eds", "check", (folder / "good.eds").string()}, folder.path());
  const Ended bad = run({TAKT, "eds", "check", (folder / "bad.eds").string()}, folder.path());

  EXPECT_EQ(good.exit_code, 0) << good.output;
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_NE(bad.output.find("bad.eds:"), std::string::npos) << bad.output;
  EXPECT_NE(bad.output.find("[cob-id-restricted]"), std::string::npos) << bad.output;
}

}  // namespace
}  // namespace takt::test
