#include "test/boot/plant.hpp"

namespace takt {
namespace {

using namespace test;

constexpr std::array<std::uint8_t, 3> all_nodes{1, 2, 3};

Frame nmt(std::uint8_t command, std::uint8_t node) {
  return make_frame(CobId::base(0), {command, node});
}
long sent(const Plant& plant, const Frame& frame) {
  return std::ranges::count(plant.wire.frames, frame);
}
sim::Fault fault(sim::FaultKind kind, NodeId node, Time at = {}, Time until = never) {
  return {.kind = kind, .node = node, .at = at, .until = until};
}

/// A network with three valves; the first two are in the group `north`.
LoadedNetwork three(const std::string& master, const std::string& first = "",
                    const std::string& second = "") {
  const auto more = [](const std::string& text) { return text.empty() ? "" : ", " + text; };
  return network_of("bus: {name: plant}\nmaster: {sync_period: 10000" + more(master) +
                    "}\nnodes:\n  one: {node_id: 1, dcf: valve.eds, group: north" + more(first) +
                    "}\n  two: {node_id: 2, dcf: valve.eds, group: north" + more(second) +
                    "}\n  three: {node_id: 3, dcf: valve.eds}\n");
}

// 0x1F80, CiA 302-2

TEST(StartUp, StartsEachNodeWhenItHasBooted) {
  Plant plant{three("")};
  plant.run(3s);
  for (const std::uint8_t node : all_nodes) EXPECT_EQ(sent(plant, nmt(0x01, node)), 1) << node;
  EXPECT_EQ(sent(plant, nmt(0x01, 0)), 0);
}

TEST(StartUp, StartsAllNodesByOneBroadcastWhenTheyAreReady) {
  Plant plant{three("start_all_nodes: true", "mandatory: true")};
  plant.run(3s);
  EXPECT_EQ(sent(plant, nmt(0x01, 0)), 1);
  for (const std::uint8_t node : all_nodes) {
    EXPECT_EQ(sent(plant, nmt(0x01, node)), 0) << node;
    EXPECT_EQ(plant.device(node).state(), sim::DeviceState::operational);
  }
  EXPECT_EQ(plant.count(EventKind::network_ready), 1);
}

TEST(StartUp, NodeThatComesAfterTheBroadcastIsStartedByItself) {
  Plant plant{three("start_all_nodes: true", "mandatory: true"),
              {fault(sim::FaultKind::power_off, 3_node, {}, 6s)}};
  plant.run(9s);
  EXPECT_EQ(sent(plant, nmt(0x01, 0)), 1);
  EXPECT_EQ(sent(plant, nmt(0x01, 3)), 1);
  EXPECT_EQ(plant.device(3).state(), sim::DeviceState::operational);
}

TEST(StartUp, WithoutStartNodesNobodyIsStarted) {
  Plant plant{three("start_nodes: false")};
  plant.run(3s);
  for (const std::uint8_t node : all_nodes) EXPECT_EQ(sent(plant, nmt(0x01, node)), 0);
  EXPECT_EQ(plant.node(0).boot, BootState::ready);
}

TEST(StartUp, MasterIsOperationalOnlyWhenMandatoryNodesAre) {
  const Frame preoperational = make_frame(CobId::base(0x77F), {0x7F});
  const Frame operational = make_frame(CobId::base(0x77F), {0x05});
  Plant plant{three("", "mandatory: true"), {fault(sim::FaultKind::power_off, 1_node, {}, 3s)}};
  plant.run(2900ms);
  EXPECT_GT(sent(plant, preoperational), 20);
  EXPECT_EQ(sent(plant, operational), 0);
  plant.run(4s);
  EXPECT_GT(sent(plant, operational), 10);
}

TEST(StartUp, MasterThatDoesNotStartItselfWaitsForACommand) {
  const Frame operational = make_frame(CobId::base(0x77F), {0x05});
  Plant plant{three("start: false")};
  plant.run(3s);
  EXPECT_EQ(sent(plant, operational), 0);
  plant.nmt(NmtCommand::start, 127);
  plant.run(1s);
  EXPECT_GT(sent(plant, operational), 5);
  EXPECT_EQ(sent(plant, nmt(0x01, 127)), 0) << "the master does not command itself on the bus";
}

TEST(StartUp, BootTimeNamesTheMandatoryNodesOnce) {
  Plant plant{three("boot_time: 1000", "mandatory: true"),
              {fault(sim::FaultKind::power_off, 1_node)}};
  plant.run(8s);
  EXPECT_EQ(plant.count(EventKind::network_late), 1);
  EXPECT_NE(plant.text_of(EventKind::network_late)
                .find("1 mandatory nodes did not boot within the boot time of 1 s (mandatory: node "
                      "1 'one')"),
            std::string::npos)
      << plant.text_of(EventKind::network_late);
  EXPECT_EQ(plant.count(EventKind::network_ready), 0);
}

TEST(StartUp, NmtCommandsKeepTheirInhibitTime) {
  Plant plant{three("nmt_inhibit_time: 1000")};  // 100 ms
  struct Times final : sim::BusObserver {
    void on_wire(const sim::WireFrame& seen) noexcept override {
      if (seen.frame.id == CobId::base(0)) starts.push_back(seen.start);
    }
    std::vector<Time> starts;
  } times;
  plant.world.observe(&times);
  plant.run(3s);
  ASSERT_EQ(times.starts.size(), 9u) << "reset, PRE-OPERATIONAL and start of each node";
  for (std::size_t i = 1; i < times.starts.size(); ++i) {
    EXPECT_GE(times.starts[i] - times.starts[i - 1], 99ms);
  }
}

// errors of a running mandatory node

TEST(MandatoryLoss, ResetsAllWhereTheFileSaysSo) {
  Plant plant{three("reset_all_nodes: true", "mandatory: true"),
              {fault(sim::FaultKind::no_heartbeat, 1_node, 3s, 4s)}};
  plant.run(8s);
  EXPECT_EQ(sent(plant, nmt(0x81, 0)), 1);
  for (std::size_t node = 0; node < 3; ++node) EXPECT_EQ(plant.node(node).boot_count, 2u) << node;
  EXPECT_EQ(plant.count(EventKind::mandatory_lost), 1);
}

TEST(MandatoryLoss, StopsAllUntilSomebodyResetsThem) {
  Plant plant{three("stop_all_nodes: true", "mandatory: true"),
              {fault(sim::FaultKind::no_heartbeat, 1_node, 3s, 4s)}};
  plant.run(8s);
  EXPECT_EQ(sent(plant, nmt(0x02, 0)), 1);
  for (const std::uint8_t node : all_nodes) {
    EXPECT_EQ(plant.device(node).state(), sim::DeviceState::stopped) << int{node};
  }
  plant.nmt(NmtCommand::reset_node, 0);
  plant.run(4s);
  for (const std::uint8_t node : all_nodes) {
    EXPECT_EQ(plant.device(node).state(), sim::DeviceState::operational) << int{node};
  }
}

TEST(MandatoryLoss, ConcernsOnlyTheNodeItselfByDefault) {
  Plant plant{three("", "mandatory: true"), {fault(sim::FaultKind::no_heartbeat, 1_node, 3s, 4s)}};
  plant.run(8s);
  EXPECT_EQ(plant.node(0).boot_count, 2u);
  EXPECT_EQ(plant.node(1).boot_count, 1u);
}

// on_loss

TEST(LossReaction, StopNodeKeepsItAwayUntilItIsReset) {
  Plant plant{three("", "on_loss: stop_node"),
              {fault(sim::FaultKind::no_heartbeat, 1_node, 3s, 4s)}};
  plant.run(8s);
  EXPECT_EQ(plant.device(1).state(), sim::DeviceState::stopped);
  EXPECT_EQ(plant.node(0).boot_count, 1u);
  EXPECT_EQ(plant.device(2).state(), sim::DeviceState::operational);
  plant.nmt(NmtCommand::reset_communication, 1);
  plant.run(3s);
  EXPECT_EQ(plant.device(1).state(), sim::DeviceState::operational);
}

TEST(LossReaction, StopGroupStopsTheOthersOfTheGroupToo) {
  Plant plant{three("", "on_loss: stop_group"), {fault(sim::FaultKind::power_off, 1_node, 3s, 4s)}};
  plant.run(8s);
  EXPECT_EQ(plant.device(2).state(), sim::DeviceState::stopped);
  EXPECT_EQ(plant.device(3).state(), sim::DeviceState::operational);
  EXPECT_EQ(plant.count(EventKind::loss_reaction), 1);
}

TEST(LossReaction, QuickStopStopsTheDrivesOfItsGroup) {
  const auto network = network_of(
      "bus: {name: plant}\nmaster: {sync_period: 10000}\nnodes:\n"
      "  brake: {node_id: 5, dcf: valve.eds, group: north, on_loss: quick_stop}\n"
      "  lift: {node_id: 6, dcf: ../../../share/eds/takt_drive402.eds, group: north, "
      "on_timeout: {fallback: hold}}\n"
      "  other: {node_id: 7, dcf: ../../../share/eds/takt_drive402.eds, "
      "on_timeout: {fallback: hold}}\n");
  Plant plant{network, {fault(sim::FaultKind::no_heartbeat, 5_node, 6s, 8s)}};
  plant.run(4s);
  for (const std::uint8_t drive : {std::uint8_t{6}, std::uint8_t{7}}) {
    for (const std::int64_t word : {0x06, 0x07, 0x0F}) {
      plant.command(drive, 0x6040, word);
      plant.run(200ms);
    }
    EXPECT_EQ(plant.device(drive).objects().number({0x6041, 0}) & 0x6F, 0x27) << int{drive};
  }

  plant.run(4s);  // the brake is lost and comes back

  EXPECT_EQ(plant.count(EventKind::loss_reaction), 1);
  const std::int64_t status = plant.device(6).objects().number({0x6041, 0});
  EXPECT_NE(status & 0x6F, 0x27) << "quick stopped, then disabled";
  EXPECT_EQ(plant.device(7).objects().number({0x6041, 0}) & 0x6F, 0x27) << "not of the group";
}

// configuration date, store, concise DCF

TEST(ConfigurationDate, SkipsTheConfigurationThatIsThereAlready) {
  const std::string keys =
      "configuration_date: 15000, configuration_time: 1234, store_configuration: 1, "
      "sdo: [{index: 0x2000, value: 7}]";
  Plant plant{valve(keys)};
  plant.run(3s);
  EXPECT_EQ(plant.device(5).objects().number({0x1020, 1}), 15000);
  EXPECT_EQ(plant.device(5).objects().number({0x1020, 2}), 1234);

  plant.wire.frames.clear();
  plant.nmt(NmtCommand::reset_node, 5);
  plant.run(3s);
  EXPECT_EQ(plant.node().boot_count, 2u);
  EXPECT_EQ(plant.device(5).objects().number({0x2000, 0}), 7) << "stored";
  const bool wrote = std::ranges::any_of(plant.wire.frames, [](const Frame& frame) {
    return frame.id == CobId::base(0x605) && (frame.data[0] >> 5U) == 1;
  });
  EXPECT_FALSE(wrote) << "nothing is configured again";
}

TEST(ConfigurationDate, MadeFromTheContentChangesWithIt) {
  const auto date = [](const std::string& keys) {
    const LoadedNetwork network = valve("configuration_date: auto, " + keys);
    for (const BootStep& step : network.plan.nodes[0].boot_plan.steps) {
      if (step.object == ObjectKey{0x1020, 2}) return step.value;
    }
    return std::vector<std::byte>{};
  };
  EXPECT_FALSE(date("sdo: [{index: 0x2000, value: 7}]").empty());
  EXPECT_EQ(date("sdo: [{index: 0x2000, value: 7}]"), date("sdo: [{index: 0x2000, value: 7}]"));
  EXPECT_NE(date("sdo: [{index: 0x2000, value: 7}]"), date("sdo: [{index: 0x2000, value: 8}]"));
}

TEST(Store, WritesNothingToTheFlashWhereNothingChanged) {
  const std::string keys = "store_configuration: 1, sdo: [{index: 0x2000, value: 7}]";
  Plant plant{valve(keys)};
  plant.run(3s);
  const Frame save = make_frame(CobId::base(0x605), {0x23, 0x10, 0x10, 0x01, 's', 'a', 'v', 'e'});
  EXPECT_EQ(sent(plant, save), 1);
  plant.nmt(NmtCommand::reset_node, 5);
  plant.run(3s);
  EXPECT_EQ(plant.node().boot_count, 2u);
  EXPECT_EQ(sent(plant, save), 1) << "the second boot finds everything as it should be";
}

TEST(ConciseDcf, IsWrittenInItsOrder) {
  Plant plant{valve("configuration_file: valve.cdcf")};
  plant.run(3s);
  EXPECT_EQ(plant.device(5).objects().number({0x2000, 0}), 500);
  EXPECT_EQ(plant.device(5).objects().number({0x2001, 0}), 600);
  EXPECT_EQ(plant.node().boot, BootState::ready);
}

// program download, 0x1F50 .. 0x1F57

TEST(Program, IsLoadedWhereTheVersionDiffersAndReportsItsProgress) {
  Plant plant{valve("software_version: 0x00010001, software_file: program.bin")};
  plant.run(15s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
  EXPECT_EQ(plant.device(5).objects().number({0x1F56, 1}), 0x0001'0001);
  EXPECT_EQ(plant.device(5).objects().find({0x1F50, 1})->bytes.size(), 1000u);
  EXPECT_EQ(plant.count(EventKind::program_progress), 2);  // one event for each block of 889 bytes
  EXPECT_NE(plant.text_of(EventKind::program_progress).find(" of 1000 bytes"), std::string::npos);
}

TEST(Program, ReportsItsProgressByTenthsWhereItGoesBySegments) {
  Plant plant{valve("software_version: 0x00010001, software_file: program.bin, sdo_block: never")};
  plant.run(15s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
  EXPECT_GE(plant.count(EventKind::program_progress), 5);
}

TEST(Program, IsNotTouchedWhereTheVersionIsRight) {
  Plant plant{valve("software_version: 0x00010000, software_file: program.bin")};
  plant.run(3s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
  EXPECT_EQ(plant.count(EventKind::program_progress), 0);
}

// identity of the devices

TEST(Stranger, IsReportedOnce) {
  LoadedNetwork network = valve();
  network.devices.push_back(network.devices[0]);
  network.devices.back().node = 9_node;
  Plant plant{std::move(network)};
  plant.run(3s);
  EXPECT_EQ(plant.count(EventKind::unlisted_node), 1);
  EXPECT_NE(plant.text_of(EventKind::unlisted_node)
                .find("node 9 is on the bus but not in the network file (status A of CiA 302-2"),
            std::string::npos);
}

TEST(Replacement, OfADeviceByAnotherOfTheSameKindIsReported) {
  sim::Fault other = fault(sim::FaultKind::override_value, 5_node, 2410ms);
  other.object = ObjectKey{0x1018, 4};
  other.value = {std::byte{78}};
  Plant plant{valve(), {fault(sim::FaultKind::power_off, 5_node, 2s, 2400ms), other}};
  plant.run(6s);
  EXPECT_EQ(plant.node().boot_count, 2u);
  EXPECT_NE(plant.text_of(EventKind::node_replaced).find("its serial number is 78, it was 77"),
            std::string::npos);
}

TEST(Replacement, ByADeviceOfAnotherKindIsRefused) {
  sim::Fault other = fault(sim::FaultKind::override_value, 5_node, 2410ms);
  other.object = ObjectKey{0x1018, 2};
  other.value = {std::byte{9}, std::byte{9}, std::byte{0}, std::byte{0}};
  Plant plant{valve(), {fault(sim::FaultKind::power_off, 5_node, 2s, 2400ms), other}};
  plant.run(6s);
  EXPECT_EQ(plant.node().boot_letter, 'M');
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::preoperational);
}

TEST(BootUpStorm, IsBounded) {
  sim::Fault storm = fault(sim::FaultKind::bootup_storm, 5_node, 2s, 20s);
  storm.time = 400ms;
  Plant plant{valve(), {storm}};
  plant.run(20s);
  EXPECT_LT(plant.count(EventKind::boot_started), 25);
  plant.run(20s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
}

TEST(Emcy, IsHeardOnAnIdentifierOfItsOwn) {
  sim::Fault error = fault(sim::FaultKind::device_error, 5_node, 2s);
  error.emcy_code = 0x4210;
  Plant plant{valve("emcy_cob_id: 0x0C5, emcy_inhibit_time: 10"), {error}};
  plant.run(3s);
  EXPECT_EQ(plant.frames(0x0C5), 1);
  EXPECT_EQ(plant.device(5).objects().number({0x1015, 0}), 10);
  EXPECT_NE(plant.text_of(EventKind::emcy).find("0x4210: device temperature too high"),
            std::string::npos);
}

}  // namespace
}  // namespace takt
