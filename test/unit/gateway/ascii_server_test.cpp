#include "master/gateway/ascii_server.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include "master/linux/unix_address.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

class AsciiServerTest : public testing::Test {
 protected:
  AsciiServer::Handler handler() {
    return {.connected = [this](int client) { connected.push_back(client); },
            .line = [this](int, std::string_view line) { lines.emplace_back(line); },
            .too_long = [this](int) { ++too_long; },
            .gone = [this](int client) { gone.push_back(client); },
            .owed = [this](int) { return owed; }};
  }
  void listen() {
    auto opened = AsciiServer::listen("unix:" + path_, handler());
    ASSERT_TRUE(opened) << opened.error();
    server = std::move(*opened);
  }
  FileDescriptor connect() {
    FileDescriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    const auto address = unix_address(path_);
    if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) !=
        0) {
      return {};
    }
    serve();
    return socket;
  }
  /// Waits for something to do, then does it.
  void serve() {
    std::vector<pollfd> descriptors;
    server->watch(descriptors);
    ::poll(descriptors.data(), descriptors.size(), 5000);
    server->serve();
  }
  static void write(const FileDescriptor& socket, std::string_view text) {
    ASSERT_EQ(::send(socket.get(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  static std::string read(const FileDescriptor& socket) {
    char text[256];
    const ssize_t size = ::recv(socket.get(), text, sizeof text, 0);
    return {text, size > 0 ? static_cast<std::size_t>(size) : 0};
  }

  const test::Folder folder_;
  const std::string path_ = folder_ / "gateway";
  std::unique_ptr<AsciiServer> server;
  std::vector<std::string> lines;
  std::vector<int> connected;
  std::vector<int> gone;
  int too_long = 0;
  bool owed = false;
};

TEST_F(AsciiServerTest, TakesLinesAndSendsThem) {
  listen();
  const FileDescriptor client = connect();
  ASSERT_EQ(connected.size(), 1U);
  write(client, "[1] help\r\n[2] he");
  serve();
  write(client, "lp\n");
  serve();
  EXPECT_EQ(lines, (std::vector<std::string>{"[1] help\r", "[2] help"}));
  server->send(connected[0], "[1] OK");
  EXPECT_EQ(read(client), "[1] OK\r\n");
}

TEST_F(AsciiServerTest, DropsALineThatIsTooLongAndGoesOn) {
  listen();
  const FileDescriptor client = connect();
  write(client, std::string(AsciiServer::longest_line + 1, 'x'));
  serve();
  EXPECT_EQ(too_long, 1);
  write(client, std::string(3 * AsciiServer::longest_line, 'y') + "\n[1] help\n");
  while (lines.empty()) serve();
  EXPECT_EQ(lines, (std::vector<std::string>{"[1] help"}));
  EXPECT_EQ(too_long, 1);
}

TEST_F(AsciiServerTest, TellsThatAClientHasGone) {
  listen();
  {
    const FileDescriptor client = connect();
  }
  serve();
  EXPECT_EQ(gone, connected);
  server->send(connected[0], "to nobody");
}

TEST_F(AsciiServerTest, KeepsAClientThatWritesNoMoreUntilItHasItsAnswer) {
  listen();
  const FileDescriptor client = connect();
  owed = true;
  write(client, "[1] 1 r 0x1018 1\n");
  ::shutdown(client.get(), SHUT_WR);
  serve();
  EXPECT_EQ(lines.size(), 1U);
  server->serve();
  EXPECT_TRUE(gone.empty());
  std::vector<pollfd> descriptors;
  server->watch(descriptors);
  EXPECT_EQ(::poll(descriptors.data(), descriptors.size(), 0), 0) << "nothing to do meanwhile";

  server->send(connected[0], "[1] 43981");
  owed = false;
  server->serve();

  EXPECT_EQ(gone, connected);
  EXPECT_EQ(read(client), "[1] 43981\r\n");
  EXPECT_EQ(read(client), "");
}

TEST_F(AsciiServerTest, KeepsNobodyWhoReadsNoMoreEither) {
  listen();
  owed = true;
  {
    const FileDescriptor client = connect();
    write(client, "[1] 1 r 0x1018 1\n");
  }
  serve();
  EXPECT_EQ(gone, connected);
}

TEST_F(AsciiServerTest, LeavesAClientThatReadsNoMore) {
  listen();
  const FileDescriptor client = connect();
  for (int i = 0; i < 2000; ++i) server->send(connected[0], std::string(1000, 'z'));
  server->serve();
  EXPECT_EQ(gone.size(), 1U);
}

TEST_F(AsciiServerTest, TakesEightClients) {
  listen();
  std::vector<FileDescriptor> clients;
  for (int i = 0; i < 9; ++i) clients.push_back(connect());
  EXPECT_EQ(connected.size(), AsciiServer::most_clients);
  EXPECT_EQ(read(clients.back()), "");  // closed
}

TEST_F(AsciiServerTest, TakesThePlaceOfADeadDaemonOnly) {
  listen();
  const auto second = AsciiServer::listen("unix:" + path_, handler());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error(), "--gateway unix:" + path_ + ": Address already in use");
  server.reset();
  EXPECT_FALSE(std::filesystem::exists(path_));

  {  // a socket whose owner died without removing it
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
