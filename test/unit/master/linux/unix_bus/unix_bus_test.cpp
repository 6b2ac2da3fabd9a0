// Frames between the members of a bus.
#include <sys/socket.h>
#include <unistd.h>

#include "master/linux/unix_bus/unix_address.hpp"
#include "test/unit/master/linux/unix_bus/unix_bus_fixture.hpp"

namespace takt::test {
namespace {

TEST_F(UnixBus, CarriesAFrameUnchangedToTheOthersButNotToItsSender) {
  UnixBusPort a = port();
  UnixBusPort b = port();
  make_acquainted(a, b);
  Frame remote = make_frame(CobId::extended(0x12345), {});
  remote.rtr = true;
  remote.length = 4;

  const std::array<Frame, 2> sent{tpdo, remote};
  EXPECT_EQ(a.send(sent).sent, 2U);

  const auto got = receive_all(b, 2);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].frame, tpdo);
  EXPECT_EQ(got[1].frame, remote);
  EXPECT_GT(got[0].when, Time{0});
  EXPECT_LE(got[0].when, b.now());
  std::array<StampedFrame, 4> own;
  EXPECT_EQ(a.receive(own), 0U);
}

TEST_F(UnixBus, ReportsWhenTheOwnSyncWasOnTheWire) {
  UnixBusPort a = port();
  const Time before = a.now();

  a.send({&sync_frame, 1});

  EXPECT_TRUE(soon(a, [&] { return a.condition().last_sync_echo >= before; }));
  EXPECT_LE(a.condition().last_sync_echo, a.now());
}

TEST_F(UnixBus, TheSyncOfAnotherIsAFrameAndNoEcho) {
  UnixBusPort a = port();
  UnixBusPort b = port();
  make_acquainted(a, b);

  b.send({&sync_frame, 1});

  const auto got = receive_all(a, 1);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].frame, sync_frame);
  EXPECT_EQ(a.condition().last_sync_echo, Time{0});
}

TEST_F(UnixBus, KeepsTheOrderOfALargeBatch) {
  UnixBusPort a = port();
  UnixBusPort b = port();
  make_acquainted(a, b);
  std::vector<Frame> batch;
  for (std::uint32_t i = 0; i < 200; ++i) {
    batch.push_back(make_frame(CobId::base(0x181), {static_cast<std::uint8_t>(i)}));
  }

  std::size_t sent = 0;
  std::vector<StampedFrame> got;
  while (sent < batch.size()) {
    sent += a.send(std::span{batch}.subspan(sent)).sent;
    const auto some = receive_all(b, sent - got.size());
    got.insert(got.end(), some.begin(), some.end());
  }

  ASSERT_EQ(got.size(), batch.size());
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_EQ(got[i].frame, batch[i]) << i;
}

TEST_F(UnixBus, ASlowReaderLosesFramesIsReportedHowManyAndBlocksNobody) {
  UnixBusPort a = port();
  UnixBusPort b = port();
  UnixBusPort slow = port();
  make_acquainted(a, b);
  make_acquainted(a, slow);
  receive_all(b, 1);

  // The member sends far more frames than any socket buffer holds, and b confirms each one, so the
  // bus is not blocked.
  std::size_t confirmed = 0;
  std::array<Frame, 50> burst;
  burst.fill(tpdo);
  while (confirmed < 40'000) {
    const std::size_t sent = a.send(burst).sent;
    const std::size_t got = receive_all(b, sent).size();
    ASSERT_GE(got, sent);
    confirmed += got;
  }

  EXPECT_TRUE(soon(slow, [&] {
    a.send({&tpdo, 1});
    return slow.condition().receive_overruns > 0;
  }));
  EXPECT_EQ(b.condition().receive_overruns, 0U);
}

TEST_F(UnixBus, AFullSocketIsReportedAsNoBuffers) {
  auto [a, b] = make_socket_pair_bus();

  SendResult result;
  for (int i = 0; i < 100'000 && result.error == 0; ++i) result = a.send({&tpdo, 1});

  EXPECT_EQ(result.error, ENOBUFS);
  EXPECT_FALSE(a.condition().interface_down);
  EXPECT_EQ(a.condition().last_error, ENOBUFS);
}

/// A tool that sends one command and ends does not read the frames that others send in this time.
TEST_F(UnixBus, WhatAMemberHasSentArrivesAlthoughItEndsWithoutReading) {
  UnixBusPort resident = port();
  for (int run = 0; run < 200; ++run) {
    auto guest = std::make_unique<UnixBusPort>(port());
    make_acquainted(resident, *guest);
    ASSERT_EQ(resident.send({&sync_frame, 1}).sent, 1U);
    ASSERT_TRUE(guest->wait_frame(guest->now() + limit));

    ASSERT_EQ(guest->send({&sync_frame, 1}).sent, 1U);
    guest.reset();

    ASSERT_EQ(receive_all(resident, 1).size(), 1U) << "in run " << run;
  }
}

TEST_F(UnixBus, GarbageOfAClientReachesNobody) {
  UnixBusPort a = port();
  UnixBusPort b = port();
  make_acquainted(a, b);
  const int rogue = socket(AF_UNIX, SOCK_SEQPACKET, 0);
  const auto address = unix_address(path_);
  ASSERT_EQ(connect(rogue, reinterpret_cast<const sockaddr*>(&*address), sizeof *address), 0);
  std::array<char, 32> garbage;
  garbage.fill(0x55);

  EXPECT_EQ(send(rogue, garbage.data(), garbage.size(), 0), 32);
  EXPECT_EQ(send(rogue, garbage.data(), 7, 0), 7);
  a.send({&tpdo, 1});

  const auto got = receive_all(b, 1);
  close(rogue);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].frame, tpdo);
}

}  // namespace
}  // namespace takt::test
