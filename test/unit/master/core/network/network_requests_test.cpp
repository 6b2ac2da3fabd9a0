#include <gtest/gtest.h>
#include <set>

#include "test/unit/master/core/network/network_fixture.hpp"

namespace takt {
namespace {

// Requests

TEST_F(NetworkTest, AnswersAReadWithTheValue) {
  add_drive();
  device().objects[{0x1008, 0}] = bytes({'S', 'a', 'm', 'p', 'l', 'e'});
  start();
  run(100ms);
  ASSERT_TRUE(network->submit(read(7, {0x1008, 0}), now));
  run(10ms);
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].id, 7U);
  EXPECT_EQ(replies[0].fault, SdoFault::none);
  ASSERT_EQ(replies[0].size, 6U);
  EXPECT_EQ(replies[0].data[0], std::byte{'S'});
}

TEST_F(NetworkTest, AnswersAWriteAndReportsItsAbort) {
  add_drive();
  device().write_aborts[{0x6081, 0}] = 0x06090031;
  start();
  run(100ms);
  Request write{.id = 1, .kind = RequestKind::sdo_download, .node = 5, .object = {0x6040, 0}};
  write.size = 2;
  write.data[0] = std::byte{6};
  network->submit(write, now);
  write.id = 2;
  write.object = {0x6081, 0};
  network->submit(write, now);
  run(10ms);
  ASSERT_EQ(replies.size(), 2U);
  EXPECT_EQ(replies[0].fault, SdoFault::none);
  EXPECT_EQ(replies[1].fault, SdoFault::aborted_by_device);
  EXPECT_EQ(replies[1].abort_code, 0x06090031U);
  EXPECT_EQ(sent_count(tx({0x2B, 0x40, 0x60, 0x00, 0x06})), 1);
}

TEST_F(NetworkTest, AReplyToASilentDeviceNamesTheAnswerForAnotherObject) {
  add_drive();
  device().objects[{0x1018, 1}] = bytes({1, 0, 0, 0});
  start();
  run(100ms);
  device().tamper = [](Frame& frame) { frame.data[3] = 4; };
  network->submit(read(7, {0x1018, 1}), now);
  run(3s);
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].fault, SdoFault::timeout);
  EXPECT_EQ(replies[0].silence.answered, (ObjectKey{0x1018, 4}));
  EXPECT_EQ(replies[0].silence.late, Time{});
}

TEST_F(NetworkTest, AReplyToALateDeviceSaysHowLateItAnsweredBefore) {
  add_drive();
  start();
  run(100ms);
  device().latency = 300ms;
  Request impatient = read(7, {0x1000, 0});
  impatient.timeout = 100ms;
  network->submit(impatient, now);
  run(1s);
  impatient.id = 8;
  network->submit(impatient, now);
  run(1s);
  ASSERT_EQ(replies.size(), 2U);
  EXPECT_EQ(replies[0].fault, SdoFault::timeout);
  EXPECT_EQ(replies[0].silence.late, Time{}) << "the answer has not come yet";
  EXPECT_EQ(replies[1].fault, SdoFault::timeout);
  EXPECT_GE(replies[1].silence.late, 300ms);
  EXPECT_LT(replies[1].silence.late, 310ms);
}

TEST_F(NetworkTest, KeepsRequestsWaitingBehindTheBoot) {
  add_drive();
  start();
  network->submit(read(1, {0x1000, 0}), now);
  run(20ms);
  EXPECT_TRUE(replies.empty());
  run(100ms);
  EXPECT_EQ(status().boot, BootState::ready);
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].fault, SdoFault::none);
}

TEST_F(NetworkTest, WorksOffRequestsOfOneNodeInOrderAndOfTwoAtOnce) {
  add_drive(5);
  add_drive(6);
  start();
  run(100ms);
  device(0).latency = 30ms;
  for (std::uint64_t id = 1; id <= 3; ++id) network->submit(read(id, {0x1000, 0}, 5), now);
  network->submit(read(4, {0x1000, 0}, 6), now);
  run(35ms);
  ASSERT_EQ(replies.size(), 2U);
  EXPECT_EQ(replies[0].id, 4U);
  EXPECT_EQ(replies[1].id, 1U);
  run(100ms);
  ASSERT_EQ(replies.size(), 4U);
  EXPECT_EQ(replies[2].id, 2U);
  EXPECT_EQ(replies[3].id, 3U);
}

TEST_F(NetworkTest, CancelsARequestWhoseNodeRestarts) {
  add_drive();
  start();
  run(100ms);
  device().latency = 50ms;
  network->submit(read(1, {0x1000, 0}), now);
  run(10ms);
  hear(heartbeat(0x00));
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].fault, SdoFault::cancelled);
  device().latency = 1ms;
  run(200ms);
  EXPECT_EQ(replies.size(), 1U);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(NetworkTest, DoesNotSendARequestThatWasWithdrawnWhileItWaited) {
  add_drive();
  start();
  run(100ms);
  device().latency = 50ms;
  network->submit(read(1, {0x1000, 0}), now);
  Request write{.id = 2, .kind = RequestKind::sdo_download, .node = 5, .object = {0x6040, 0}};
  write.size = 2;
  network->submit(write, now);
  network->submit(read(3, {0x1000, 0}), now);
  run(10ms);

  network->withdraw(1);  // the request is in progress
  network->withdraw(2);
  run(200ms);

  ASSERT_EQ(replies.size(), 3U);
  EXPECT_EQ(replies[0].id, 2U);
  EXPECT_EQ(replies[0].fault, SdoFault::cancelled);
  EXPECT_EQ(replies[1].fault, SdoFault::none);
  EXPECT_EQ(replies[2].fault, SdoFault::none);
  EXPECT_TRUE(device().writes.empty());
}

TEST_F(NetworkTest, WithdrawsARequestThatHasItsTurnButWasNotSent) {
  add_drive();
  start();
  run(100ms);
  Request write{.id = 7, .kind = RequestKind::sdo_download, .node = 5, .object = {0x6040, 0}};
  write.size = 2;
  network->submit(write, now);
  network->submit(read(8, {0x1000, 0}), now);

  network->withdraw(7);
  run(200ms);

  ASSERT_EQ(replies.size(), 2U);
  EXPECT_EQ(replies[0].id, 7U);
  EXPECT_EQ(replies[0].fault, SdoFault::cancelled);
  EXPECT_EQ(replies[1].fault, SdoFault::none);
  EXPECT_TRUE(device().writes.empty());
}

TEST_F(NetworkTest, AnswersRequestsForNodesItDoesNotKnow) {
  add_drive();
  start();
  EXPECT_TRUE(network->submit(read(1, {0x1000, 0}, 99), now));
  EXPECT_TRUE(network->submit(read(2, {0x1000, 0}, 200), now));
  EXPECT_TRUE(network->submit(
      {.id = 3, .kind = RequestKind::nmt, .node = 128, .command = NmtCommand::stop}, now));
  collect();
  ASSERT_EQ(replies.size(), 3U);
  for (const Reply& reply : replies) EXPECT_EQ(reply.fault, SdoFault::no_such_node);
}

TEST_F(NetworkTest, RefusesTheRequestThatDoesNotFitAndAnswersAllOthers) {
  add_drive();
  start();
  std::uint64_t accepted = 0;
  while (network->submit(read(accepted + 1, {0x1000, 0}), now)) ++accepted;
  EXPECT_EQ(accepted, 32U);
  run(1s);
  EXPECT_EQ(replies.size(), accepted);
}

TEST_F(NetworkTest, KnowsWhichObjectOfWhichNodeIsBeingWritten) {
  constexpr ObjectKey controlword{0x6040, 0};
  add_drive(5);
  add_drive(6);
  start();
  run(100ms);
  device(1).latency = 50ms;
  Request write{.id = 1, .kind = RequestKind::sdo_download, .node = 6, .object = controlword};
  write.size = 2;
  network->submit(write, now);
  for (const Time span : {0ms, 10ms}) {  // while it waits, and after it was sent
    run(span);
    EXPECT_TRUE(network->writes(6, controlword)) << span.count();
    EXPECT_FALSE(network->writes(5, controlword)) << span.count();
    EXPECT_FALSE(network->writes(6, {0x6060, 0})) << span.count();
  }
  run(100ms);
  EXPECT_FALSE(network->writes(6, controlword));

  network->submit(read(2, controlword, 6), now);
  EXPECT_FALSE(network->writes(6, controlword));
}

TEST_F(NetworkTest, IsIdleWhileNothingIsUnderWay) {
  add_drive();
  start();
  EXPECT_FALSE(network->idle());
  run(10ms);  // The node has been reset and has not booted.
  EXPECT_FALSE(network->idle());
  run(90ms);
  EXPECT_TRUE(network->idle());

  device().latency = 50ms;
  network->submit(read(1, {0x1000, 0}), now);
  EXPECT_FALSE(network->idle());
  run(10ms);
  EXPECT_FALSE(network->idle());
  run(90ms);
  EXPECT_TRUE(network->idle());

  network->begin_stop(now);
  run(100ms);
  EXPECT_TRUE(network->stopped());
  EXPECT_FALSE(network->idle());
}

TEST_F(NetworkTest, SendsNmtCommandsAndFollowsThem) {
  add_drive(5);
  add_drive(6);
  start();
  run(100ms);
  sent.clear();
  network->submit({.id = 1, .kind = RequestKind::nmt, .node = 0, .command = NmtCommand::stop}, now);
  EXPECT_EQ(network->deadline(), at_once);
  run(1ms);
  EXPECT_EQ(sent, (std::vector<Frame>{nmt({0x02, 0x00})}));
  EXPECT_EQ(status(0).nmt, NmtState::stopped);
  EXPECT_EQ(status(1).nmt, NmtState::stopped);
  EXPECT_FALSE(network->exchanges_pdos(0));
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].fault, SdoFault::none);

  network->submit({.id = 2, .kind = RequestKind::nmt, .node = 6, .command = NmtCommand::start},
                  now);
  run(1ms);
  EXPECT_FALSE(network->exchanges_pdos(0));
  EXPECT_TRUE(network->exchanges_pdos(1));
}

TEST_F(NetworkTest, AHeartbeatThatWasUnderWayDoesNotTakeANodeBackIntoTheExchange) {
  add_drive();
  start();
  run(100ms);
  ASSERT_TRUE(status().exchanging);
  network->submit({.id = 1, .kind = RequestKind::nmt, .node = 5, .command = NmtCommand::stop}, now);
  run(1ms);
  ASSERT_FALSE(status().exchanging);

  hear(heartbeat(0x05));  // It has left the device before the command.
  EXPECT_EQ(status().nmt, NmtState::operational);
  EXPECT_FALSE(status().exchanging);
  hear(heartbeat(0x05));  // The device has not obeyed.
  EXPECT_TRUE(status().exchanging);
}

TEST_F(NetworkTest, BootsANodeThatAnApplicationHasReset) {
  add_drive();
  start();
  run(100ms);
  network->submit({.id = 1, .kind = RequestKind::nmt, .node = 5, .command = NmtCommand::reset_node},
                  now);
  run(5ms);
  EXPECT_EQ(status().boot, BootState::lost);
  run(100ms);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(status().boot_count, 2U);
  EXPECT_EQ(count(EventKind::heartbeat_lost), 0);
  EXPECT_EQ(sent_count(nmt({0x81, 0x05})), 1);
  EXPECT_EQ(sent_count(nmt({0x82, 0x05})), 1);  // from the first boot only
}

// NMT by 0x1F82 of the master

const Frame start_5 = padded(CobId::base(0x67F), {0x2F, 0x82, 0x1F, 0x05, 0x05});
const Frame refused = padded(CobId::base(0x5FF), {0x80, 0x82, 0x1F, 0x05, 0x22, 0x00, 0x00, 0x08});

TEST_F(NetworkTest, ConfirmsAnNmtRequestAndSendsItsCommand) {
  add_drive();
  start();
  run(100ms);
  sent.clear();
  hear(start_5);
  step();
  EXPECT_EQ(sent, (std::vector<Frame>{padded(CobId::base(0x5FF), {0x60, 0x82, 0x1F, 0x05}),
                                      nmt({0x01, 0x05})}));
}

TEST_F(NetworkTest, RefusesAnNmtRequestWhereItsQueueIsFull) {
  add_drive();
  start();
  run(100ms);
  device().latency = 1s;
  while (network->submit(read(1, {0x1000, 0}), now)) {
  }
  sent.clear();
  hear(start_5);
  run(5ms);
  EXPECT_EQ(sent_count(refused), 1);
  EXPECT_EQ(sent_count(nmt({0x01, 0x05})), 0);
}

TEST_F(NetworkTest, RefusesAnNmtRequestWhileItStops) {
  add_drive();
  start();
  run(100ms);
  network->begin_stop(now);
  run(2ms);
  hear(start_5);
  run(2ms);
  EXPECT_EQ(sent_count(refused), 1);
}

// Stop

TEST_F(NetworkTest, StopsWithEveryRequestAnsweredAndEveryNodePreOperational) {
  add_drive(5);
  add_drive(6);
  add_drive(7).boot = false;
  start();
  run(100ms);
  device(0).latency = 1s;
  for (std::uint64_t id = 1; id <= 3; ++id) network->submit(read(id, {0x1000, 0}), now);
  run(5ms);
  sent.clear();
  EXPECT_FALSE(network->stopped());
  network->begin_stop(now);
  run(2ms);

  EXPECT_TRUE(network->stopped());
  EXPECT_EQ(replies.size(), 3U);
  for (const Reply& reply : replies) EXPECT_EQ(reply.fault, SdoFault::cancelled);
  EXPECT_EQ(sent_count(tx({0x80, 0x00, 0x10, 0x00, 0x00, 0x00, 0x00, 0x08})), 1);
  EXPECT_EQ(sent_count(nmt({0x80, 0x05})), 1);
  EXPECT_EQ(sent_count(nmt({0x80, 0x06})), 1);
  EXPECT_EQ(sent.size(), 3U);

  network->submit(read(9, {0x1000, 0}), now);
  run(5s);
  EXPECT_EQ(replies.back().fault, SdoFault::cancelled);
  EXPECT_EQ(sent.size(), 3U);  // no node is booted any more
}

}  // namespace
}  // namespace takt
