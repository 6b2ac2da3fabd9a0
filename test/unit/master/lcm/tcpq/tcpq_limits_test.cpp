#include <algorithm>
#include <chrono>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <string>
#include <sys/socket.h>
#include <vector>

#include "master/lcm/tcpq/tcpq_broker.hpp"
#include "master/lcm/tcpq/tcpq_parser.hpp"
#include "test/support/no_descriptor_left.hpp"
#include "test/support/step_clock.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using Octets = std::vector<std::byte>;

const MessageHandler ignore = [](std::string_view, std::span<const std::byte>) {};

/// A client that uses tcpq with hand-made bytes.
class Peer {
 public:
  explicit Peer(std::uint16_t port) : socket_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  Peer& open() {
    Octets bytes;
    tcpq::append_opening(bytes, tcpq::magic_client);
    send(bytes);
    return *this;
  }
  void subscribe(std::string_view pattern) {
    Octets bytes;
    tcpq::append(bytes, {.type = tcpq::Type::subscribe, .channel = pattern, .data = {}});
    send(bytes);
  }
  void publish(std::string_view channel, int times = 1) {
    Octets bytes;
    for (int i = 0; i < times; ++i) {
      tcpq::append(bytes, {.type = tcpq::Type::publish, .channel = channel, .data = {}});
    }
    send(bytes);
  }
  void send(std::span<const std::byte> bytes) {
    static_cast<void>(::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL));
  }
  /// Returns the number of messages received so far.
  std::size_t heard() {
    std::byte chunk[4096];
    for (ssize_t size = 1; size > 0;) {
      size = ::recv(socket_.get(), chunk, sizeof chunk, MSG_DONTWAIT);
      if (size > 0) parser_.feed({chunk, static_cast<std::size_t>(size)});
      while (parser_.next()) ++heard_;
    }
    return heard_;
  }

 private:
  FileDescriptor socket_;
  tcpq::Parser parser_{tcpq::magic_server};
  std::size_t heard_ = 0;
};

class TcpqLimits : public testing::Test {
 protected:
  std::unique_ptr<TcpqBroker> make(Time step) {
    clock = test::StepClock{step};
    return TcpqBroker::listen(0, {.clock = clock,
                                  .say = [this](const std::string& s) { reported.push_back(s); },
                                  .warn = [this](const std::string& s) { warnings.push_back(s); }})
        .value();
  }
  /// Serves until `done` returns true. On loopback, data arrives at once or a moment later.
  template <class F>
  bool serve_until(TcpqBroker& broker, F done) {
    for (int rounds = 0; rounds < 6000; ++rounds) {
      broker.serve(ignore);
      if (done()) return true;
      std::vector<pollfd> descriptors;
      broker.watch(descriptors);
      ::poll(descriptors.data(), descriptors.size(), 5);
    }
    return false;
  }

  test::StepClock clock{0us};
  std::vector<std::string> reported;
  std::vector<std::string> warnings;
};

TEST_F(TcpqLimits, AFloodOfMessagesEndsTheRoundWithItsBudgetAndLosesNothing) {
  auto broker = make(10us);
  Peer peer{broker->port()};
  peer.open().publish("FLOOD", 1000);
  broker->subscribe("FLOOD");
  std::size_t heard = 0;
  std::size_t most = 0;
  bool some_left = false;
  const MessageHandler count = [&](std::string_view, std::span<const std::byte>) { ++heard; };

  for (int rounds = 0; rounds < 6000 && heard < 1000; ++rounds) {
    const std::size_t before = heard;
    broker->serve(count);
    most = std::max(most, heard - before);
    some_left |= !broker->drained();
    std::vector<pollfd> descriptors;
    broker->watch(descriptors);
    ::poll(descriptors.data(), descriptors.size(), 5);
  }

  EXPECT_EQ(heard, 1000U);
  EXPECT_LE(most, 51U) << "500 us at 10 us a message";
  EXPECT_TRUE(some_left);
  broker->serve(count);
  EXPECT_TRUE(broker->drained());
}

TEST_F(TcpqLimits, AFloodDoesNotStarveTheOtherConnections) {
  auto broker = make(100us);
  Peer flood{broker->port()};
  flood.open().publish("FLOOD", 1000);
  Peer quiet{broker->port()};
  quiet.open().publish("QUIET");
  broker->subscribe(".*");
  int before = 0;
  bool quiet_came = false;
  const MessageHandler listen = [&](std::string_view channel, std::span<const std::byte>) {
    quiet_came = quiet_came || channel == "QUIET";
    if (!quiet_came) ++before;
  };

  for (int rounds = 0; rounds < 6000 && !quiet_came; ++rounds) broker->serve(listen);

  EXPECT_TRUE(quiet_came);
  EXPECT_LT(before, 1000) << "the flood was heard first as a whole";
}

TEST_F(TcpqLimits, WaitingMessagesEndTheWaitOfTheNextRound) {
  auto broker = make(100us);
  Peer peer{broker->port()};
  peer.open().publish("FLOOD", 100);
  bool seen = false;
  broker->subscribe(".*");
  const MessageHandler listen = [&](std::string_view, std::span<const std::byte>) { seen = true; };
  for (int rounds = 0; rounds < 6000 && !seen; ++rounds) broker->serve(listen);
  ASSERT_TRUE(seen);

  std::vector<pollfd> descriptors;
  broker->watch(descriptors);

  EXPECT_GT(::poll(descriptors.data(), descriptors.size(), 30'000), 0);
}

TEST_F(TcpqLimits, HundredElevenKilobytesOfEvilPatternsEndTheirConnectionAndNothingElse) {
  auto broker = make(1us);
  Peer evil{broker->port()};
  evil.open();
  const std::string pattern = "((a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*)*b";
  for (std::size_t sent = 0; sent < 111'000; sent += pattern.size()) evil.subscribe(pattern);

  EXPECT_TRUE(serve_until(*broker, [&] { return !reported.empty() && broker->clients() == 0; }));

  EXPECT_EQ(reported, (std::vector<std::string>{
                          "LCM hub: a connection was closed: its pattern "
                          "'((a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|' is refused: the patterns "
                          "together have more than 8192 characters"}));
}

TEST_F(TcpqLimits, PatternsThatAreRefusedCloseTheConnectionWithASentence) {
  auto broker = make(1us);
  Peer peer{broker->port()};
  peer.open().subscribe("(a)\x1B\\1");

  EXPECT_TRUE(serve_until(*broker, [&] { return !reported.empty(); }));

  EXPECT_EQ(broker->clients(), 0U);
  EXPECT_EQ(reported, (std::vector<std::string>{"LCM hub: a connection was closed: its pattern "
                                                "'(a)?\\1' is refused: '\\1' is not supported"}));
}

TEST_F(TcpqLimits, PatternsOfAllConnectionsTogetherAreBounded) {
  auto broker = make(0us);
  std::vector<Peer> peers;
  for (int i = 0; i < 5; ++i) {
    peers.emplace_back(broker->port()).open();
    for (int k = 0; k < 60; ++k) peers.back().subscribe(std::string(128, 'a'));
    const std::string last = "LAST_" + std::to_string(i);
    peers.back().subscribe(last);
    ASSERT_TRUE(serve_until(*broker, [&] { return broker->wanted(last) || !reported.empty(); }));
  }

  EXPECT_EQ(broker->clients(), 4U);
  EXPECT_NE(reported[0].find("of all connections together have more than 32768"),
            std::string::npos);
}

TEST_F(TcpqLimits, AnOpeningThatIsIncompleteAfterTwoSecondsIsClosed) {
  auto broker = make(0us);
  Peer silent{broker->port()};
  Peer half{broker->port()};
  const Octets three{std::byte{0x28}, std::byte{0x76}, std::byte{0x17}};
  half.send(three);
  Peer whole{broker->port()};
  whole.open().subscribe("A");
  ASSERT_TRUE(serve_until(*broker, [&] { return broker->wanted("A"); }));
  ASSERT_EQ(broker->clients(), 3U);

  clock.pass(1999ms);
  broker->serve(ignore);
  EXPECT_EQ(broker->clients(), 3U);
  clock.pass(1ms);
  broker->serve(ignore);

  EXPECT_EQ(broker->clients(), 1U);
  EXPECT_TRUE(broker->wanted("A"));
  EXPECT_EQ(reported, (std::vector<std::string>{"LCM hub: a connection was closed: its handshake "
                                                "was incomplete after 2 s"}));
}

TEST_F(TcpqLimits, SixtyFourSilentConnectionsLockNobodyOut) {
  auto broker = make(0us);
  std::vector<Peer> silent;
  for (int i = 0; i < 64; ++i) {
    silent.emplace_back(broker->port());
    if (i % 2 == 0) silent.back().open();
    broker->serve(ignore);
  }
  ASSERT_TRUE(serve_until(*broker, [&] { return broker->clients() == 64; }));

  Peer late{broker->port()};
  late.open().subscribe("LATE");

  EXPECT_TRUE(serve_until(*broker, [&] { return broker->wanted("LATE"); }));
  EXPECT_EQ(broker->clients(), 64U);
}

/// A broker with the maximum number of connections; all have subscribed.
class FullHouse : public TcpqLimits {
 protected:
  FullHouse() : broker{make(0us)} {
    for (int i = 0; i < 64; ++i) {
      peers.emplace_back(broker->port()).open().subscribe(name(i));
      EXPECT_TRUE(serve_until(*broker, [&] { return broker->wanted(name(i)); }));
    }
  }
  static std::string name(int i) { return "WORK_" + std::to_string(i); }
  void publish(int i) {
    heard.clear();
    broker->subscribe("COMMAND");
    peers[static_cast<std::size_t>(i)].publish("COMMAND");
    const MessageHandler listen = [&](std::string_view channel, std::span<const std::byte>) {
      heard = channel;
    };
    for (int rounds = 0; rounds < 6000 && heard.empty(); ++rounds) broker->serve(listen);
    EXPECT_EQ(heard, "COMMAND");
  }
  bool gets_in(const std::string& channel) {
    peers.emplace_back(broker->port()).open().subscribe(channel);
    reported.clear();
    return serve_until(*broker, [&] { return broker->wanted(channel) || !reported.empty(); }) &&
           serve_until(*broker,
                       [&] {
                         return broker->wanted(channel) ||
                                reported.back().find("refused") != std::string::npos;
                       }) &&
           broker->wanted(channel);
  }

  std::unique_ptr<TcpqBroker> broker;
  std::vector<Peer> peers;
  std::string heard;
};

TEST_F(FullHouse, KeepsWhoHasSentSomethingWithinTenSeconds) {
  clock.pass(9999ms);
  EXPECT_FALSE(gets_in("LATE"));
  EXPECT_EQ(reported,
            (std::vector<std::string>{
                "LCM hub: a new connection was refused: the hub has 64 connections already"}));
  for (int i = 0; i < 64; ++i) EXPECT_TRUE(broker->wanted(name(i)));
}

TEST_F(FullHouse, GivesThePlaceOfTheOneThatSentNothingForTheLongestTime) {
  clock.pass(4s);
  publish(0);
  clock.pass(6s);
  EXPECT_TRUE(gets_in("LATE"));
  EXPECT_TRUE(broker->wanted(name(0)));
  EXPECT_FALSE(broker->wanted(name(1)));
  EXPECT_EQ(broker->clients(), 64U);
}

TEST_F(FullHouse, NeverGivesThePlaceOfAProgramThatCommands) {
  for (int i = 0; i < 30; ++i) {
    clock.pass(5s);
    publish(0);
    gets_in("LATE_" + std::to_string(i));
  }
  EXPECT_TRUE(broker->wanted(name(0)));
}

TEST_F(FullHouse, GivesOnePlaceInASecond) {
  clock.pass(10s);
  EXPECT_TRUE(gets_in("FIRST"));
  EXPECT_FALSE(gets_in("SECOND"));
  clock.pass(1s);
  EXPECT_TRUE(gets_in("THIRD"));
}

TEST_F(TcpqLimits, AConnectionThatReadsNothingForTenSecondsIsClosed) {
  auto broker = make(0us);
  Peer deaf{broker->port()};
  deaf.open().subscribe("IMAGE");
  Peer reader{broker->port()};
  reader.open().subscribe("SMALL");
  ASSERT_TRUE(
      serve_until(*broker, [&] { return broker->wanted("IMAGE") && broker->wanted("SMALL"); }));
  const Octets large(100'000);
  for (int i = 0; i < 200; ++i) broker->publish("IMAGE", large);
  broker->publish("SMALL", {});
  broker->serve(ignore);

  clock.pass(9s);
  broker->serve(ignore);
  EXPECT_EQ(broker->clients(), 2U);
  clock.pass(2s);
  broker->serve(ignore);

  EXPECT_EQ(broker->clients(), 1U);
  EXPECT_TRUE(broker->wanted("SMALL"));
  EXPECT_EQ(
      reported,
      (std::vector<std::string>{"LCM hub: a connection was closed: it has read nothing for 10 s"}));
}

TEST_F(TcpqLimits, OneByteAtATimeIsReadLikeAnythingElse) {
  auto broker = make(1us);
  Peer peer{broker->port()};
  Octets bytes;
  tcpq::append_opening(bytes, tcpq::magic_client);
  tcpq::append(bytes, {.type = tcpq::Type::subscribe, .channel = "SLOW", .data = {}});
  for (const std::byte& byte : bytes) {
    EXPECT_FALSE(broker->wanted("SLOW"));
    peer.send({&byte, 1});
    std::vector<pollfd> descriptors;
    broker->watch(descriptors);
    ::poll(descriptors.data(), descriptors.size(), 30'000);
    broker->serve(ignore);
  }

  EXPECT_TRUE(serve_until(*broker, [&] { return broker->wanted("SLOW"); }));
}

TEST_F(TcpqLimits, AChannelNameThatLcmDoesNotHaveEndsTheConnection) {
  auto broker = make(1us);
  Peer peer{broker->port()};
  peer.open().publish(std::string(64, 'x'));

  EXPECT_TRUE(serve_until(*broker, [&] { return !reported.empty() && broker->clients() == 0; }));
}

TEST_F(TcpqLimits, WithoutADescriptorLeftTheWaitingConnectionDoesNotWakeTheHubForAWhile) {
  const auto broker = make(50us);
  const auto watched = [&] {
    std::vector<pollfd> descriptors;
    broker->watch(descriptors);
    return descriptors.size();
  };
  Peer waiting{broker->port()};
  {
    const test::NoDescriptorLeft none;
    while (watched() == 1) broker->serve(ignore);  // until the connection has come
    for (int i = 0; i < 50; ++i) {                 // 5 s
      clock.pass(AcceptPause::length);
      EXPECT_EQ(watched(), 1U);
      broker->serve(ignore);
      EXPECT_EQ(watched(), 0U);
    }
    EXPECT_EQ(warnings.size(), 1U);
    clock.pass(AcceptPause::sentence_pause);
    broker->serve(ignore);
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_TRUE(warnings[0].starts_with("LCM hub: new connections wait: Too many open files"))
        << warnings[0];
  }

  clock.pass(AcceptPause::length);
  waiting.open();
  EXPECT_TRUE(serve_until(*broker, [&] { return broker->clients() == 1; }));
}

}  // namespace
}  // namespace takt
