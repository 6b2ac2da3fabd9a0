#include <gtest/gtest.h>

#include "master/sim/dictionary/object_store.hpp"
#include "test/audit/audited.hpp"

// The master is killed, and the simulated devices do what the audit said.

namespace takt {
namespace {

using namespace test;
using sim::DeviceState;

constexpr Time heartbeat = 100ms;  // period of the master: its last heartbeat is at most this old

class Machine {
 public:
  explicit Machine(const LoadedNetwork& network) : reported_{audit_of(network)}, plant_{network} {}

  void run_with_outputs() {
    plant_.run(2s);
    plant_.command(6, 0x6200, 0xFF);
    plant_.command(6, 0x6411, 1000);
    plant_.command(5, 0x6060, 3);  // profile velocity
    plant_.command(5, 0x60FF, 5000);
    for (const std::int64_t controlword : {6, 7, 15}) {
      plant_.command(5, 0x6040, controlword);
      plant_.run(300ms);
    }
    ASSERT_TRUE(drive_runs());
    ASSERT_EQ(number(6, {0x6200, 1}), 0xFF);
    ASSERT_EQ(number(6, {0x6411, 1}), 1000);
  }
  void master_is_dead_for(Time span) { plant_.run_without_master(span); }

  const NodeAudit& reported(std::size_t index) const { return reported_.nodes[index]; }
  /// Commands PRE-OPERATIONAL, because the objects of a STOPPED device do not change.
  void wake(std::uint8_t node) {
    const std::array frames{make_frame(CobId::base(0), {0x80, node})};
    plant_.world.attach().send(frames, plant_.world.now());
    plant_.run_without_master(100ms);
  }
  std::int64_t number(std::uint8_t node, ObjectKey key) {
    return plant_.device(node).objects().number(key);
  }
  DeviceState state(std::uint8_t node) { return plant_.device(node).state(); }
  bool drive_runs() {
    return (number(5, {0x6041, 0}) & 0x6F) == 0x27 && number(5, {0x606C, 0}) > 4000;
  }

 private:
  Audit reported_;
  Plant plant_;
};

DeviceState state_of(const NodeAudit& reported) {
  if (!reported.notices) return DeviceState::operational;
  switch (reported.state) {
    case ErrorState::preoperational:
      return DeviceState::preoperational;
    case ErrorState::stopped:
      return DeviceState::stopped;
    case ErrorState::operational:
    case ErrorState::unspecified:
      break;
  }
  return DeviceState::operational;
}

struct Case {
  int abort_connection;
  int error_behaviour;
  bool watches;
};

class MasterDies : public testing::TestWithParam<Case> {};

TEST_P(MasterDies, AndTheDriveDoesWhatTheAuditDeclared) {
  const Case what = GetParam();
  Machine machine{
      two_nodes({"heartbeat_consumer: " + std::string{what.watches ? "true" : "false"},
                 "error_behavior: {1: " + std::to_string(what.error_behaviour) + "}",
                 "sdo: [{index: 0x6007, value: " + std::to_string(what.abort_connection) + "}]"},
                {})};
  const NodeAudit& reported = machine.reported(0);
  EXPECT_EQ(reported.verdict,
            !what.watches || what.abort_connection == 0 ? Failsafe::goes_on : Failsafe::stops);
  machine.run_with_outputs();

  const Time noticed = reported.notices.value_or(10s);
  machine.master_is_dead_for(noticed - heartbeat - 20ms);
  EXPECT_TRUE(machine.drive_runs()) << "before the time that the audit names";
  EXPECT_EQ(machine.state(5), DeviceState::operational);
  machine.master_is_dead_for(heartbeat + 40ms);
  EXPECT_EQ(machine.state(5), state_of(reported));
  machine.master_is_dead_for(5s);

  const bool goes_on = reported.verdict == Failsafe::goes_on;
  if (machine.state(5) == DeviceState::stopped) machine.wake(5);
  EXPECT_EQ(machine.drive_runs(), goes_on) << reported.outputs;
  EXPECT_EQ(machine.number(5, {0x606C, 0}) == 0, !goes_on);
}

TEST_P(MasterDies, AndTheOutputsDoWhatTheAuditDeclared) {
  const Case what = GetParam();
  const bool keeps_all = what.abort_connection == 0;  // this test uses the value as the error mode
  const std::string mode = keeps_all ? "0" : what.abort_connection == 1 ? "0x0F" : "0xFF";
  Machine machine{two_nodes(
      {}, {"heartbeat_consumer: " + std::string{what.watches ? "true" : "false"},
           "error_behavior: {1: " + std::to_string(what.error_behaviour) + "}",
           "sdo: [{index: 0x6206, sub_index: 1, value: " + mode +
               "}, {index: 0x6207, sub_index: 1, value: 0xA5}, {index: 0x6443, sub_index: 1, "
               "value: " +
               (keeps_all ? "0" : "1") + "}, {index: 0x6444, sub_index: 1, value: 77}]"})};
  const NodeAudit& reported = machine.reported(1);
  machine.run_with_outputs();

  machine.master_is_dead_for(reported.notices.value_or(10s) + 20ms);

  EXPECT_EQ(machine.state(6), state_of(reported));
  const std::int64_t digital = machine.number(6, {0x6200, 1});
  const std::int64_t analogue = machine.number(6, {0x6411, 1});
  switch (reported.verdict) {
    case Failsafe::stops:
      EXPECT_EQ(digital, 0xA5) << reported.outputs;
      EXPECT_EQ(analogue, 77);
      EXPECT_NE(reported.outputs.find("6200:01 goes to 0xA5"), std::string::npos)
          << reported.outputs;
      EXPECT_NE(reported.outputs.find("6411:01 goes to 77"), std::string::npos) << reported.outputs;
      break;
    case Failsafe::goes_on:
      EXPECT_TRUE(digital == 0xFF || digital == 0xF5) << reported.outputs;
      EXPECT_EQ(digital == 0xF5, what.watches && mode == "0x0F") << reported.outputs;
      break;
    case Failsafe::unspecified:
      EXPECT_EQ(what.error_behaviour, 1);
      break;
    case Failsafe::harmless:
      ADD_FAILURE() << "it has outputs";
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const int code : {0, 1, 2, 3}) {
    for (const int behaviour : {0, 1, 2}) {
      for (const bool watches : {true, false}) all.push_back({code, behaviour, watches});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(EveryWay, MasterDies, testing::ValuesIn(cases()));

/// Bus terminals. They support guarding, and react when SYNC is missing.
struct TerminalCase {
  std::string keys;
  bool sync;
};

class TerminalsWithoutMaster : public testing::TestWithParam<TerminalCase> {};

TEST_P(TerminalsWithoutMaster, DoWhatTheAuditDeclared) {
  const LoadedNetwork network = network_of(
      std::string{"bus: {name: hall, interface: can0}\nmaster: {"} +
      (GetParam().sync ? "sync_period: 10000, " : "") +
      "heartbeat_producer: 100}\nnodes:\n"
      "  terminals: {node_id: 11, dcf: " +
      eds("beckhoff_io") +
      ", sim: {model: beckhoff}, on_timeout: {fallback: hold, after_cycles: 60000}, rpdo: {1: "
      "{transmission: 255}}, " +
      GetParam().keys + "}\n");
  const NodeAudit reported = audit_of(network).nodes.at(0);
  Plant plant{network};
  plant.run(3s);
  plant.command(11, 0x6200, 0xFF);
  plant.run(200ms);
  ASSERT_EQ(plant.device(11).objects().number({0x6200, 1}), 0xFF);

  plant.run_without_master(reported.notices.value_or(10s) + 20ms);

  EXPECT_EQ(plant.device(11).state(), state_of(reported));
  EXPECT_EQ(plant.device(11).objects().number({0x6200, 1}),
            reported.verdict == Failsafe::stops ? 0 : 0xFF)
      << reported.outputs;
}

const std::string unwatched = "heartbeat_consumer: false";
const std::string guarded = unwatched + ", heartbeat_producer: 0, guard_time: 100";

INSTANTIATE_TEST_SUITE_P(EveryWay, TerminalsWithoutMaster,
                         testing::Values(TerminalCase{unwatched, false},
                                         TerminalCase{unwatched, true},
                                         TerminalCase{guarded, false},
                                         TerminalCase{guarded + ", life_time_factor: 3", false},
                                         TerminalCase{guarded + ", life_time_factor: 3", true}));

/// Compares the results of the audit for the demo networks with the devices. Where the outputs of a
/// family are manufacturer-specific, the audit makes no statement about them.
TEST(FamiliesWithoutMaster, ChangeTheirStateWhenTheAuditDeclaredSo) {
  for (const char* demo :
       {"lenze8400", "plain301", "astraada_drv28", "beckhoff", "sixteen_nodes"}) {
    const auto network =
        load_network(std::string{TAKT_SOURCE_DIR} + "/share/demo/" + demo + ".yaml");
    const Audit reported = audit_of(network);
    Plant plant{network};
    plant.run(10s);
    Time last{};
    for (const NodeAudit& node : reported.nodes)
      last = std::max(last, node.notices.value_or(Time{}));

    plant.run_without_master(last + 20ms);

    for (const NodeAudit& node : reported.nodes) {
      EXPECT_EQ(plant.device(node.id).state(), state_of(node)) << demo << " " << node.name;
    }
  }
}

}  // namespace
}  // namespace takt
