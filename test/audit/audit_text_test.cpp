#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/takt/audit/ask_devices.hpp"
#include "apps/takt/audit/audit_report.hpp"
#include "test/audit/audited.hpp"

namespace takt {
namespace {

using namespace test;

std::string text_of(const Audit& audit) {
  std::ostringstream out;
  print_audit(out, audit, Colour::none);
  return out.str();
}

TEST(Audit, ReportsAMachineBuilderWhatEachDeviceDoes) {
  const auto network = two_nodes({"heartbeat_consumer: false"}, {});

  EXPECT_EQ(
      text_of(audit_of(network)),
      "bus 'lift' without its master (node 127, heartbeat every 100 ms): 1 safe "
      "without the master, 1 that keep their last set-points\n"
      "values after the boot, by EDS and network file\n"
      "\n"
      "node 5 axis (drive): KEEPS ITS LAST SET-POINTS: it does not notice the loss of the "
      "master\n"
      "  master dies  never noticed: the device watches neither heartbeat nor guarding of the "
      "master\n"
      "    drive      KEEPS its last set-points without a time limit\n"
      "  cable cut    the same: the device receives nothing from the master\n"
      "  bus-off      goes to PRE-OPERATIONAL (1029:01 = 0); fault (6007 = 1), along the "
      "quick-stop ramp (605E = 2)\n"
      "  note         the device expects SYNC every 10000 us (1006); for the effect of a missing "
      "SYNC see the manual\n"
      "  remedy       in the network file:\n"
      "    axis:\n"
      "      heartbeat_consumer: true   # 1016: the device watches the master\n"
      "\n"
      "node 6 io: its outputs go to their error values, at the latest 300 ms later\n"
      "  master dies  noticed after 300 ms: no heartbeat of the master arrives (1016:01)\n"
      "    then       goes to PRE-OPERATIONAL (1029:01 = 0)\n"
      "    outputs    6200:01..02 goes to 0x00 (6206 = 0xFF); 6411:01..02 goes to 0 (6443 = "
      "1)\n"
      "  cable cut    the same: the device receives nothing from the master\n"
      "  bus-off      the same reaction, at once\n");
}

TEST(Audit, IsOneJsonDocument) {
  std::ostringstream out;
  print_audit_json(out, audit_of(two_nodes({"heartbeat_consumer: false"}, {})));

  const auto json = nlohmann::json::parse(out.str());

  EXPECT_EQ(json["bus"], "lift");
  EXPECT_EQ(json["goes_on"], true);
  EXPECT_EQ(json["nodes"][0]["verdict"], "goes_on");
  EXPECT_EQ(json["nodes"][0]["notices_after_ms"], nullptr);
  EXPECT_EQ(json["nodes"][1]["verdict"], "stops");
  EXPECT_EQ(json["nodes"][1]["notices_after_ms"], 300);
  EXPECT_EQ(json["nodes"][1]["error_state"], "pre-operational");
}

TEST(Audit, SaysWhereAMasterWithoutHeartbeatCanNotBeWatched) {
  const auto network = two_nodes({}, {}, "heartbeat_producer: 0");

  const Audit audit = audit_of(network);

  EXPECT_EQ(audit.nodes[0].verdict, Failsafe::goes_on);
  EXPECT_EQ(audit.nodes[0].master_remedy, "master: {heartbeat_producer: 100}   # ms");
}

TEST(Audit, AdvisesNothingThatIsTheDefaultAlready) {
  const auto network = two_nodes({}, {}, "heartbeat_producer: 0");

  const NodeAudit drive = audit_of(network).nodes[0];

  EXPECT_EQ(drive.remedy, std::vector<std::string>{}) << "the device watches the master by default";
  for (const std::string& besides : drive.besides) {
    EXPECT_EQ(besides.find("can watch neither"), std::string::npos) << besides;
  }
}

TEST(Audit, NamesWhatWorksWhereTheHeartbeatConsumerHoldsNoNodeId) {
  auto network = two_nodes({"heartbeat_consumer: false"}, {});
  for (DeviceObject& object : network.devices[0].objects) {
    if (object.key.index == 0x1016 && object.key.sub != 0) object.high_limit = 0xFFFF;
  }

  const NodeAudit drive = audit_of(network).nodes[0];

  for (const std::string& line : drive.remedy) {
    EXPECT_EQ(line.find("heartbeat_consumer"), std::string::npos) << line;
  }
  const bool reported = std::ranges::any_of(drive.besides, [](const std::string& text) {
    return text.find("exclude a value with the master's node id and a time") != std::string::npos;
  });
  EXPECT_TRUE(reported);
  const bool guards = std::ranges::any_of(drive.remedy, [](const std::string& line) {
    return line.find("life_time_factor: 3") != std::string::npos;
  });
  const bool none = std::ranges::any_of(drive.besides, [](const std::string& text) {
    return text.find("can watch neither") != std::string::npos;
  });
  EXPECT_NE(guards, none) << "life guarding where the device has it, else nothing";
}

/// The boot chooses 1016:01, and warns that it can't be written.
TEST(Audit, NamesAnotherEntryWhereOnlyTheFirstOneHoldsNoNodeId) {
  auto network = two_nodes({}, {});
  DeviceTable& device = network.devices[0];
  for (DeviceObject& object : device.objects) {
    if (object.key == ObjectKey{0x1016, 1}) object.high_limit = 0xFFFF;
  }
  std::erase_if(network.plan.nodes[0].boot_plan.steps,
                [](const BootStep& step) { return step.object == ObjectKey{0x1016, 1}; });

  const NodeAudit drive = audit_of(network).nodes[0];

  EXPECT_EQ(drive.remedy,
            std::vector<std::string>{"sdo: [{index: 0x1016, sub_index: 2, value: 0x7F012C}]   # "
                                     "watches the master"});
  EXPECT_NE(text_of(audit_of(network)).find("entry 1016:01 can't be written, or its limits"),
            std::string::npos);
}

TEST(Audit, NamesAnEntryThatWorks) {
  const auto network = two_nodes({"sdo: [{index: 0x1016, sub_index: 2, value: 0x7F012C}]"}, {});

  EXPECT_EQ(network.findings.size(), two_nodes({}, {}).findings.size());
  EXPECT_NE(text_of(audit_of(network)).find("no heartbeat of the master arrives (1016:02)"),
            std::string::npos);
}

TEST(Audit, NamesEachOutputThatStays) {
  const auto network = two_nodes({}, {"sdo: [{index: 0x6206, sub_index: 2, value: 0x0F}, {index: "
                                      "0x6443, sub_index: 1, value: 0}]"});

  const NodeAudit io = audit_of(network).nodes[1];

  EXPECT_EQ(io.verdict, Failsafe::goes_on);
  EXPECT_EQ(io.outputs,
            "6200:01 goes to 0x00 (6206 = 0xFF); 6200:02 STAYS except for bits 0x0F, which go to "
            "0x00 (6206 = 0x0F); 6411:01 STAYS (6443 = 0); 6411:02 goes to 0 (6443 = 1)");
  ASSERT_EQ(io.remedy.size(), 1u);
  EXPECT_EQ(
      io.remedy[0],
      "sdo: [{index: 0x6206, sub_index: 2, value: 0xFF}, {index: 0x6443, sub_index: 1, value: "
      "1}]   # in addition to the present entries");
}

/// Returns the keys of a node after its remedy: each line of the remedy replaces the lines of the
/// same key.
std::vector<std::string> with_remedy(std::vector<std::string> keys, const NodeAudit& node) {
  for (const std::string& line : node.remedy) {
    const std::string key = line.substr(0, line.find(':'));
    std::erase_if(keys, [&](const std::string& own) { return own.starts_with(key + ":"); });
    keys.push_back(line);
  }
  return keys;
}

TEST(Audit, GivesRemediesThatTheNetworkFileTakesAndThatHelp) {
  const std::vector<std::vector<std::string>> axes{{"heartbeat_consumer: false"},
                                                   {"sdo: [{index: 0x6007, value: 0}]"}};
  for (const auto& axis : axes) {
    const NodeAudit before = audit_of(two_nodes(axis, {})).nodes[0];
    const NodeAudit after = audit_of(two_nodes(with_remedy(axis, before), {})).nodes[0];
    EXPECT_EQ(before.verdict, Failsafe::goes_on) << axis[0];
    EXPECT_EQ(after.verdict, Failsafe::stops) << axis[0];
  }
  const std::vector<std::vector<std::string>> modules{
      {"heartbeat_consumer: false"},
      {"error_behavior: {1: 1}"},
      {"sdo: [{index: 0x6206, sub_index: 1, value: 0}]"}};
  for (const auto& io : modules) {
    const NodeAudit before = audit_of(two_nodes({}, io)).nodes[1];
    const NodeAudit after = audit_of(two_nodes({}, with_remedy(io, before))).nodes[1];
    EXPECT_NE(before.verdict, Failsafe::stops) << io[0];
    EXPECT_EQ(after.verdict, Failsafe::stops) << io[0];
  }
}

std::vector<std::byte> bytes(std::initializer_list<int> numbers) {
  std::vector<std::byte> out;
  for (const int number : numbers) out.push_back(static_cast<std::byte>(number));
  return out;
}

TEST(AskDevices, BelievesTheDeviceAndReportsWhereItDiffers) {
  const auto network = two_nodes({}, {});
  DeviceValues values{network.plan.nodes[0], network.devices[0]};
  const auto read = [&](NodeId,
                        ObjectKey key) -> std::expected<std::vector<std::byte>, UnreadObject> {
    if (key == ObjectKey{0x1016, 1}) return bytes({0, 0, 0, 0});
    if (key == ObjectKey{0x605E, 0}) return std::unexpected{UnreadObject{0x0602'0000, "none"}};
    if (key == ObjectKey{0x6007, 0}) return std::unexpected{UnreadObject{0x0800'0022, "not now"}};
    std::vector<std::byte> same;
    for (unsigned i = 0; i < 8; ++i)
      same.push_back(std::byte(values.get(key).value_or(0) >> 8 * i));
    return same;
  };

  ASSERT_TRUE(ask_device(5_node, values, read));

  EXPECT_EQ(values.get({0x1016, 1}), 0u);
  EXPECT_EQ(values.get({0x605E, 0}), std::nullopt);
  EXPECT_EQ(values.get({0x6007, 0}), 1u) << "as its EDS says";
  EXPECT_EQ(values.notes(),
            (std::vector<std::string>{
                "1016:01 is 0x00 in the device, but 0x7F012C by network file and EDS",
                "6007:00 can't be read (not now): the value is that of EDS and network file",
                "605E:00 is in the EDS, but the device does not have this object"}));
}

TEST(AskDevices, SaysWhatADeviceThatDoesNotAnswerIsJudgedBy) {
  const auto network = two_nodes({}, {});
  DeviceValues values{network.plan.nodes[0], network.devices[0]};
  int asked = 0;
  const auto silent = [&](NodeId,
                          ObjectKey) -> std::expected<std::vector<std::byte>, UnreadObject> {
    ++asked;
    return std::unexpected{UnreadObject{0x0504'0000, "no answer in time"}};
  };

  EXPECT_FALSE(ask_device(5_node, values, silent));

  EXPECT_EQ(asked, 1) << "once, not for every object";
  EXPECT_EQ(values.get({0x1016, 1}), 0x007F'012Cu);
  ASSERT_EQ(values.notes().size(), 1u);
}

}  // namespace
}  // namespace takt
