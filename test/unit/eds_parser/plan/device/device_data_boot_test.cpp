#include <algorithm>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using test::compile_device_file;
using test::read_entry;

TEST(DeviceDataBoot, TweaksTheBoot) {
  Findings findings;
  const auto entry = read_entry(
      "name: Slow\nmatch: {vendor_id: 0xABCD}\n"
      "boot: {reset: node, values_after_pdos: true, pause_after_bootup_ms: 300, "
      "pause_before_start_ms: 20}\n",
      findings);
  ASSERT_TRUE(entry);
  const auto net =
      compile_device_file("pump: {node_id: 4, dcf: x, sdo: [{index: 0x100D, value: 3}]}\n",
                          "astraada_drv28.eds", std::span{&*entry, 1});

  const auto& steps = net.plan.nodes.at(0).boot_plan.steps;
  EXPECT_EQ(steps.at(0).command, NmtCommand::reset_node);
  EXPECT_EQ(steps.at(2).action, BootAction::pause);
  EXPECT_EQ(steps.at(2).timeout, std::chrono::milliseconds{300});
  const auto position = [&](auto wanted) { return std::ranges::find_if(steps, wanted); };
  const auto value = position([](const BootStep& s) { return s.object.index == 0x100D; });
  const auto pdo = position([](const BootStep& s) { return s.object.index == 0x1803; });
  const auto start = position([](const BootStep& s) {
    return s.action == BootAction::nmt && s.command == NmtCommand::start;
  });
  EXPECT_LT(pdo, value);
  ASSERT_NE(start, steps.end());
  EXPECT_EQ((start - 1)->timeout, std::chrono::milliseconds{20});
}

TEST(DeviceDataBoot, WarnsOfAResetOfTheWholeElmoDrive) {
  const std::string node = "arm: {node_id: 4, dcf: x, vendor_id: 0x9A, reset: ";
  const auto whole = compile_device_file(node + "node}\n", "takt_drive402.eds");
  const auto only_communication =
      compile_device_file(node + "communication}\n", "takt_drive402.eds");

  EXPECT_EQ(whole.plan.nodes.at(0).device_data, "Elmo drives");
  EXPECT_NE(whole.declared("device-data").find("pulls the CAN lines down"), std::string::npos);
  EXPECT_EQ(whole.plan.nodes.at(0).boot_plan.steps.at(0).command, NmtCommand::reset_node);
  EXPECT_EQ(only_communication.declared("device-data"), "");
}

TEST(DeviceDataBoot, WarnsOfAResetThatASchunkModuleDoesNotTake) {
  const std::string node = "arm: {node_id: 4, dcf: x, device: schunk, reset: ";
  const auto communication = compile_device_file(node + "communication}\n", "takt_drive402.eds");
  EXPECT_NE(communication.declared("device-data").find("whole application"), std::string::npos);
  EXPECT_EQ(compile_device_file(node + "node}\n", "takt_drive402.eds").declared("device-data"), "");
}

}  // namespace
}  // namespace takt
