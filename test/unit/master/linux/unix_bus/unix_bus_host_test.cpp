// Which process hosts a bus: at the start, after the host has ended, and if the path is in use.
#include <filesystem>
#include <fstream>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "master/linux/file_descriptor.hpp"
#include "master/linux/unix_bus/unix_address.hpp"
#include "master/linux/unix_bus/unix_bus_hub.hpp"
#include "test/unit/master/linux/unix_bus/unix_bus_fixture.hpp"

namespace takt::test {
namespace {

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

  EXPECT_TRUE(soon(a, [&] { return a.condition().interface_down; }));
  EXPECT_EQ(a.send({&tpdo, 1}).error, ENETDOWN);
  EXPECT_TRUE(soon(a, [&] { return !a.condition().interface_down; }));
  EXPECT_TRUE(soon(b, [&] { return !b.condition().interface_down; }));
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
    EXPECT_EQ(receiver.condition().receive_overruns, 0u);
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
  EXPECT_TRUE(soon(*alone, [&] { return !alone->condition().interface_down; }));
  EXPECT_TRUE(connect_unix(*unix_address(path_)));
}

TEST_F(UnixBus, ExactlyOneHubHosts) {
  auto first = UnixBusHub::join(path_);
  auto second = UnixBusHub::join(path_);

  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->hosting());
  EXPECT_FALSE(second->hosting());
}

TEST_F(UnixBus, APathThatIsTooLongIsRefusedWithASentence) {
  const auto opened = UnixBusPort::open({.path = std::string(200, 'x')});

  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("107"), std::string::npos);
}

}  // namespace
}  // namespace takt::test
