// The socket on which the text gateway listens.
#include <filesystem>
#include <fstream>
#include <netinet/in.h>

#include "test/support/no_descriptor_left.hpp"
#include "test/unit/master/gateway/ascii/ascii_server_fixture.hpp"

namespace takt {
namespace {

TEST_F(AsciiServerTest, TakesThePlaceOfADeadDaemonOnly) {
  listen();
  const auto second = AsciiServer::listen("unix:" + path_, handler());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error(), "--gateway unix:" + path_ + ": Address already in use");
  server.reset();
  EXPECT_FALSE(std::filesystem::exists(path_));

  {  // The owner of this socket has died without removing the socket.
    const FileDescriptor dead{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    const auto address = unix_address(path_);
    ASSERT_EQ(::bind(dead.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address), 0);
  }
  listen();
  server.reset();

  std::ofstream{path_} << "a file of somebody";
  EXPECT_FALSE(AsciiServer::listen("unix:" + path_, handler()));
  EXPECT_TRUE(std::filesystem::exists(path_));
}

TEST_F(AsciiServerTest, LeavesTheFileOfWhoeverHasReplacedItsSocket) {
  listen();
  std::filesystem::remove(path_);
  std::ofstream{path_} << "a file of somebody";
  server.reset();
  EXPECT_TRUE(std::filesystem::exists(path_));
}

TEST_F(AsciiServerTest, WithoutADescriptorLeftTheWaitingConnectionDoesNotWakeItForAWhile) {
  listen();
  const FileDescriptor waiting{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  const auto address = unix_address(path_);
  const auto* generic = reinterpret_cast<const sockaddr*>(&*address);
  ASSERT_EQ(::connect(waiting.get(), generic, sizeof *address), 0);
  {
    const test::NoDescriptorLeft none;
    for (int i = 0; i < 50; ++i) {  // 5 s
      EXPECT_EQ(watched(), 1U);
      server->serve();
      EXPECT_EQ(watched(), 0U);
      clock.pass(AcceptPause::length);
    }
    EXPECT_EQ(warnings.size(), 1U);
    clock.pass(AcceptPause::sentence_pause);
    server->serve();
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_TRUE(warnings[0].starts_with(
        "CiA 309-3 gateway: new connections wait: Too many open files; end some programs"))
        << warnings[0];
  }
  EXPECT_TRUE(connected.empty());

  clock.pass(AcceptPause::length);
  serve();

  EXPECT_EQ(connected.size(), 1U) << "the connection has waited";
}

TEST_F(AsciiServerTest, LeavesTheSocketOfAnotherProgramAloneWhateverItsType) {
  for (const int type : {SOCK_STREAM, SOCK_SEQPACKET, SOCK_DGRAM}) {
    const std::string path = path_ + std::to_string(type);
    const FileDescriptor other{::socket(AF_UNIX, type | SOCK_CLOEXEC, 0)};
    const auto address = unix_address(path);
    const auto* generic = reinterpret_cast<const sockaddr*>(&*address);
    ASSERT_EQ(::bind(other.get(), generic, sizeof *address), 0);
    ASSERT_EQ(type == SOCK_DGRAM ? 0 : ::listen(other.get(), 1), 0);

    EXPECT_FALSE(AsciiServer::listen("unix:" + path, handler()));
    const FileDescriptor client{::socket(AF_UNIX, type | SOCK_CLOEXEC, 0)};
    EXPECT_EQ(::connect(client.get(), generic, sizeof *address), 0) << "it still answers";
  }
}

TEST_F(AsciiServerTest, ListensOnLoopbackWhenAskedTo) {
  auto opened = AsciiServer::listen("tcp:0", handler());
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_TRUE((*opened)->where().starts_with("tcp:127.0.0.1:")) << (*opened)->where();
  EXPECT_FALSE(AsciiServer::listen("tcp:70000", handler()));
  EXPECT_FALSE(AsciiServer::listen("tcp:", handler()));
  EXPECT_FALSE(AsciiServer::listen("/tmp/x", handler()));
  EXPECT_FALSE(AsciiServer::listen("unix:", handler()));
}

}  // namespace
}  // namespace takt
