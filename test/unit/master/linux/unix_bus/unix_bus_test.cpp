#include "master/linux/unix_bus/unix_bus.hpp"

#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/unix_bus/unix_address.hpp"
#include "master/linux/unix_bus/unix_bus_hub.hpp"
#include "test/support/folder.hpp"
#include "test/support/patience.hpp"

namespace takt {
namespace {

constexpr Time limit = test::patience;  // for another thread; never reached

const Frame sync_frame = make_frame(CobId::base(0x080), {0x01});
const Frame tpdo = make_frame(CobId::base(0x185), {1, 2, 3, 4, 5, 6, 7, 8});

class UnixBus : public testing::Test {
 protected:
  UnixBusPort port() {
    auto opened = UnixBusPort::open({.path = path_, .sync_cob_id = CobId::base(0x080)});
    EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
    return std::move(*opened);
  }

  const test::Folder folder_;
  const std::string path_ = folder_ / "bus";
};

/// Receives until `wanted` frames are there.
std::vector<StampedFrame> receive_all(UnixBusPort& port, std::size_t wanted) {
  std::vector<StampedFrame> all;
  const Time until = port.now() + limit;
  while (all.size() < wanted && port.now() < until) {
    std::array<StampedFrame, 300> some;
    port.wait_frame(until);
    const std::size_t count = port.receive(some);
    all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return all;
}

template <class Condition>
bool soon(UnixBusPort& port, Condition condition) {
  const Time until = port.now() + limit;
  std::array<StampedFrame, 8> some;
  bool met = condition();  // called only as often as needed, because it may send
  while (!met && port.now() < until) {
    port.wait_frame(port.now() + std::chrono::milliseconds{5});
    port.receive(some);
    met = condition();
  }
  return met;
}

/// Waits until all members are connected: each has received a frame of the other.
void make_acquainted(UnixBusPort& a, UnixBusPort& b) {
  const Time until = a.now() + limit;
  std::array<StampedFrame, 8> some;
  bool a_heard = false;
  bool b_heard = false;
  while (!(a_heard && b_heard) && a.now() < until) {
    a.send({&tpdo, 1});
    b.send({&tpdo, 1});
    b.wait_frame(b.now() + std::chrono::milliseconds{5});
    a_heard |= a.receive(some) > 0;
    b_heard |= b.receive(some) > 0;
  }
  ASSERT_TRUE(a_heard && b_heard);
  // Discard the frames in transit; a marker frame of each member ends them.
  const Frame marker = make_frame(CobId::base(0x7FF), {});
  a.send({&marker, 1});
  b.send({&marker, 1});
  const auto drain = [&](UnixBusPort& port) {
    for (;;) {
      const auto got = receive_all(port, 1);
      if (got.empty() || got.back().frame.id == marker.id) return;
    }
  };
  drain(a);
  drain(b);
}

TEST_F(UnixBus, LeavesAFileAloneThatIsNoSocket) {
  folder_.write("bus", "the only copy");

  const auto opened = UnixBusPort::open({.path = path_});

  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("takt does not change it"), std::string::npos)
      << opened.error().message;
  std::string content;
  std::getline(std::ifstream{path_}, content);
  EXPECT_EQ(content, "the only copy");
  EXPECT_FALSE(std::filesystem::exists(path_ + ".lock")) << "a file of a bus that there is not";
}

TEST_F(UnixBus, TakesThePlaceOfASocketThatItsHostHasLeft) {
  const auto address = unix_address(path_);
  FileDescriptor left{socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)};
  ASSERT_EQ(bind(left.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address), 0);
  left.reset();

  EXPECT_TRUE(UnixBusPort::open({.path = path_}));
}

TEST_F(UnixBus, LeavesTheSocketOfAnotherProgramAlone) {
  const auto address = unix_address(path_);
  const auto* generic = reinterpret_cast<const sockaddr*>(&*address);
  for (const int type : {SOCK_STREAM, SOCK_SEQPACKET}) {
    std::filesystem::remove(path_);
    const FileDescriptor other{socket(AF_UNIX, type | SOCK_CLOEXEC, 0)};
    ASSERT_EQ(bind(other.get(), generic, sizeof *address), 0);
    ASSERT_EQ(listen(other.get(), 64), 0);

    const auto opened = UnixBusPort::open({.path = path_});

    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().message, "unix:" + path_ +
                                          ": another program listens there, and it is not a bus "
                                          "of takt; the bus needs its own path");
    const FileDescriptor client{socket(AF_UNIX, type | SOCK_CLOEXEC, 0)};
    EXPECT_EQ(connect(client.get(), generic, sizeof *address), 0) << "it still answers";
  }
}

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

TEST_F(UnixBus, TellsWhenTheOwnSyncWasOnTheWire) {
  UnixBusPort a = port();
  const Time before = a.now();

  a.send({&sync_frame, 1});

  EXPECT_TRUE(soon(a, [&] { return a.news().last_sync_echo >= before; }));
  EXPECT_LE(a.news().last_sync_echo, a.now());
}

TEST_F(UnixBus, TheSyncOfAnotherIsAFrameAndNoEcho) {
  UnixBusPort a = port();
  UnixBusPort b = port();
  make_acquainted(a, b);

  b.send({&sync_frame, 1});

  const auto got = receive_all(a, 1);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].frame, sync_frame);
  EXPECT_EQ(a.news().last_sync_echo, Time{0});
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

TEST_F(UnixBus, ASlowReaderLosesFramesIsToldHowManyAndBlocksNobody) {
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
    return slow.news().receive_overruns > 0;
  }));
  EXPECT_EQ(b.news().receive_overruns, 0U);
}

TEST_F(UnixBus, AFullSocketIsToldAsNoBuffers) {
  auto [a, b] = make_socket_pair_bus();

  SendResult result;
  for (int i = 0; i < 100'000 && result.error == 0; ++i) result = a.send({&tpdo, 1});

  EXPECT_EQ(result.error, ENOBUFS);
  EXPECT_FALSE(a.news().interface_down);
  EXPECT_EQ(a.news().last_error, ENOBUFS);
}

TEST_F(UnixBus, AnotherProcessTakesOverWhenTheHostIsKilled) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t host = fork();
  if (host == 0) {
    auto own = UnixBusPort::open({.path = path_});
    const char byte = own ? 'y' : 'n';
    if (write(ready[1], &byte, 1) != 1) _exit(1);
    for (;;) pause();
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  ASSERT_EQ(byte, 'y');
  UnixBusPort a = port();
  UnixBusPort b = port();
  make_acquainted(a, b);

  kill(host, SIGKILL);
  waitpid(host, nullptr, 0);

  EXPECT_TRUE(soon(a, [&] { return a.news().interface_down; }));
  EXPECT_EQ(a.send({&tpdo, 1}).error, ENETDOWN);
  EXPECT_TRUE(soon(a, [&] { return !a.news().interface_down; }));
  EXPECT_TRUE(soon(b, [&] { return !b.news().interface_down; }));
  make_acquainted(a, b);
  close(ready[0]);
  close(ready[1]);
}

TEST_F(UnixBus, WhatTheHostHasTakenArrivesAlthoughItEnds) {
  for (int run = 0; run < 20; ++run) {
    auto host = std::make_unique<UnixBusPort>(port());
    UnixBusPort sender = port();
    UnixBusPort receiver = port();
    make_acquainted(sender, receiver);
    const std::vector<Frame> frames(200, sync_frame);

    const std::size_t taken = sender.send(frames).sent;
    host.reset();

    EXPECT_EQ(receive_all(receiver, taken).size(), taken);
    EXPECT_EQ(receiver.news().receive_overruns, 0u);
  }
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

TEST_F(UnixBus, AGuestHostsOnlyWhereNobodyElseDoes) {
  const auto guest = [this] {
    return UnixBusPort::open({.path = path_, .member = BusMember::guest});
  };
  auto resident = std::make_unique<UnixBusPort>(port());
  auto among_others = guest();
  ASSERT_TRUE(among_others);
  resident.reset();

  EXPECT_FALSE(connect_unix(*unix_address(path_))) << "the guest has taken over";

  auto alone = guest();
  ASSERT_TRUE(alone);
  EXPECT_TRUE(soon(*alone, [&] { return !alone->news().interface_down; }));
  EXPECT_TRUE(connect_unix(*unix_address(path_)));
}

TEST_F(UnixBus, ExactlyOneHubHosts) {
  auto first = UnixBusHub::join(path_);
  auto second = UnixBusHub::join(path_);

  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->hosting());
  EXPECT_FALSE(second->hosting());
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

TEST_F(UnixBus, APathThatIsTooLongIsRefusedWithASentence) {
  const auto opened = UnixBusPort::open({.path = std::string(200, 'x')});

  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("107"), std::string::npos);
}

TEST(SocketPairBus, EchoesTheSyncThatTheDevicesHaveSeen) {
  auto [master, end] = make_socket_pair_bus();
  FrameChannel devices{std::move(end)};
  const Time before = master.now();

  master.send({&sync_frame, 1});
  StampedFrame seen;
  ASSERT_TRUE(devices.receive(seen, limit));
  devices.send(tpdo);

  std::array<StampedFrame, 4> in;
  ASSERT_EQ(master.receive(in), 1U);
  EXPECT_EQ(seen.frame, sync_frame);
  EXPECT_EQ(in[0].frame, tpdo);
  EXPECT_GE(master.news().last_sync_echo, before);
}

TEST(SocketPairBus, ABatchIsFullEvenWhereSomeOfItWasForThePortAlone) {
  auto [master, devices] = make_socket_pair_bus();
  std::array<StampedFrame, 8> in;
  for (int i = 0; i < 3; ++i) master.send({&sync_frame, 1});
  ASSERT_EQ(devices.receive(in), 3U);  // and gives the echoes back
  const std::vector<Frame> tpdos(10, tpdo);
  devices.send(tpdos);

  EXPECT_EQ(master.receive(in), 8U);
  EXPECT_EQ(master.receive(in), 2U);
}

TEST(SocketPairBus, GoesDownForGoodWhenTheDevicesEnd) {
  auto [master, end] = make_socket_pair_bus();
  {
    const UnixBusPort gone = std::move(end);
  }

  std::array<StampedFrame, 4> in;
  EXPECT_EQ(master.receive(in), 0U);

  EXPECT_TRUE(master.news().interface_down);
  EXPECT_EQ(master.send({&tpdo, 1}).error, ENETDOWN);
}

TEST(FrameChannel, RefusesNamesThatAreNoBus) {
  const auto sim = FrameChannel::open("sim");
  const auto missing = FrameChannel::open("no_such_can_interface");

  ASSERT_FALSE(sim);
  ASSERT_FALSE(missing);
  EXPECT_NE(sim.error().message.find("unix:PATH"), std::string::npos);
}

}  // namespace
}  // namespace takt
