#include "master/explain/boot_report.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <string>

#include "master/explain/boot_remedy.hpp"
#include "test/unit/master/core/network/network_rig.hpp"

namespace takt {
namespace {

/// Boots a node that fails and returns the report for the user.
class BootReport : public testing::Test, public NetworkRig {
 protected:
  std::string report(Steps steps, Time span = 10s) {
    plan.interface = "can0";
    add(5, std::move(steps.plan));
    if (prepare) prepare(device());
    start();
    run(span);
    const Event* event = find(EventKind::boot_failed);
    if (event == nullptr) return "the boot did not fail";
    return describe(plan, *event);
  }
  std::function<void(FakeNode&)> prepare;
};

BootStep with(BootStep step, std::string purpose, std::string eds_note = {}) {
  step.purpose = std::move(purpose);
  step.eds_note = std::move(eds_note);
  return step;
}

BootStep expecting(char letter, ObjectKey object, std::vector<std::byte> value) {
  return {.action = BootAction::expect,
          .letter = letter,
          .object = object,
          .value = std::move(value),
          .timeout = 500ms};
}

BootStep writing(ObjectKey object, std::vector<std::byte> value) {
  return {.action = BootAction::write,
          .letter = 'J',
          .object = object,
          .value = std::move(value),
          .timeout = 500ms};
}

TEST_F(BootReport, OfAWrongVendor) {
  prepare = [](FakeNode& node) {
    node.objects[{0x1000, 0}] = bytes({0x92, 0x01, 0x02, 0x00});
    node.objects[{0x1018, 1}] = bytes({0x5A, 0x01, 0x00, 0x00});
  };
  Steps steps;
  steps.object(BootAction::probe, 'B', {0x1000, 0})
      .add(with(expecting('D', {0x1018, 1}, bytes({0x42, 0, 0, 0})), "vendor id",
                "VendorNumber=0x42 in [DeviceInfo]"));
  EXPECT_EQ(report(std::move(steps), 500ms),
            R"(node 5 'shoulder' failed to boot at step 2 of 2 (vendor id) after 2 ms
  sent      605  40 18 10 01 00 00 00 00   read 1018:01
  received  585  43 18 10 01 5A 01 00 00
  meaning   0x0000015A (346)
  expected  0x00000042 (66)
  status    D of CiA 302-2: vendor id differs
  heard     no boot-up message and no heartbeat
  EDS       VendorNumber=0x42 in [DeviceInfo]
  try       a device other than the configured one answers at node id 5: check the node ids and the wiring, name the EDS of the connected device instead of drive.eds, or correct `vendor_id` where the network file gives it)");
}

TEST_F(BootReport, OfARefusedMapping) {
  prepare = [this](FakeNode& node) {
    node.write_aborts[{0x1A00, 2}] = 0x06040041;
    node.heartbeats(now, 2ms);
  };
  Steps steps;
  steps.object(BootAction::write, 'J', {0x1A00, 1}, bytes({0x10, 0x00, 0x41, 0x60}))
      .object(BootAction::write, 'J', {0x1A00, 1}, bytes({0x10, 0x00, 0x41, 0x60}))
      .add(with(writing({0x1A00, 2}, bytes({0x10, 0x00, 0x77, 0x60})),
                "TPDO1 mapping entry 2: 6077:00 Torque actual value", "PDOMapping=1"));
  EXPECT_EQ(
      report(std::move(steps), 500ms),
      R"(node 5 'shoulder' failed to boot at step 3 of 3 (TPDO1 mapping entry 2: 6077:00 Torque actual value) after 3 ms
  sent      605  23 00 1A 02 10 00 77 60   write 1A00:02
  received  585  80 00 1A 02 41 00 04 06
  meaning   abort 0604 0041: object can't be mapped into the PDO
  status    J of CiA 302-2: configuration failed
  heard     heartbeats with the state PRE-OPERATIONAL
  EDS       PDOMapping=1
  try       the device does not let 6077:00 be mapped into TPDO1, although the EDS may allow it: take 6077:00 out of the mapping of TPDO1 in the network file, or map a related object)");
}

TEST_F(BootReport, OfAMuteNode) {
  prepare = [](FakeNode& node) { node.on = false; };
  Steps steps;
  steps.nmt(NmtCommand::reset_communication).wait(BootAction::await_bootup, 'B', 500ms);
  steps.add(with({.action = BootAction::probe, .letter = 'B', .object = {0x1000, 0}, .timeout = 2s},
                 "device type"));
  EXPECT_EQ(report(std::move(steps), 3s),
            R"(node 5 'shoulder' failed to boot at step 3 of 3 (device type) after 2.5 s
  sent      605  40 00 10 00 00 00 00 00   read 1000:00
  received  nothing within 2 s
  status    B of CiA 302-2: no answer to the read of 0x1000
  heard     no boot-up message and no heartbeat
  try       node 5 has sent nothing: is it powered and wired (CAN_H, CAN_L, ground, 120 ohm at both ends of the line)? Is its node id 5 and its bit rate 1000 kbit/s? `takt dump --bus can0` shows which nodes send on the bus)");
}

TEST_F(BootReport, OfANodeThatIsAliveButAnswersNoSdo) {
  prepare = [](FakeNode& node) { node.mute_sdo = true; };
  Steps steps;
  steps.nmt(NmtCommand::reset_communication).wait(BootAction::await_bootup, 'B', 500ms);
  steps.add(with({.action = BootAction::probe, .letter = 'B', .object = {0x1000, 0}, .timeout = 2s},
                 "device type"));
  const std::string text = report(std::move(steps), 3s);
  EXPECT_NE(text.find("\n  heard     its boot-up message\n"), std::string::npos) << text;
  EXPECT_NE(text.find("its SDO server does not answer"), std::string::npos) << text;
}

TEST_F(BootReport, OfAMissingHeartbeat) {
  Steps steps;
  steps.add(with({.action = BootAction::await_heartbeat, .letter = 'K', .timeout = 300ms},
                 "first heartbeat"));
  EXPECT_EQ(report(std::move(steps), 500ms),
            R"(node 5 'shoulder' failed to boot at step 1 of 1 (first heartbeat) after 300 ms
  received  no heartbeat on 0x705 within 300 ms
  status    K of CiA 302-2: no heartbeat or guarding answer at the start of error control
  heard     no boot-up message and no heartbeat
  try       the device produces no heartbeat: is 0x1017 zero after the boot? Set `heartbeat_producer` of this node in ms; with 0 the master expects no heartbeat)");
}

TEST_F(BootReport, OfAWriteThatTakesTooLong) {
  prepare = [](FakeNode& node) { node.mute_sdo = true; };
  Steps steps;
  steps.add(with(writing({0x1010, 1}, bytes({0x73, 0x61, 0x76, 0x65})), "store parameters"));
  EXPECT_EQ(report(std::move(steps), 1100ms),
            R"(node 5 'shoulder' failed to boot at step 1 of 1 (store parameters) after 1 s
  sent      605  23 10 10 01 73 61 76 65   write 1010:01
  received  nothing within 500 ms; the master does not repeat a write
  status    J of CiA 302-2: configuration failed
  heard     no boot-up message and no heartbeat
  try       the device needs longer than 500 ms for 1010:01 (flash memory takes seconds): raise `sdo_timeout_ms` of this node. The master did not repeat the write, because the write might act twice)");
}

TEST_F(BootReport, OfANodeThatDoesNotStart) {
  prepare = [this](FakeNode& node) {
    node.starts = false;
    node.heartbeats(now, 50ms);
    node.say(now + 60ms, 0x80, {0x10, 0x82, 0x11, 0, 0, 0, 0, 0});
  };
  Steps steps;
  steps.nmt(NmtCommand::start)
      .add(with({.action = BootAction::await_operational, .letter = 'L', .timeout = 300ms},
                "OPERATIONAL"));
  EXPECT_EQ(report(std::move(steps), 500ms),
            R"(node 5 'shoulder' failed to boot at step 2 of 2 (OPERATIONAL) after 300 ms
  received  heartbeats with the state PRE-OPERATIONAL for 300 ms
  heard     heartbeats with the state PRE-OPERATIONAL
  EMCY      0x8210: PDO not processed: its length is wrong
  try       the node did not go to OPERATIONAL after NMT start: an error of the device prevents it (look at its EMCY messages, 0x1001 and 0x1003), or a second master commands another state)");
}

TEST_F(BootReport, OfANodeThatTakesTheCounterOfSyncForAnError) {
  plan.cycle.sync_overflow = 10;
  prepare = [this](FakeNode& node) {
    node.starts = false;
    node.heartbeats(now, 50ms);
    node.say(now + 60ms, 0x80, {0x40, 0x82, 0x11, 0, 0, 0, 0, 0});
    node.say(now + 400ms, 0x80, {0x40, 0x82, 0x11, 0, 0, 0, 0, 0});  // again at the second try
  };
  Steps steps;
  steps.nmt(NmtCommand::start)
      .add(with({.action = BootAction::await_operational, .letter = 'L', .timeout = 300ms},
                "OPERATIONAL"));
  const std::string text = report(std::move(steps), 900ms);
  EXPECT_NE(text.find("Let the device store 0x1019 (`store_configuration: 1` of this node)"),
            std::string::npos)
      << text;
}

TEST_F(BootReport, OfAValueThatTheDeviceChangedByItself) {
  prepare = [](FakeNode& node) { node.objects[{0x1016, 1}] = bytes({0xC8, 0, 0x7F, 0}); };
  Steps steps;
  BootStep step = expecting('J', {0x1016, 1}, bytes({0xCA, 0, 0x7F, 0}));
  step.action = BootAction::verify;
  steps.add(with(std::move(step), "heartbeat consumer"));
  const std::string text = report(std::move(steps), 100ms);
  EXPECT_NE(text.find("meaning   0x007F00C8 (8323272)\n  expected  0x007F00CA (8323274)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("enter the value that the device keeps"), std::string::npos) << text;
}

TEST_F(BootReport, OfANodeThatRestartsAgainAndAgain) {
  prepare = [this](FakeNode& node) {
    for (int i = 1; i < 40; ++i) node.say(now + i * 5ms, 0x700, {0x00});
  };
  Steps steps;
  for (int i = 0; i < 20; ++i) steps.object(BootAction::write, 'J', {0x2000, 0}, bytes({1}));
  const std::string text = report(std::move(steps), 500ms);
  EXPECT_NE(text.find("received  6 boot-up messages while the node was being booted"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("check the power supply"), std::string::npos) << text;
}

TEST(Remedy, DiffersForEachAbortOfAMapping) {
  BusPlan plan{.name = "lift"};
  plan.nodes.push_back({.name = "shoulder", .id = 5_node});
  plan.nodes[0].boot_plan.steps = {writing({0x1601, 1}, bytes({0x20, 0x00, 0x7A, 0x60}))};
  const auto text = [&](std::uint32_t code) {
    BootFailure failure;
    failure.fault = SdoFault::aborted_by_device;
    failure.downloading = true;
    failure.abort_code = code;
    failure.object = {0x1601, 1};
    return remedy(plan, plan.nodes[0], failure);
  };
  EXPECT_NE(text(0x06040041).find("607A:00 out of the mapping of RPDO2"), std::string::npos);
  EXPECT_NE(text(0x06040042).find("can't hold so many bytes or entries in RPDO2"),
            std::string::npos);
  EXPECT_NE(text(0x06020000).find("no object 607A:00"), std::string::npos);
  EXPECT_NE(text(0x06010002).find("mapping of RPDO2 is fixed"), std::string::npos);
  EXPECT_NE(text(0x06090030).find("refuses to change RPDO2 now"), std::string::npos);
}

TEST(Remedy, OfAnAnswerThatDoesNotEndBlamesTheServerWhereTheLengthIsKnown) {
  BusPlan plan{.name = "lift"};
  plan.nodes.push_back({.name = "shoulder", .id = 5_node});
  plan.nodes[0].boot_plan.steps = {expecting('C', {0x1000, 0}, bytes({0x92, 1, 2, 0}))};
  BootFailure failure;
  failure.fault = SdoFault::too_long;
  failure.object = {0x1000, 0};
  EXPECT_EQ(remedy(plan, plan.nodes[0], failure),
            "the device sends more than 1024 bytes for 1000:00, which has 4: its SDO server is "
            "faulty. Look for other firmware, or leave the object out of the network file");
}

TEST(LetterText, HasWordsForAToO) {
  for (char letter = 'A'; letter <= 'O'; ++letter) {
    EXPECT_NE(letter_text(letter), "unknown status") << letter;
  }
  EXPECT_EQ(letter_text('P'), "unknown status");
  EXPECT_EQ(letter_text(' '), "unknown status");
}

TEST(Explain, SurvivesARecordThatDoesNotFitThePlan) {
  BusPlan plan{.name = "lift"};
  plan.nodes.push_back({.name = "shoulder", .id = 5_node});
  BootFailure failure;
  failure.step = 77;
  EXPECT_EQ(explain(plan, 0, failure), "node 5 'shoulder' failed to boot");
  EXPECT_FALSE(explain(plan, 9, failure).empty());
}

TEST(Describe, HasWordsForEveryEvent) {
  BusPlan plan{.name = "lift", .interface = "can0"};
  plan.nodes.push_back({.name = "shoulder", .id = 5_node});
  for (int kind = 0; kind <= static_cast<int>(EventKind::stopped); ++kind) {
    for (const unsigned node : {0U, 5U, 9U}) {
      Event event;
      event.kind = static_cast<EventKind>(kind);
      event.node = static_cast<std::uint8_t>(node);
      event.value = 70'000;
      EXPECT_FALSE(describe(plan, event).empty());
      EXPECT_NE(name(event.kind), "unknown");
    }
  }
}

TEST(Describe, IsOneLineAnEvent) {
  BusPlan plan{.name = "lift", .interface = "can0"};
  plan.nodes.push_back({.name = "shoulder", .id = 5_node});
  Event lost;
  lost.kind = EventKind::heartbeat_lost;
  lost.node = 5;
  lost.value = 150'000'000;
  EXPECT_EQ(describe(plan, lost), "node 5 'shoulder': heartbeat lost: silent for 150 ms");

  Event emcy;
  emcy.kind = EventKind::emcy;
  emcy.node = 5;
  emcy.bytes = {0x10, 0x73, 0x21, 1, 2, 3, 4, 5};
  EXPECT_EQ(describe(plan, emcy),
            "node 5 'shoulder': EMCY 0x7310: speed sensor (error register: generic, profile; bytes "
            "10 73 21 01 02 03 04 05)");
  emcy.detail = 3;
  EXPECT_EQ(describe(plan, emcy),
            "node 5 'shoulder': EMCY 0x7310: speed sensor (error register: generic, profile; bytes "
            "10 73 21, always 8)");
  emcy.detail = 2;
  EXPECT_EQ(describe(plan, emcy),
            "node 5 'shoulder': EMCY 0x7310: speed sensor (bytes 10 73, always 8)");
  emcy.detail = 1;
  emcy.bytes = {0x11};
  EXPECT_EQ(describe(plan, emcy),
            "node 5 'shoulder': EMCY of 1 byte, too short for an error code (bytes 11, always 8)");

  Event foreign;
  foreign.kind = EventKind::foreign_nmt;
  foreign.bytes = {0x81, 0x05};
  EXPECT_EQ(describe(plan, foreign),
            "bus 'lift': NMT command 81 05 came that this master did not send: there is a second "
            "master on the bus");
}

}  // namespace
}  // namespace takt
