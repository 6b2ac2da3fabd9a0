#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "master/lcm/channel_names.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

class Taktd : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream{folder_ / name} << text;
    return folder_ / name;
  }

  Folder folder_;
};

/// The next controlword on the way to Operation enabled. CiA 402-2.
std::int64_t next_controlword(std::int64_t statusword) {
  if ((statusword & 0x4F) == 0x40) return 0x06;
  return (statusword & 0x6F) == 0x21 ? 0x07 : 0x0F;
}

TEST_F(Taktd, BootsTheDemoAndPublishesAnImageEachCycle) {
  DaemonProcess daemon{slow_network(folder_.path())};

  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  const auto images = static_cast<std::int64_t>(daemon.bus().images());
  const std::int64_t cycle = daemon.bus().cycle();
  const std::int64_t missed = daemon.bus().status()->cycles_missed;
  const auto heard = [&] { return static_cast<std::int64_t>(daemon.bus().images()) - images; };
  ASSERT_TRUE(daemon.hear([&] { return heard() >= 100; }));

  const std::int64_t without_image = daemon.bus().cycle() - cycle - heard();
  EXPECT_TRUE(daemon.hear([&] {
    return daemon.bus().status()->cycles_missed - missed >= without_image;
  })) << without_image
      << " cycles had no image, and not all of them were missed";
  EXPECT_EQ(daemon.events_in_file("boot_done"), 3U);
}

TEST_F(Taktd, HoldsItsSimulatedDevicesWhileItIsHeldItself) {
  DaemonProcess daemon{slow_network(folder_.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  // If a busy machine stalls the daemon once more, SYNC is late for the devices too, so the test
  // has three tries.
  bool unnoticed = false;
  for (int tries = 0; tries < 3 && !unnoticed; ++tries) {
    const std::size_t emcys = daemon.events("emcy");
    const std::size_t stalls = daemon.events("cycles_missed");
    daemon.stop_for(std::chrono::milliseconds{600});  // the consumer time is 300 ms
    ASSERT_TRUE(daemon.hear([&] { return daemon.events("cycles_missed") > stalls; }));
    const std::int64_t cycle = daemon.bus().cycle();
    ASSERT_TRUE(daemon.hear([&] { return daemon.bus().cycle() >= cycle + 50; }));
    unnoticed = daemon.events("emcy") == emcys;
  }
  EXPECT_TRUE(unnoticed) << "the devices missed the SYNC\n" << daemon.log();
  EXPECT_EQ(daemon.events("heartbeat_lost"), 0U);
}

TEST_F(Taktd, CommandsMoveAnAxisAndEndWithTheirTimeToLive) {
  DaemonProcess daemon{slow_network(folder_.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  std::int64_t target = daemon.value("shoulder", "position_actual_value");
  std::int64_t cycle = 0;
  const auto follow = [&] {
    if (daemon.bus().cycle() == cycle) return;
    cycle = daemon.bus().cycle();
    const std::int64_t word = daemon.value("shoulder", "statusword");
    if ((word & 0x6F) == 0x27 && target < 2000) target += 20;
    daemon.command(daemon.command_for("e2e", {{"shoulder.controlword", next_controlword(word)},
                                              {"shoulder.modes_of_operation", 8},
                                              {"shoulder.target_position", target}}));
  };

  EXPECT_TRUE(daemon.work(
      follow, [&] { return daemon.value("shoulder", "position_actual_value") >= 1990; }));
  EXPECT_TRUE(daemon.hear([&] { return daemon.events("fallback_begun") > 0; }));
  EXPECT_TRUE(daemon.hear([&] { return (daemon.value("shoulder", "statusword") & 0x6F) != 0x27; }))
      << "the quick stop of the network file did not end operation";
}

TEST_F(Taktd, RefusesSecondSendersAndOldSessions) {
  DaemonProcess daemon{slow_network(folder_.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  const auto both = [&] {
    daemon.command(daemon.command_for("first", {{"io.outputs_1_to_8", 1}}));
    daemon.command(daemon.command_for("second", {{"io.outputs_1_to_8", 2}}));
    command_t replayed = daemon.command_for("third", {{"io.outputs_1_to_8", 3}});
    replayed.session -= 1;
    daemon.command(replayed);
  };

  EXPECT_TRUE(daemon.work(both, [&] {
    return daemon.events("command_refused", "belong to 'first'") > 0 &&
           daemon.events("command_refused", "another session") > 0;
  }));
}

/// A session number derived from the clock could be guessed: the numbers of two starts would be
/// close together.
TEST_F(Taktd, HasASessionThatNobodyCanGuess) {
  std::array<std::int64_t, 2> sessions{};
  for (std::int64_t& session : sessions) {
    DaemonProcess daemon{slow_network(folder_.path())};
    ASSERT_TRUE(daemon.hear([&] { return daemon.bus().session() != 0; }));
    session = daemon.bus().session();
  }
  constexpr std::uint64_t a_minute_of_ns = 1ULL << 36U;
  const auto apart =
      static_cast<std::uint64_t>(sessions[0]) - static_cast<std::uint64_t>(sessions[1]);
  EXPECT_GT(std::min(apart, 0 - apart), a_minute_of_ns) << sessions[0] << " " << sessions[1];
}

TEST_F(Taktd, SurvivesGarbageOnItsChannels) {
  DaemonProcess daemon{slow_network(folder_.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  std::vector<std::byte> garbage(300, std::byte{0xEE});
  std::vector<std::byte> buffer;
  command_t huge = daemon.command_for("e2e", {{"io.outputs_1_to_8", 1}});
  std::vector<std::byte> damaged{encode(huge, buffer).begin(), encode(huge, buffer).end()};
  damaged[damaged.size() - 14] = std::byte{0x7F};  // highest byte of num_values

  const bool reported = daemon.work(
      [&] {
        daemon.publish("DEMO_COMMAND", garbage);
        daemon.publish("DEMO_REQUEST", garbage);
        daemon.publish("DEMO_COMMAND", damaged);
      },
      [&] {
        return daemon.events("bad_message", "another version") >= 2 &&
               daemon.events("bad_message", "damaged") >= 1;
      });

  EXPECT_TRUE(reported);
  const std::int64_t cycle = daemon.bus().cycle();
  EXPECT_TRUE(daemon.hear([&] { return daemon.bus().cycle() > cycle + 20; }));
}

TEST_F(Taktd, StopsInOrderOnSigterm) {
  DaemonProcess daemon{slow_network(folder_.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  daemon.signal(SIGTERM);

  EXPECT_EQ(daemon.wait(), 0);
  EXPECT_NE(daemon.log().find("stopped"), std::string::npos);
}

TEST_F(Taktd, EndsAfterTheTimeOfFor) {
  DaemonProcess daemon{slow_network(folder_.path()), {"--bus", "sim", "--for", "2s"}};

  EXPECT_EQ(daemon.wait(), 0);
}

TEST_F(Taktd, ExitsWith4AndNamesTheCauseWhenAMandatoryNodeIsAnother) {
  const auto network = slow_network(folder_.path(), [](std::string& text) {
    const std::string elbow = "elbow: {<<: *axis, node_id: 2}";
    text.replace(text.find(elbow), elbow.size(),
                 "elbow: {<<: *axis, node_id: 2, vendor_id: 0x1234}");
  });
  DaemonProcess daemon{network};

  EXPECT_EQ(daemon.wait(), 4);
  EXPECT_NE(daemon.log().find("vendor"), std::string::npos);
  EXPECT_NE(daemon.log().find("elbow"), std::string::npos);
}

TEST_F(Taktd, ExitsWith2OnABadNetworkFile) {
  DaemonProcess daemon{write("bad.yaml", "master: {node_id: 127}\nnodes:\n  a: {nod_id: 5}\n")};

  EXPECT_EQ(daemon.wait(), 2);
  EXPECT_NE(daemon.log().find("bad.yaml:3:"), std::string::npos);
}

TEST_F(Taktd, NamesABusAfterItsInterfaceWhereTheFileNamesNone) {
  const auto nameless = slow_network(folder_.path(), [](std::string& text) {
    const std::string name = "name: demo, ";
    text.erase(text.find(name), name.size());
  });
  const auto check = [&](const char* bus) {
    return run({TAKTD, nameless.string(), "--check", "--bus", bus}, folder_.path()).output;
  };
  EXPECT_NE(check("can0").find("bus can0: 3 nodes"), std::string::npos) << check("can0");
  EXPECT_NE(check("sim").find("bus sim: 3 nodes"), std::string::npos);

  const std::string bus = "unix:" + (folder_ / "x").string();
  DaemonProcess daemon{nameless, {"--bus", bus}};

  EXPECT_TRUE(daemon.hear([&] { return daemon.bus().status() && daemon.bus().images() > 10; }));
  EXPECT_EQ(daemon.bus().status()->bus, bus);
  EXPECT_TRUE(daemon.says("UNIX__"));
}

TEST_F(Taktd, KeepsTheNameOfTheFileOnAnotherInterface) {
  const auto network = slow_network(folder_.path());

  const Ended ended = run({TAKTD, network.string(), "--check", "--bus", "can0"}, folder_.path());

  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_NE(ended.output.find("bus demo: 3 nodes"), std::string::npos) << ended.output;
}

TEST_F(Taktd, ExitsWith3AndSaysWhatToDoWithoutItsInterface) {
  DaemonProcess daemon{slow_network(folder_.path()), {"--bus", "nocan7"}};

  EXPECT_EQ(daemon.wait(), 3);
  EXPECT_NE(daemon.log().find("nocan7"), std::string::npos);
}

}  // namespace
}  // namespace takt::test
