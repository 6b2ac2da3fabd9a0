#include <gtest/gtest.h>

#include "master/core/lss/lss_command.hpp"
#include "master/explain/boot_report.hpp"
#include "master/sim/device/device.hpp"
#include "test/virtual/rig.hpp"

namespace takt::test {
namespace {

using namespace std::chrono_literals;

/// An LSS device in `row` of the plan with serial number `serial`; `quirk` decides whether the
/// device has a node-ID.
DeviceTable lss_device(const BusPlan& plan, std::size_t row, std::uint32_t serial,
                       const std::string& quirk = "no_node_id") {
  DeviceTable table =
      loopback_device(plan.nodes[row].id, plan.pdos.tpdos[row], plan.pdos.rpdos[row]);
  for (std::uint8_t sub = 2; sub <= 4; ++sub) {
    const std::uint32_t value = sub == 4 ? serial : sub;
    table.objects.push_back({.key = {0x1018, sub},
                             .type = DataType::unsigned32,
                             .access = Access::ro,
                             .value = sim::little_endian(value, 4),
                             .low_limit = {},
                             .high_limit = {}});
  }
  std::ranges::sort(table.objects, {}, &DeviceObject::key);
  table.quirks.push_back(quirk);
  return table;
}

Request lss_request(std::uint64_t id, std::span<const LssCommand> commands) {
  Request request{.id = id, .kind = RequestKind::lss};
  for (const LssCommand& command : commands) {
    pack(command, std::span{request.data}.subspan(request.size).first<lss_command_bytes>());
    request.size = static_cast<std::uint16_t>(request.size + lss_command_bytes);
  }
  return request;
}

struct Answer {
  SdoFault fault = SdoFault::none;
  std::vector<LssResult> results;
};

/// Sends a request and returns the answer. The fault is `timeout` if no answer came within `limit`.
Answer ask(Rig& rig, std::span<const LssCommand> commands, Time limit = 30s) {
  EXPECT_TRUE(rig.master->submit(lss_request(1, commands)));
  const Time until = rig.world->now() + limit;
  while (rig.world->now() < until) {
    rig.cycle();
    Reply reply;
    if (!rig.master->take(reply)) continue;
    Answer answer{.fault = reply.fault, .results = {}};
    for (std::size_t at = 0; at + lss_result_bytes <= reply.size; at += lss_result_bytes) {
      answer.results.push_back(
          unpack_lss_result(std::span{reply.data}.subspan(at).first<lss_result_bytes>()));
    }
    return answer;
  }
  return {.fault = SdoFault::timeout, .results = {}};
}

void give_id_by_lss(BusPlan& plan) {
  for (NodePlan& node : plan.nodes) {
    node.lss = LssPlan{.address = {0x15A, 2, 3, 0}, .known = {~0U, ~0U, ~0U, 0}};
  }
}

TEST(Lss, FindsDevicesOneAfterTheOther) {
  BusPlan plan = axes({.nodes = 3});
  for (NodePlan& node : plan.nodes) node.boot = false;
  RigOptions options;
  const std::array<std::uint32_t, 3> serials{0x8000'0000, 0x7FFF'FFFF, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    options.devices.push_back(lss_device(plan, i, serials[i]));
  }
  Rig rig{std::move(plan), std::move(options)};
  rig.run(200);

  std::vector<std::uint32_t> found;
  for (std::uint8_t id = 50; id < 55; ++id) {
    const std::array<LssCommand, 4> commands{
        LssCommand{.op = LssOp::fast_scan}, LssCommand{.op = LssOp::configure_node_id, .a = id},
        LssCommand{.op = LssOp::store}, LssCommand{.op = LssOp::switch_global}};
    const Answer answer = ask(rig, commands);
    if (answer.fault != SdoFault::none) {
      EXPECT_EQ(answer.fault, SdoFault::lss_failed);
      ASSERT_EQ(answer.results.size(), 1U);
      EXPECT_EQ(answer.results[0].outcome, LssOutcome::nobody);
      break;
    }
    ASSERT_EQ(answer.results.size(), 4U);
    EXPECT_EQ(answer.results[0].numbers[0], 0x15AU);
    EXPECT_EQ(answer.results[0].frames, 133U);
    found.push_back(answer.results[0].numbers[3]);
    rig.run(100);
    EXPECT_EQ(rig.recorder.with(0x700u + id).size(), 1U) << "boot-up message";
  }
  EXPECT_EQ(found, (std::vector<std::uint32_t>{0, 0x7FFF'FFFF, 0x8000'0000}));
}

TEST(Lss, NeedsLessThanThreeSecondsForOneDevice) {
  BusPlan plan = axes({.nodes = 1});
  plan.nodes[0].boot = false;
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 0xA5));
  Rig rig{std::move(plan), std::move(options)};
  rig.run(200);
  const Time before = rig.world->now();

  const std::array<LssCommand, 1> scan{LssCommand{.op = LssOp::fast_scan}};
  EXPECT_EQ(ask(rig, scan).fault, SdoFault::none);

  EXPECT_LT(rig.world->now() - before, 3s);
}

TEST(Lss, ReportsNoWrongAddressWhenAnswersAreLost) {
  int found = 0;
  int repeated = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    BusPlan plan = axes({.nodes = 1});
    plan.nodes[0].boot = false;
    RigOptions options;
    options.devices.push_back(lss_device(plan, 0, 0xA5));
    options.world.seed = seed;
    options.world.faults = {{.kind = sim::FaultKind::loss, .node = 1_node, .probability = 0.01}};
    Rig rig{std::move(plan), std::move(options)};
    rig.run(200);

    const std::array<LssCommand, 1> scan{LssCommand{.op = LssOp::fast_scan}};
    const Answer answer = ask(rig, scan);

    ASSERT_EQ(answer.results.size(), 1U) << seed;
    if (answer.fault != SdoFault::none) continue;
    ++found;
    repeated += answer.results[0].frames > 133;
    EXPECT_EQ(answer.results[0].numbers, (std::array<std::uint32_t, 4>{0x15A, 2, 3, 0xA5})) << seed;
  }
  EXPECT_GE(found, 30) << "most scans repeat a part and go on";
  EXPECT_GE(repeated, 5);
}

TEST(Lss, FindsAConfiguredDeviceByRanges) {
  BusPlan plan = axes({.nodes = 2});
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 17, "lss"));
  options.devices.push_back(lss_device(plan, 1, 0xFFFF'FFF0, "lss"));
  Rig rig{std::move(plan), std::move(options)};
  ASSERT_TRUE(rig.boot());

  const std::array<LssCommand, 1> scan{
      LssCommand{.op = LssOp::slow_scan, .numbers = {0x15A, 2, 0, 0xFFFF'FFFF, 18, 0xFFFF'FFFF}}};
  const Answer answer = ask(rig, scan);

  ASSERT_EQ(answer.fault, SdoFault::none);
  EXPECT_EQ(answer.results[0].numbers, (std::array<std::uint32_t, 4>{0x15A, 2, 3, 0xFFFF'FFF0}));
  EXPECT_TRUE(rig.all_ready());
}

TEST(Lss, RefusesToChangeTheBitRateOfARunningMaster) {
  Rig rig{axes({.nodes = 1})};
  const std::array<LssCommand, 1> activate{
      LssCommand{.op = LssOp::activate_bit_timing, .numbers = {100}}};
  EXPECT_EQ(ask(rig, activate, 1s).fault, SdoFault::lss_refused);
  EXPECT_EQ(ask(rig, {}, 1s).fault, SdoFault::lss_refused);
  EXPECT_TRUE(rig.recorder.with(0x7E5).empty());
}

TEST(Lss, BootsNodesThatGetTheirIdByLss) {
  BusPlan plan = axes({.nodes = 2});
  give_id_by_lss(plan);
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 17));
  options.devices.push_back(lss_device(plan, 1, 18));
  Rig rig{std::move(plan), std::move(options)};

  for (int i = 0; i < 20'000 && !rig.all_ready(); ++i) rig.cycle();

  EXPECT_TRUE(rig.all_ready());
  EXPECT_EQ(rig.count(EventKind::lss_assigned), 2);
  // No LSS request is sent once all nodes have booted.
  const std::size_t asked = rig.recorder.with(0x7E5).size();
  rig.run(5000);
  EXPECT_EQ(rig.recorder.with(0x7E5).size(), asked);
}

TEST(Lss, GivesAnIdToADeviceThatCannotStoreIt) {
  BusPlan plan = axes({.nodes = 1});
  give_id_by_lss(plan);
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 17));
  options.devices.back().quirks.push_back("lss_no_store");
  Rig rig{std::move(plan), std::move(options)};

  for (int i = 0; i < 20'000 && !rig.all_ready(); ++i) rig.cycle();

  EXPECT_TRUE(rig.all_ready());
  EXPECT_EQ(rig.count(EventKind::lss_assigned), 1);
  EXPECT_EQ(rig.count(EventKind::lss_not_assigned), 1);
}

TEST(Lss, LeavesADeviceOfAnotherIdentityAlone) {
  BusPlan plan = axes({.nodes = 1});
  give_id_by_lss(plan);
  plan.nodes[0].lss->address[1] = 77;
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 17));
  Rig rig{std::move(plan), std::move(options)};

  rig.run(20'000);

  EXPECT_EQ(rig.count(EventKind::lss_assigned), 0);
  EXPECT_FALSE(rig.world->device(rig.master->plan().nodes[0].id)->address());
  ASSERT_EQ(rig.count(EventKind::lss_not_assigned), 1) << "told once";
  const Event reported = *std::ranges::find(rig.events, EventKind::lss_not_assigned, &Event::kind);
  EXPECT_EQ(describe(rig.master->plan(), reported),
            "node 1 'axis1': a device without node id answers LSS, but no such device has vendor "
            "id 0x0000015A, product code 0x0000004D, revision number 0x00000003, which the network "
            "file gives this node: `takt lss find` shows the devices without node id");
}

TEST(Lss, ReportsNothingOfADeviceThatIsSilentToLss) {
  BusPlan plan = axes({.nodes = 1});
  give_id_by_lss(plan);
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 17));
  options.devices.back().quirks.push_back("lss_silent");
  Rig rig{std::move(plan), std::move(options)};

  rig.run(20'000);

  EXPECT_FALSE(rig.recorder.with(0x7E5).empty());
  EXPECT_EQ(rig.count(EventKind::lss_not_assigned), 0);
}

TEST(Lss, ReportsNothingOfADeviceThatBecomesAnotherNode) {
  BusPlan plan = axes({.nodes = 2});
  give_id_by_lss(plan);
  for (std::size_t i = 0; i < 2; ++i) {
    plan.nodes[i].lss->address[3] = 17 + static_cast<std::uint32_t>(i);
    plan.nodes[i].lss->known[3] = ~0U;
  }
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 17));
  options.devices.back().quirks.push_back("lss_silent");
  options.devices.push_back(lss_device(plan, 1, 18));
  Rig rig{std::move(plan), std::move(options)};

  rig.run(20'000);

  EXPECT_EQ(rig.count(EventKind::lss_assigned), 1);
  EXPECT_EQ(rig.count(EventKind::lss_not_assigned), 0);
}

TEST(Lss, LooksForNobodyWhereNoNodeWantsIt) {
  Rig rig{axes({.nodes = 2})};
  ASSERT_TRUE(rig.boot());
  rig.run(3000);
  EXPECT_TRUE(rig.recorder.with(0x7E5).empty());
}

/// Runs the ordered stop to its end. Returns false if it took longer than its limit.
bool stop(Rig& rig) {
  rig.master->request_stop();
  const Time limit = rig.world->now() + rig.master->plan().stop_timeout;
  while (!rig.master->finished() && rig.world->now() < limit) rig.cycle();
  rig.world->advance_to(rig.world->now() + 20ms);  // the last frames leave the wire
  return rig.master->finished();
}

TEST(Lss, AStopAtAnyMomentOfAScanLeavesNoDeviceInConfigurationState) {
  const std::array<LssCommand, 4> commands{
      LssCommand{.op = LssOp::fast_scan}, LssCommand{.op = LssOp::configure_node_id, .a = 50},
      LssCommand{.op = LssOp::store}, LssCommand{.op = LssOp::inquire_node_id}};
  int configured = 0;
  for (int cycles = 0; cycles < 3000; cycles += 75) {
    BusPlan plan = axes({.nodes = 1});
    plan.nodes[0].boot = false;
    const NodeId node = plan.nodes[0].id;
    RigOptions options;
    options.devices.push_back(lss_device(plan, 0, 0xA5));
    Rig rig{std::move(plan), std::move(options)};
    rig.run(200);
    ASSERT_TRUE(rig.master->submit(lss_request(1, commands)));
    rig.run(cycles);
    configured += rig.world->device(node)->lss()->in_configuration();

    EXPECT_TRUE(stop(rig)) << cycles;

    EXPECT_FALSE(rig.world->device(node)->lss()->in_configuration()) << cycles;
  }
  EXPECT_GT(configured, 0) << "some stop found a device in configuration state";
}

TEST(Lss, AStopEndsWhatAFinishedListHasLeft) {
  BusPlan plan = axes({.nodes = 1});
  plan.nodes[0].boot = false;
  const NodeId node = plan.nodes[0].id;
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 0xA5));
  Rig rig{std::move(plan), std::move(options)};
  rig.run(200);
  const std::array<LssCommand, 1> all{LssCommand{.op = LssOp::switch_global, .a = 1}};
  ASSERT_EQ(ask(rig, all).fault, SdoFault::none);
  ASSERT_TRUE(rig.world->device(node)->lss()->in_configuration());

  EXPECT_TRUE(stop(rig));

  EXPECT_FALSE(rig.world->device(node)->lss()->in_configuration());
}

TEST(Lss, AStopWithoutLssSendsNone) {
  Rig rig{axes({.nodes = 1}), {}};
  ASSERT_TRUE(rig.boot());

  EXPECT_TRUE(stop(rig));

  EXPECT_TRUE(rig.recorder.with(0x7E5).empty());
}

TEST(Lss, ADeviceOfAnotherBitRateIsOffTheBus) {
  BusPlan plan = axes({.nodes = 1});
  plan.nodes[0].boot = false;
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 17, "lss"));
  Rig rig{std::move(plan), std::move(options)};
  rig.run(200);
  const NodeId node = rig.master->plan().nodes[0].id;
  const auto announce = [&](std::array<std::uint8_t, 8> bytes) {
    rig.world->device(node)->on_frame({.id = CobId::base(0x7E5), .length = 8, .data = bytes},
                                      rig.world->now());
  };
  announce({0x04, 0x01});
  announce({0x13, 0x00, 0x03});
  announce({0x15, 0x0A, 0x00});
  rig.run(200);
  const std::array<LssCommand, 1> inquire{LssCommand{.op = LssOp::inquire_node_id}};

  EXPECT_EQ(ask(rig, inquire).results.at(0).outcome, LssOutcome::silent);
  rig.world->set_bitrate(250'000);
  EXPECT_EQ(ask(rig, inquire).results.at(0).outcome, LssOutcome::done);
}

}  // namespace
}  // namespace takt::test
