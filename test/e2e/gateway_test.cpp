#include <chrono>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <string>
#include <sys/socket.h>

#include "master/linux/unix_bus/unix_address.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"
#include "test/support/time_limit.hpp"

namespace takt::test {
namespace {

constexpr int time_limit_ms = static_cast<int>(std::chrono::milliseconds{time_limit}.count());

/// A client of the ASCII gateway.
class Client {
 public:
  explicit Client(const std::string& path) {
    const auto address = unix_address(path);
    socket_ = FileDescriptor{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    good_ = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&*address),
                      sizeof *address) == 0;
  }
  /// Connects to a TCP port on loopback.
  explicit Client(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socket_ = FileDescriptor{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    good_ =
        ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  bool good() const noexcept { return good_; }
  void say(const std::string& text) {
    ASSERT_EQ(::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  /// Returns the next line that starts with `begin`, without the line end, and skips other lines.
  std::string line(const std::string& begin) {
    for (;;) {
      const std::size_t end = unread_.find("\r\n");
      if (end != std::string::npos) {
        const std::string found = unread_.substr(0, end);
        unread_.erase(0, end + 2);
        if (found.starts_with(begin)) return found;
        continue;
      }
      pollfd wait{.fd = socket_.get(), .events = POLLIN, .revents = 0};
      char text[512];
      const ssize_t size =
          ::poll(&wait, 1, time_limit_ms) == 1 ? ::recv(socket_.get(), text, sizeof text, 0) : 0;
      if (size <= 0) return "(nothing)";
      unread_.append(text, static_cast<std::size_t>(size));
    }
  }
  /// Closes the sending direction; the client still receives.
  void end() { ::shutdown(socket_.get(), SHUT_WR); }
  std::string ask(const std::string& command) {
    const std::string number = "[" + std::to_string(++sequence_) + "]";
    say(number + " " + command + "\r\n");
    const std::string answer = line(number);
    return answer.starts_with(number) ? answer.substr(number.size() + 1) : answer;
  }

 private:
  FileDescriptor socket_;
  bool good_ = false;
  std::string unread_;
  int sequence_ = 0;
};

TEST(Gateway, AnswersALiveClientOnAUnixSocket) {
  Folder folder;
  const std::string path = folder.path() / "gateway";
  DaemonProcess daemon{slow_network(folder.path()), {"--bus", "sim", "--gateway", "unix:" + path}};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  Client client{path};
  ASSERT_TRUE(client.good());
  EXPECT_EQ(client.ask("1 r 0x1018 1 x32"), "0x0000ABCD");
  EXPECT_EQ(client.ask("1 1 r 0x1000 0 u32"), "131474");
  EXPECT_EQ(client.ask("set node 10"), "OK");
  EXPECT_EQ(client.ask("w 0x6200 1 u8 200"), "OK");
  EXPECT_EQ(client.ask("r 0x5000 0 u8"),
            "ERROR: 0x06020000 (object does not exist in the dictionary)");
  EXPECT_TRUE(client.ask("1 r p 1").starts_with("1 pdo 2 ")) << "statusword and position";
  EXPECT_EQ(client.ask("lss_ident_nonconf"), "ERROR: 103 (time-out)");

  Client other{path};
  EXPECT_EQ(other.ask("r 0x1000 0 u32"), "ERROR: 105 (no default node set)");
  EXPECT_EQ(client.ask("10 preop"), "OK");
  EXPECT_EQ(other.line("1 10 "), "1 10 USER STATE PREO");
  EXPECT_EQ(client.ask("10 reset node"), "OK");
  EXPECT_EQ(other.line("1 10 USER BOOT"), "1 10 USER BOOT OK");
}

TEST(Gateway, AnswersALiveClientOverTcpOnLoopback) {
  Folder folder;
  DaemonProcess daemon{slow_network(folder.path()), {"--bus", "sim", "--gateway", "tcp:0"}};
  ASSERT_TRUE(daemon.says("CiA 309-3 gateway on tcp:"));
  const std::string log = daemon.log();
  const std::string words = "CiA 309-3 gateway on tcp:";
  const std::string where = log.substr(log.find(words) + words.size());
  const std::size_t colon = where.substr(0, where.find_first_of(" \n")).rfind(':');
  const int port = std::stoi(colon == std::string::npos ? where : where.substr(colon + 1));
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  Client client{static_cast<std::uint16_t>(port)};
  ASSERT_TRUE(client.good()) << where;
  EXPECT_EQ(client.ask("1 r 0x1018 1 x32"), "0x0000ABCD");
  EXPECT_EQ(client.ask("10 w 0x6200 1 u8 3"), "OK");
  EXPECT_EQ(client.ask("10 r 0x6200 1 u8"), "3");
  EXPECT_EQ(client.ask("10 preop"), "OK");
  EXPECT_EQ(client.line("1 10 "), "1 10 USER STATE PREO");
}

TEST(Gateway, AnswersAClientThatSaysNoMore) {
  Folder folder;
  const std::string path = folder.path() / "gateway";
  DaemonProcess daemon{slow_network(folder.path()), {"--bus", "sim", "--gateway", "unix:" + path}};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  Client client{path};
  client.say("[1] 1 r 0x1018 1 u32\n");
  client.end();

  EXPECT_EQ(client.line("[1]"), "[1] 43981");
  EXPECT_EQ(client.line("["), "(nothing)");
}

TEST(Gateway, OutlivesClientsThatMisbehave) {
  Folder folder;
  const std::string path = folder.path() / "gateway";
  DaemonProcess daemon{slow_network(folder.path()), {"--bus", "sim", "--gateway", "unix:" + path}};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  Client client{path};
  client.say("[6] 1 r 0x1000 0 u32\n");
  EXPECT_EQ(client.line("[6]"), "[6] 131474");
  client.say(std::string(100'000, 'x'));
  EXPECT_EQ(client.line("[0]"), "[0] ERROR: 101 (syntax error: the line is too long)");
  client.say("\n[7] 1 r 0x1000 0 u32");
  {
    Client gone{path};
    gone.say("[1] 1 r 0x1000 0 u32\n");
  }
  client.say("\n");
  EXPECT_EQ(client.line("[7]"), "[7] 131474");
  const std::int64_t cycle = daemon.bus().cycle();
  EXPECT_TRUE(daemon.hear([&] { return daemon.bus().cycle() >= cycle + 20; }));
}

TEST(Gateway, IsRefusedWhereItCannotListen) {
  Folder folder;
  DaemonProcess daemon{slow_network(folder.path()), {"--bus", "sim", "--gateway", "tcp:99999"}};
  EXPECT_EQ(daemon.wait(), 2);
  EXPECT_TRUE(daemon.says("a port is 0..65535"));
}

}  // namespace
}  // namespace takt::test
