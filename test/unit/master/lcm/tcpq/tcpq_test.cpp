#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <initializer_list>
#include <netinet/in.h>
#include <poll.h>
#include <string>
#include <sys/socket.h>
#include <vector>

#include "master/lcm/tcpq/tcpq_broker.hpp"
#include "master/lcm/tcpq/tcpq_client.hpp"
#include "master/lcm/tcpq/tcpq_parser.hpp"

namespace takt {
namespace {

using Octets = std::vector<std::byte>;

Octets octets(std::initializer_list<int> values) {
  Octets bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

// The bytes that LCM's own client sends: magic 287617FB, version 0100, subscribe "AB", publish "C"
// 1 byte.
const Octets opening = octets({0x28, 0x76, 0x17, 0xFB, 0, 0, 1, 0});
const Octets subscribe_ab = octets({0, 0, 0, 2, 0, 0, 0, 2, 'A', 'B'});
const Octets publish_c = octets({0, 0, 0, 1, 0, 0, 0, 1, 'C', 0, 0, 0, 1, 0x55});

TEST(TcpqParser, ReadsWhatTheClientOfLcmSends) {
  tcpq::Parser parser{tcpq::magic_client};
  parser.feed(opening);
  parser.feed(subscribe_ab);
  parser.feed(publish_c);

  const auto first = parser.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->type, tcpq::Type::subscribe);
  EXPECT_EQ(first->channel, "AB");
  const auto second = parser.next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->type, tcpq::Type::publish);
  EXPECT_EQ(second->channel, "C");
  ASSERT_EQ(second->data.size(), 1U);
  EXPECT_EQ(second->data[0], std::byte{0x55});
  EXPECT_FALSE(parser.next());
  EXPECT_FALSE(parser.broken());
}

TEST(TcpqParser, PutsTogetherWhatComesByteByByte) {
  tcpq::Parser parser{tcpq::magic_client};
  Octets all = opening;
  all.insert(all.end(), publish_c.begin(), publish_c.end());

  int messages = 0;
  for (const std::byte byte : all) {
    parser.feed({&byte, 1});
    while (parser.next()) ++messages;
  }

  EXPECT_EQ(messages, 1);
}

TEST(TcpqParser, WritesWhatTheClientOfLcmReads) {
  Octets out;
  tcpq::append_opening(out, tcpq::magic_server);
  EXPECT_EQ(out, octets({0x28, 0x76, 0x17, 0xFA, 0, 0, 1, 0}));

  out.clear();
  const Octets data = octets({0x55});
  tcpq::append(out, {.type = tcpq::Type::publish, .channel = "C", .data = data});
  EXPECT_EQ(out, publish_c);
}

TEST(TcpqParser, RefusesOtherProtocolsAndHugeSizes) {
  tcpq::Parser http{tcpq::magic_client};
  http.feed(octets({'G', 'E', 'T', ' ', '/', ' ', 'H', 'T'}));
  EXPECT_FALSE(http.next());
  EXPECT_TRUE(http.broken());

  tcpq::Parser channel{tcpq::magic_client};
  channel.feed(opening);
  channel.feed(octets({0, 0, 0, 2, 0xFF, 0xFF, 0xFF, 0xFF}));
  EXPECT_FALSE(channel.next());
  EXPECT_TRUE(channel.broken());

  tcpq::Parser data{tcpq::magic_client};
  data.feed(opening);
  data.feed(octets({0, 0, 0, 1, 0, 0, 0, 1, 'C', 0x7F, 0xFF, 0xFF, 0xFF}));
  EXPECT_FALSE(data.next());
  EXPECT_TRUE(data.broken());
}

// Serves all ends until `done` returns true, at most as long as bytes can still be in transit.
template <class F>
bool serve_until(std::vector<Transport*> ends, const MessageHandler& handler, F done) {
  for (int rounds = 0; rounds < 2000; ++rounds) {
    for (Transport* end : ends) end->serve(handler);
    if (done()) return true;
    std::vector<pollfd> descriptors;
    for (Transport* end : ends) end->watch(descriptors);
    ::poll(descriptors.data(), descriptors.size(), 5);
  }
  return false;
}

TEST(TcpqBroker, CarriesMessagesFromItsOwnerToClientsAndBack) {
  auto broker = TcpqBroker::listen(0).value();
  broker->subscribe("UP");
  TcpqClient client{"127.0.0.1", broker->port()};
  client.subscribe("DOWN.*");
  std::vector<std::string> heard;
  const MessageHandler handler = [&](std::string_view channel, std::span<const std::byte> data) {
    heard.push_back(std::string{channel} + ":" + std::to_string(data.size()));
  };
  ASSERT_TRUE(serve_until({broker.get(), &client}, handler, [&] { return client.connected(); }));

  const Octets three(3);
  client.publish("UP", three);
  client.publish("ELSEWHERE", three);
  ASSERT_TRUE(serve_until({broker.get(), &client}, handler, [&] { return !heard.empty(); }));
  broker->publish("OTHER", three);
  broker->publish("DOWN_1", three);
  ASSERT_TRUE(serve_until({broker.get(), &client}, handler, [&] { return heard.size() >= 2; }));

  EXPECT_EQ(heard, (std::vector<std::string>{"UP:3", "DOWN_1:3"}));
}

/// A server that listens and answers only when the test calls it.
class SlowServer {
 public:
  SlowServer() : listener_{::socket(AF_INET, SOCK_STREAM, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(listener_.get(), generic, size), 0);
    EXPECT_EQ(::listen(listener_.get(), 1), 0);
    EXPECT_EQ(::getsockname(listener_.get(), generic, &size), 0);
    port_ = ntohs(address.sin_port);
  }
  std::uint16_t port() const { return port_; }
  void answer() {
    client_ = FileDescriptor{::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK)};
    const Octets magic = octets({0x28, 0x76, 0x17, 0xFA, 0, 0, 1, 0});
    EXPECT_EQ(::send(client_.get(), magic.data(), magic.size(), 0), 8);
  }
  /// Returns the messages received so far as "subscribe AB" or "publish C".
  const std::vector<std::string>& heard() {
    std::byte chunk[4096];
    const ssize_t size = ::recv(client_.get(), chunk, sizeof chunk, MSG_DONTWAIT);
    if (size > 0) parser_.feed({chunk, static_cast<std::size_t>(size)});
    while (const auto message = parser_.next()) {
      const bool publish = message->type == tcpq::Type::publish;
      heard_.push_back((publish ? "publish " : "subscribe ") + std::string{message->channel});
    }
    return heard_;
  }

 private:
  FileDescriptor listener_;
  FileDescriptor client_;
  std::uint16_t port_ = 0;
  tcpq::Parser parser_{tcpq::magic_client};
  std::vector<std::string> heard_;
};

TEST(TcpqClient, KeepsItsSubscriptionsAndNoOldMessagesForAServerThatAnswersLate) {
  SlowServer server;
  TcpqClient client{"127.0.0.1", server.port()};
  client.subscribe("DOWN");
  const Octets data(3);
  const MessageHandler ignore = [](std::string_view, std::span<const std::byte>) {};
  client.serve(ignore);

  EXPECT_FALSE(client.publish("OLD", data));
  server.answer();
  ASSERT_TRUE(serve_until({&client}, ignore, [&] { return client.connected(); }));
  EXPECT_TRUE(client.publish("NEW", data));

  ASSERT_TRUE(serve_until({&client}, ignore, [&] { return server.heard().size() >= 2; }));
  EXPECT_EQ(server.heard(), (std::vector<std::string>{"subscribe DOWN", "publish NEW"}));
}

TEST(TcpqBroker, KnowsWhatItsClientsWant) {
  auto broker = TcpqBroker::listen(0).value();
  EXPECT_FALSE(broker->wanted("DOWN_1"));
  TcpqClient client{"127.0.0.1", broker->port()};
  client.subscribe("DOWN_.");
  const MessageHandler ignore = [](std::string_view, std::span<const std::byte>) {};

  EXPECT_TRUE(
      serve_until({broker.get(), &client}, ignore, [&] { return broker->wanted("DOWN_1"); }));
  EXPECT_FALSE(broker->wanted("DOWN_10"));
}

TEST(TcpqBroker, RelaysBetweenClients) {
  auto broker = TcpqBroker::listen(0).value();
  TcpqClient one{"127.0.0.1", broker->port()};
  TcpqClient two{"127.0.0.1", broker->port()};
  two.subscribe("X");
  int heard = 0;
  const MessageHandler handler = [&](std::string_view, std::span<const std::byte>) { ++heard; };
  ASSERT_TRUE(serve_until({broker.get(), &one, &two}, handler,
                          [&] { return one.connected() && two.connected(); }));

  // The subscription of `two` is in transit, so repeat until it takes effect.
  EXPECT_TRUE(serve_until({broker.get(), &one, &two}, handler, [&] {
    one.publish("X", Octets(1));
    return heard > 0;
  }));
}

TEST(TcpqBroker, AClientThatNeverReadsCostsBoundedMemoryAndNothingElse) {
  auto broker = TcpqBroker::listen(0).value();
  TcpqClient stuck{"127.0.0.1", broker->port()};
  stuck.subscribe(".*");
  TcpqClient reader{"127.0.0.1", broker->port()};
  reader.subscribe("LAST");
  const MessageHandler ignore = [](std::string_view, std::span<const std::byte>) {};
  ASSERT_TRUE(serve_until({broker.get(), &stuck, &reader}, ignore,
                          [&] { return stuck.connected() && reader.connected(); }));
  serve_until({broker.get()}, ignore, [n = 0]() mutable { return ++n == 5; });

  const Octets large(1000);
  for (int i = 0; i < 20000; ++i) broker->publish("FLOOD", large);

  int heard = 0;
  const MessageHandler count = [&](std::string_view, std::span<const std::byte>) { ++heard; };
  EXPECT_TRUE(serve_until({broker.get(), &reader}, count, [&] {
    broker->publish("LAST", large);
    return heard > 0;
  }));
}

TEST(TcpqBroker, GarbageEndsOnlyItsOwnConnection) {
  auto broker = TcpqBroker::listen(0).value();
  FileDescriptor socket{::socket(AF_INET, SOCK_STREAM, 0)};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(broker->port());
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const std::string garbage(5000, '\xEE');
  ASSERT_GT(::send(socket.get(), garbage.data(), garbage.size(), MSG_NOSIGNAL), 0);

  const MessageHandler ignore = [](std::string_view, std::span<const std::byte>) {};
  bool seen = false;
  EXPECT_TRUE(serve_until({broker.get()}, ignore, [&] {
    seen = seen || broker->clients() == 1;
    return broker->clients() == 0;
  }));
}

}  // namespace
}  // namespace takt
