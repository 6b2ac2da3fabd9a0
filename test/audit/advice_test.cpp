#include <algorithm>
#include <gtest/gtest.h>

#include "test/audit/audited.hpp"

// The audit advises only what the device accepts and what is not in the network file already.

namespace takt {
namespace {

using namespace test;

using Lines = std::vector<std::string>;

DeviceObject& object_of(LoadedNetwork& network, std::size_t node, ObjectKey key) {
  return *std::ranges::find(network.devices[node].objects, key, &DeviceObject::key);
}

bool mentions(const NodeAudit& node, const std::string& text) {
  return std::ranges::any_of(
      node.besides, [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

/// A drive whose 0x6007 has the value 0, which means that nothing happens.
LoadedNetwork drive_without_reaction() {
  auto network = two_nodes({}, {});
  object_of(network, 0, {0x6007, 0}).value = {std::byte{0}, std::byte{0}};
  return network;
}

TEST(AuditAdvice, NamesNoAbortConnectionOptionThatTheDriveCanNotBeGiven) {
  auto network = drive_without_reaction();
  object_of(network, 0, {0x6007, 0}).access = Access::ro;

  const NodeAudit drive = audit_of(network).nodes[0];

  EXPECT_EQ(drive.verdict, Failsafe::goes_on);
  EXPECT_EQ(drive.remedy, Lines{});
  EXPECT_TRUE(mentions(drive, "6007:00"));
  EXPECT_TRUE(mentions(drive, "only its power, or a hardware enable, stops the device"));
}

TEST(AuditAdvice, ChoosesAnAbortConnectionOptionWithinTheLimitsOfTheDrive) {
  const auto advice = [](std::int64_t highest) {
    auto network = drive_without_reaction();
    object_of(network, 0, {0x6007, 0}).low_limit = 0;
    object_of(network, 0, {0x6007, 0}).high_limit = highest;
    return audit_of(network).nodes[0].remedy;
  };

  EXPECT_EQ(advice(3),
            Lines{"sdo: [{index: 0x6007, value: 3}]   # in addition to the present entries"});
  EXPECT_EQ(advice(2),
            Lines{"sdo: [{index: 0x6007, value: 1}]   # in addition to the present entries"});
  EXPECT_EQ(advice(0), Lines{});
}

TEST(AuditAdvice, NamesNoErrorModeThatAnOutputCanNotBeGiven) {
  auto network = two_nodes({}, {});
  DeviceObject& mode = object_of(network, 1, {0x6206, 1});
  mode.access = Access::ro;
  mode.value = {std::byte{0}};

  const NodeAudit io = audit_of(network).nodes[1];

  EXPECT_EQ(io.verdict, Failsafe::goes_on);
  EXPECT_EQ(io.remedy, Lines{});
  EXPECT_TRUE(mentions(io, "the EDS does not let 6206:01 be changed"));
}

TEST(AuditAdvice, NamesNoErrorBehaviourThatTheDeviceCanNotBeGiven) {
  auto network = two_nodes({}, {"error_behavior: {1: 1}"});
  object_of(network, 1, {0x1029, 1}).access = Access::ro;

  const NodeAudit io = audit_of(network).nodes[1];

  EXPECT_EQ(io.remedy, Lines{});
  EXPECT_TRUE(mentions(io, "1029:01"));
}

TEST(AuditAdvice, LetsTaktConfigureANodeThatIsOnlyWatchedBeforeItGivesItValues) {
  auto network = two_nodes({"boot: false"}, {});
  object_of(network, 0, {0x6007, 0}).value = {std::byte{0}, std::byte{0}};
  object_of(network, 0, {0x1016, 1}).value = {std::byte{0x2C}, std::byte{0x01}, std::byte{0x7F},
                                              std::byte{0}};

  EXPECT_EQ(audit_of(network).nodes[0].remedy,
            (Lines{"boot: true   # takt configures the device",
                   "sdo: [{index: 0x6007, value: 3}]   # in addition to the present entries"}));
}

/// Bus terminals that know guarding, here without a heartbeat consumer.
NodeAudit guarded_terminals(const std::string& keys) {
  auto network = network_of(
      "bus: {name: hall, interface: can0}\n"
      "master: {heartbeat_producer: 100}\nnodes:\n  terminals: {node_id: 11, "
      "dcf: " +
      eds("beckhoff_io") +
      ", sim: {model: beckhoff}, on_timeout: {fallback: hold, after_cycles: "
      "60000}, rpdo: {1: {transmission: 255}}, heartbeat_consumer: false, "
      "heartbeat_producer: 0" +
      keys + "}\n");
  for (DeviceTable& device : network.devices) {
    std::erase_if(device.objects,
                  [](const DeviceObject& object) { return object.key.index == 0x1016; });
  }
  return audit_of(network).nodes.at(0);
}

TEST(AuditAdvice, SwitchesGuardingOnWhereOnlyTheRetryFactorKeepsItOff) {
  const Lines retry{
      "retry_factor: 3   # with 0 the master does not guard; in addition to life_time_factor"};
  const std::string complete = ", guard_time: 100, life_time_factor: 3";

  EXPECT_EQ(guarded_terminals(complete).remedy, Lines{});
  EXPECT_EQ(guarded_terminals(complete + ", retry_factor: 0").remedy, retry);
}

TEST(AuditAdvice, CompletesGuardingOfWhichOnlyTheLifeTimeFactorIsMissing) {
  EXPECT_EQ(guarded_terminals(", guard_time: 100").remedy,
            Lines{"life_time_factor: 3   # life guarding notices a dead master"});
}

TEST(AuditAdvice, RemovesTheEntryThatSwitchesTheHeartbeatConsumerOff) {
  const std::string off = "sdo: [{index: 0x1016, sub_index: 1, value: 0}]";

  const NodeAudit by_default = audit_of(two_nodes({off}, {})).nodes[0];
  const NodeAudit unwanted = audit_of(two_nodes({off, "heartbeat_consumer: false"}, {})).nodes[0];

  EXPECT_EQ(by_default.verdict, Failsafe::goes_on);
  EXPECT_EQ(by_default.remedy, Lines{});
  EXPECT_TRUE(mentions(by_default, "`sdo` in the network file sets 1016:01"));
  EXPECT_FALSE(mentions(by_default, "can watch neither"));
  EXPECT_EQ(unwanted.remedy,
            Lines{"heartbeat_consumer: true   # 1016: the device watches the master"});
  EXPECT_TRUE(mentions(unwanted, "`sdo` in the network file sets 1016:01"));
}

// With either line alone, the device still does not monitor the master.
TEST(AuditAdvice, NamesBothLinesWhereTheMasterIsSilentAndTheConsumerIsSwitchedOff) {
  const Audit audit =
      audit_of(two_nodes({"heartbeat_consumer: false"}, {}, "heartbeat_producer: 0"));
  const auto applied = two_nodes({"heartbeat_consumer: true"}, {}, "heartbeat_producer: 100");

  EXPECT_EQ(audit.nodes[0].master_remedy, "master: {heartbeat_producer: 100}   # ms");
  EXPECT_EQ(audit.nodes[0].remedy,
            Lines{"heartbeat_consumer: true   # 1016: the device watches the master"});
  EXPECT_EQ(audit.nodes[1].remedy, Lines{});
  EXPECT_EQ(audit_of(applied).nodes[0].verdict, Failsafe::stops);
}

TEST(AuditAdvice, FreesAnEntryThatTheNetworkFileGivesToAnotherNode) {
  const std::string second = "{index: 0x1016, sub_index: 2, value: 0x07012C}]";
  const std::string both = "sdo: [{index: 0x1016, sub_index: 1, value: 0x06012C}, " + second;

  const NodeAudit drive = audit_of(two_nodes({both}, {})).nodes[0];
  const NodeAudit unwanted = audit_of(two_nodes({both, "heartbeat_consumer: false"}, {})).nodes[0];
  const NodeAudit freed = audit_of(two_nodes({"sdo: [" + second}, {})).nodes[0];

  EXPECT_EQ(drive.verdict, Failsafe::goes_on);
  EXPECT_EQ(drive.remedy, Lines{});
  EXPECT_TRUE(mentions(drive, "`sdo` in the network file sets 1016:01: remove it there"));
  EXPECT_FALSE(mentions(drive, "only its power, or a hardware enable, stops"));
  EXPECT_EQ(unwanted.remedy,
            Lines{"heartbeat_consumer: true   # 1016: the device watches the master"});
  EXPECT_EQ(freed.verdict, Failsafe::stops);
}

/// The boot chooses 1016:01, and warns that it can't be written.
Lines advice_of_second_entry(const std::string& master, const std::string& key) {
  auto network = two_nodes({key}, {}, master);
  object_of(network, 0, {0x1016, 1}).high_limit = 0xFFFF;
  std::erase_if(network.plan.nodes[0].boot_plan.steps,
                [](const BootStep& step) { return step.object == ObjectKey{0x1016, 1}; });
  return audit_of(network).nodes[0].remedy;
}

TEST(AuditAdvice, KeepsTheTimeOfAHeartbeatConsumerOutOfItsNodeId) {
  EXPECT_EQ(advice_of_second_entry("node_id: 126, heartbeat_producer: 30000", "mandatory: true"),
            Lines{"sdo: [{index: 0x1016, sub_index: 2, value: 0x7EFFFF}]   # watches the "
                  "master"});
}

TEST(AuditAdvice, CountsTheHeartbeatMultiplierOfTheNode) {
  EXPECT_EQ(advice_of_second_entry("heartbeat_producer: 100", "heartbeat_multiplier: 5"),
            Lines{"sdo: [{index: 0x1016, sub_index: 2, value: 0x7F01F4}]   # watches the "
                  "master"});
}

}  // namespace
}  // namespace takt
