#include <algorithm>
#include <chrono>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>
#include <string>
#include <takt/drive402.hpp>
#include <takt/master.hpp>
#include <utility>
#include <vector>

namespace takt {
namespace {

using namespace std::chrono_literals;

const std::string demo = TAKT_SOURCE_DIR "/share/demo/one_axis.yaml";

Master started(const std::string& file = demo) {
  auto master = Master::start(NetworkFile::load(file), {.bus = "virtual"});
  if (!master) throw std::runtime_error{master.error()};
  return std::move(*master);
}

void boot(Master& master) {
  for (int cycle = 0; cycle < 2000 && !master.all_ready(); ++cycle) ASSERT_TRUE(master.wait(1s));
  ASSERT_TRUE(master.all_ready());
}

/// Commands the only axis to Operation enabled, at its present position.
void enable(Master& master) {
  const NetworkFile& network = master.network();
  DriveSequence drive;
  drive.set_goal(DriveGoal::enabled);
  for (int cycle = 0; cycle < 2000 && !drive.enabled(); ++cycle) {
    ASSERT_TRUE(master.wait(1s));
    const auto statusword = master.raw(*network.find_input("axis", 0x6041));
    const auto word = drive.step(static_cast<std::uint16_t>(statusword));
    EXPECT_TRUE(master.set_raw(*network.find_output("axis", 0x6040), word));
    EXPECT_TRUE(master.set_raw(*network.find_output("axis", 0x6060), 8));
    EXPECT_TRUE(master.set(*network.find_output("axis", 0x607A),
                           master.value(*network.find_input("axis", 0x6064))));
    master.send();
  }
  ASSERT_TRUE(drive.enabled());
}

ServiceReply reply_of(Master& master) {
  for (int cycle = 0; cycle < 1000; ++cycle) {
    if (auto reply = master.take_reply()) return *reply;
    if (!master.wait(1s)) break;
  }
  return {.text = "no reply"};
}

TEST(PublicMaster, BootsTheSimulatedDevicesInVirtualTime) {
  Master master = started();

  boot(master);

  const NodeState axis = master.node(1);
  EXPECT_EQ(axis.nmt, "OPERATIONAL");
  EXPECT_EQ(axis.boot, "ready");
  EXPECT_EQ(master.node(2).nmt, "unknown");
  std::vector<std::string> kinds;
  while (const auto event = master.take_event()) kinds.push_back(event->kind);
  EXPECT_EQ(std::ranges::count(kinds, "boot_done"), 1);
}

TEST(PublicMaster, RunsEqualInEachVirtualRun) {
  const auto run = [] {
    Master master = started();
    std::string text;
    for (int cycle = 0; cycle < 300; ++cycle) master.wait(1s);
    while (const auto event = master.take_event()) {
      text += std::to_string(event->time.count()) + " " + event->text + "\n";
    }
    return text + std::to_string(master.now().count());
  };

  EXPECT_EQ(run(), run());
}

TEST(PublicMaster, SendsTheSetPointOfImageKBeforeSyncKPlus1) {
  Master master = started();
  boot(master);
  enable(master);
  const auto target = *master.network().find_output("axis", 0x607A);
  const double before = master.value(target);

  ASSERT_TRUE(master.wait(1s));
  const auto image = master.cycle();
  EXPECT_TRUE(master.set(target, before + 0.01));
  master.send();
  ASSERT_TRUE(master.wait(1s));

  EXPECT_EQ(master.cycle(), image + 1);
  EXPECT_NEAR(master.value(target), before + 0.01, 1e-3);  // a count is 0.00063 rad
}

TEST(PublicMaster, StopsAnEnabledAxisInOrder) {
  Master master = started();
  boot(master);
  enable(master);

  EXPECT_TRUE(master.stop());

  EXPECT_FALSE(master.wait(1s));
  EXPECT_TRUE(master.stop()) << "a second stop has the same result";
  std::vector<std::string> kinds;
  while (const auto event = master.take_event()) kinds.push_back(event->kind);
  EXPECT_EQ(std::ranges::count(kinds, "stopped"), 1);
  EXPECT_EQ(std::ranges::count(kinds, "axis_not_stopped"), 0);
}

TEST(PublicMaster, AnswersRequests) {
  Master master = started();
  boot(master);

  const auto type = master.read({.node = 1, .index = 0x1000});
  const ServiceReply value = reply_of(master);
  EXPECT_EQ(value.request, type);
  EXPECT_TRUE(value.good) << value.text;
  const std::vector<std::byte> device_type{std::byte{0x92}, std::byte{0x01}, std::byte{0x02},
                                           std::byte{0x00}};  // CiA 402, a drive
  EXPECT_EQ(value.data, device_type);

  master.read({.node = 1, .index = 0x5FFF});
  const ServiceReply missing = reply_of(master);
  EXPECT_FALSE(missing.good);
  EXPECT_EQ(missing.abort_code, 0x0602'0000U);
  EXPECT_NE(missing.text.find("object"), std::string::npos) << missing.text;

  const std::vector<std::byte> heartbeat{std::byte{0x64}, std::byte{0x00}};
  master.write({.node = 1, .index = 0x1017}, heartbeat);
  EXPECT_TRUE(reply_of(master).good);
  EXPECT_FALSE(master.write({.node = 1, .index = 0x1017}, std::vector<std::byte>(1025)));

  master.nmt(NmtService::enter_preoperational, 1);
  EXPECT_TRUE(reply_of(master).good);
}

TEST(PublicMaster, RefusesOutputsThatDoNotExistOrDoNotFit) {
  Master master = started();
  const NetworkFile& network = master.network();
  const auto controlword = *network.find_output("axis", 0x6040);

  EXPECT_FALSE(master.set_raw(*network.find_input("axis", 0x6041), 1));
  EXPECT_FALSE(master.set_raw(network.signals().size(), 1));
  EXPECT_FALSE(master.set_raw(controlword, 0x1'0000));
  EXPECT_FALSE(master.set(controlword, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_TRUE(master.set_raw(controlword, 0xFFFF));
}

TEST(PublicMaster, SaysWhyItDoesNotStart) {
  const auto no_file = Master::start(NetworkFile::load("/nowhere.yaml"), {.bus = "virtual"});
  ASSERT_FALSE(no_file);
  EXPECT_NE(no_file.error().find("/nowhere.yaml"), std::string::npos) << no_file.error();

  const auto no_bus = Master::start(NetworkFile::load(demo));
  ASSERT_FALSE(no_bus);
  EXPECT_NE(no_bus.error().find("MasterOptions::bus"), std::string::npos) << no_bus.error();

  const auto no_interface = Master::start(NetworkFile::load(demo), {.bus = "no_such_can"});
  ASSERT_FALSE(no_interface);
  EXPECT_NE(no_interface.error().find("no_such_can"), std::string::npos) << no_interface.error();
}

TEST(PublicMaster, MovesWithItsBus) {
  Master first = started();
  boot(first);

  Master second = std::move(first);

  EXPECT_TRUE(second.wait(1s));
  second = started();  // the first bus is stopped in order
  EXPECT_FALSE(second.all_ready());
  EXPECT_TRUE(second.wait(1s));
}

TEST(PublicMaster, RunsASimulatedBusInRealTime) {
  auto master = Master::start(NetworkFile::load(demo), {.bus = "sim"});
  ASSERT_TRUE(master) << master.error();

  while (!master->all_ready() && master->wait(60s)) {
  }

  EXPECT_TRUE(master->all_ready());
  EXPECT_FALSE(master->realtime().empty());
  EXPECT_TRUE(master->stop());
}

}  // namespace
}  // namespace takt
