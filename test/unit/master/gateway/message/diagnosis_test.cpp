#include <cerrno>
#include <gtest/gtest.h>

#include "master/gateway/message/status_messages.hpp"

namespace takt {
namespace {

BusPlan two_nodes() {
  BusPlan plan;
  plan.name = "lift";
  for (const unsigned id : {1U, 2U}) {
    plan.nodes.push_back({.name = "node" + std::to_string(id), .id = *NodeId::from(id)});
  }
  return plan;
}

StatusSnapshot good() {
  StatusSnapshot snapshot;
  snapshot.nodes.assign(2, {.nmt = NmtState::operational, .boot = BootState::ready});
  snapshot.bus.beats = 7;
  return snapshot;
}

TEST(Diagnosis, OfABusThatRunsIsWithoutATrouble) {
  const BusPlan plan = two_nodes();
  Diagnosis diagnosis{plan};

  const diagnosis_t message = diagnosis.fill(good());

  EXPECT_EQ(message.sync_count, 7);
  EXPECT_EQ(message.nodes_not_ok, 0);
  EXPECT_EQ(message.state, 0);
  EXPECT_EQ(message.sync_toggle, 1);
  EXPECT_EQ(message.cycles_failed, 0);
  EXPECT_FALSE(message.bus_off || message.warning_limit || message.rx_queue_exceeded ||
               message.tx_queue_exceeded || message.send_error);
}

TEST(Diagnosis, CountsNodesThatAreNotReadyOrNotOperational) {
  const BusPlan plan = two_nodes();
  Diagnosis diagnosis{plan};
  StatusSnapshot snapshot = good();

  snapshot.nodes[0].boot = BootState::failed;
  EXPECT_EQ(diagnosis.fill(snapshot).nodes_not_ok, 1);
  snapshot.nodes[1].nmt = NmtState::preoperational;
  EXPECT_EQ(diagnosis.fill(snapshot).nodes_not_ok, 2);
}

TEST(Diagnosis, ReportsTheStateOfTheBus) {
  const BusPlan plan = two_nodes();
  Diagnosis diagnosis{plan};

  EXPECT_EQ(diagnosis.fill(StatusSnapshot{}).state, 1);
  StatusSnapshot snapshot = good();
  snapshot.bus.port.bus_off = true;
  EXPECT_EQ(diagnosis.fill(snapshot).state, 2);
  EXPECT_EQ(diagnosis.fill(snapshot).bus_off, 1);
  snapshot.bus.stop = StopStage::done;
  EXPECT_EQ(diagnosis.fill(snapshot).state, 3);
}

TEST(Diagnosis, ReportsOverrunsOnceAndTheWarningLimitWhileItLasts) {
  const BusPlan plan = two_nodes();
  Diagnosis diagnosis{plan};
  StatusSnapshot snapshot = good();
  snapshot.bus.port.receive_overruns = 3;
  snapshot.bus.port.tx_error_counter = 96;
  snapshot.bus.port.last_error = ENOBUFS;
  snapshot.bus.send_failures = 2;

  const diagnosis_t first = diagnosis.fill(snapshot);
  const diagnosis_t second = diagnosis.fill(snapshot);

  EXPECT_TRUE(first.rx_queue_exceeded && first.tx_queue_exceeded && first.warning_limit);
  EXPECT_FALSE(first.send_error);
  EXPECT_FALSE(second.rx_queue_exceeded || second.tx_queue_exceeded);
  EXPECT_TRUE(second.warning_limit);
}

TEST(Diagnosis, AddsUpTheCyclesThatFailed) {
  const BusPlan plan = two_nodes();
  Diagnosis diagnosis{plan};
  StatusSnapshot snapshot = good();
  snapshot.bus.cycles_missed = 1;
  snapshot.bus.outputs_skipped = 20;
  snapshot.bus.images_incomplete = 300;

  const diagnosis_t message = diagnosis.fill(snapshot);

  EXPECT_EQ(message.cycles_failed, 321);
  EXPECT_EQ(message.cycles_missed, 1);
  EXPECT_EQ(message.outputs_skipped, 20);
  EXPECT_EQ(message.images_incomplete, 300);
}

TEST(Diagnosis, SaysWhenSomethingIsNew) {
  const BusPlan plan = two_nodes();
  Diagnosis diagnosis{plan};
  StatusSnapshot snapshot = good();

  EXPECT_TRUE(diagnosis.fill(snapshot).changed);
  snapshot.bus.beats = 8;
  EXPECT_FALSE(diagnosis.fill(snapshot).changed);
  snapshot.nodes[1].emcy_count = 1;
  EXPECT_TRUE(diagnosis.fill(snapshot).changed);
  EXPECT_FALSE(diagnosis.fill(snapshot).changed);
}

Event emcy(std::uint8_t node, std::uint8_t code) {
  return {.kind = EventKind::emcy, .node = node, .bytes = {code, 0x81}};
}

TEST(EmcyLog, KeepsTheNewestTenCodesOfANodeWithoutCode0) {
  EmcyLog log;
  for (std::uint8_t i = 1; i <= 12; ++i) {
    log.take(emcy(2, i), 0);
    log.take({.kind = EventKind::emcy, .node = 2}, 0);
  }

  EXPECT_TRUE(log.codes(1).empty());
  ASSERT_EQ(log.codes(2).size(), 10u);
  EXPECT_EQ(log.codes(2).front(), 0x810C);
  EXPECT_EQ(log.codes(2).back(), 0x8103);
}

TEST(StatusMessages, OfANodeThatHasBeenSilentForAMonthReportTheLongestAge) {
  const BusPlan plan = two_nodes();
  StatusMessages messages{plan, {}};
  StatusSnapshot snapshot = good();
  snapshot.nodes[0].last_heartbeat = std::chrono::seconds{1};

  const auto sent = messages.fill(snapshot, {}, std::chrono::days{31});

  EXPECT_EQ(sent[0].nodes[0].heartbeat_age_ms, 2'147'483'647);
}

TEST(StatusMessages, CarryTheDiagnosisAndTheEmcysOfEachNode) {
  const BusPlan plan = two_nodes();
  StatusMessages messages{plan, {}};
  EmcyLog log;
  log.take(emcy(plan.nodes[0].id.value(), 0x30), 0);
  GatewayStatus gateway;
  gateway.emcys = &log;

  const auto parts = messages.fill(good(), gateway, Time{1});

  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].diagnosis.sync_count, 7);
  EXPECT_EQ(parts[0].nodes.at(0).emcys, (std::vector<std::int32_t>{0x8130}));
  EXPECT_EQ(parts[0].nodes.at(1).num_emcys, 0);
}

}  // namespace
}  // namespace takt
