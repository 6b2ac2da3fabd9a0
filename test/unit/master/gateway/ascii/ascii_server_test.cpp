// Clients of the text gateway and their lines.
#include <chrono>

#include "test/unit/master/gateway/ascii/ascii_server_fixture.hpp"

namespace takt {
namespace {

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
  write(client, "[1] help\n");
  serve();
  lines.clear();
  write(client, std::string(AsciiServer::longest_line + 1, 'x'));
  serve();
  EXPECT_EQ(too_long, 1);
  write(client, std::string(3 * AsciiServer::longest_line, 'y') + "\n[1] help\n");
  while (lines.empty()) serve();
  EXPECT_EQ(lines, (std::vector<std::string>{"[1] help"}));
  EXPECT_EQ(too_long, 1);
}

TEST_F(AsciiServerTest, ReportsThatAClientHasGone) {
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
  awaits_reply = true;
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
  awaits_reply = false;
  server->serve();

  EXPECT_EQ(gone, connected);
  EXPECT_EQ(read(client), "[1] 43981\r\n");
  EXPECT_EQ(read(client), "");
}

TEST_F(AsciiServerTest, KeepsNobodyWhoReadsNoMoreEither) {
  listen();
  awaits_reply = true;
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
  for (int i = 0; i < 8; ++i) {
    clients.push_back(connect());
    write(clients.back(), "[1] help\n");
    while (lines.size() < clients.size()) serve();
  }
  clients.push_back(connect());
  EXPECT_EQ(connected.size(), AsciiServer::most_clients);
  EXPECT_TRUE(gone.empty());
  EXPECT_EQ(read(clients.back()), "");  // closed
}

TEST_F(AsciiServerTest, EightSilentClientsLockNobodyOut) {
  listen();
  std::vector<FileDescriptor> silent;
  for (int i = 0; i < 8; ++i) silent.push_back(connect());

  const FileDescriptor late = connect();
  write(late, "[1] help\n");
  while (lines.empty()) serve();

  EXPECT_EQ(gone, (std::vector<int>{connected[0]})) << "the oldest made room";
  EXPECT_EQ(lines, (std::vector<std::string>{"[1] help"}));
}

TEST_F(AsciiServerTest, ClosesAClientThatGivesNoCommandWithinTwoSeconds) {
  listen();
  const FileDescriptor silent = connect();
  const FileDescriptor half = connect();
  write(half, "# a comment\n[1] he");
  const FileDescriptor whole = connect();
  write(whole, "[1] help\n");
  while (lines.size() < 2) serve();

  clock.pass(std::chrono::milliseconds{1900});
  server->serve();
  EXPECT_TRUE(gone.empty());
  clock.pass(std::chrono::milliseconds{100});
  server->serve();

  EXPECT_EQ(gone, (std::vector<int>{connected[0], connected[1]}));
  EXPECT_EQ(read(silent),
            "[0] ERROR: 101 (no command came within 2 s, such as '[1] help'; the connection is "
            "closed)\r\n");
}

TEST_F(AsciiServerTest, ReadsWhatWaitedBeforeItCountsAsSilent) {
  listen();
  const FileDescriptor client = connect();
  write(client, "[1] help\n");
  clock.pass(std::chrono::seconds{10});  // the server did not run in this time
  while (lines.empty()) serve();
  server->serve();
  EXPECT_TRUE(gone.empty());
}

TEST_F(AsciiServerTest, ClosesWhoeverSpeaksAnotherProtocolBeforeAnyCommandOfIt) {
  listen();
  const std::vector<std::string> foreign{
      "POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n[1] 1 w 0x6040 0 u16 15\n",
      std::string{"\x16\x03\x01\x02", 4},              // the hello of TLS
      "GET",                                           // not even a whole line
      "[1] 1 please move\n[2] 1 w 0x6040 0 u16 15\n",  // not a command
      std::string(AsciiServer::longest_line + 1, '[') + "\n[2] help\n",
  };
  for (const std::string& text : foreign) {
    const FileDescriptor client = connect();
    write(client, text);
    const std::size_t before = gone.size();
    while (gone.size() == before) serve();
    EXPECT_EQ(read(client),
              "[0] ERROR: 101 (syntax error: the first line is no command of CiA 309-3, such as "
              "'[1] help'; the connection is closed)\r\n");
  }
  EXPECT_EQ(lines, (std::vector<std::string>{}));
  EXPECT_EQ(too_long, 0);
}

TEST_F(AsciiServerTest, TakesACommandThatFollowsEmptyLinesAndComments) {
  listen();
  const FileDescriptor client = connect();
  write(client, "# hello\r\n\r\n  [1] 1 r 0x1018 9 u99\nwhat?\n");
  while (lines.size() < 4) serve();
  EXPECT_TRUE(gone.empty())
      << "a command that isn't supported is one, and later lines are answered";
}

TEST_F(AsciiServerTest, AFloodOfLinesEndsTheRoundWithItsBudgetAndLosesNothing) {
  listen();
  const FileDescriptor flood = connect();
  std::string text;
  for (int i = 0; i < 400; ++i) text += "[1] help\n";
  write(flood, text);
  const FileDescriptor quiet = connect();
  write(quiet, "[2] help\n");

  std::size_t most = 0;
  while (lines.size() < 401) {
    const std::size_t before = lines.size();
    serve();
    most = std::max(most, lines.size() - before);
  }

  EXPECT_LE(most, 6U) << "250 us at 50 us a line";
  EXPECT_LT(std::ranges::find(lines, "[2] help") - lines.begin(), 20);
}

TEST_F(AsciiServerTest, LinesThatHaveBegunToArriveBeforeNobodyServedAreOldOnes) {
  listen();
  const FileDescriptor socket = connect();
  write(socket, "[1] help\n[2] 5 r");
  serve();
  ASSERT_EQ(lines, std::vector<std::string>{"[1] help"});
  write(socket, " 0x1000 0 u32\n[3] 5 start\n[4] 5 st");
  const FileDescriptor late{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  const auto address = unix_address(path_);
  ASSERT_EQ(::connect(late.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address),
            0);
  write(late, "[1] 5 stop\n");

  server->mark_waiting(std::chrono::milliseconds{200});
  serve();
  write(socket, "op\n[5] 5 start\n");
  serve();
  write(late, "[2] 5 start\n");
  serve();

  EXPECT_EQ(old_lines, (std::vector<std::string>{"[2] 5 r 0x1000 0 u32", "[3] 5 start",
                                                 "[1] 5 stop", "[4] 5 stop"}));
  EXPECT_EQ(lines, (std::vector<std::string>{"[1] help", "[5] 5 start", "[2] 5 start"}));
}

TEST_F(AsciiServerTest, AShortGapDoesNotHideALongOneThatALineHasWaitedThrough) {
  constexpr Time long_gap = std::chrono::seconds{2};
  constexpr Time short_gap = std::chrono::milliseconds{200};
  listen();
  const FileDescriptor client = connect();
  write(client, "[1] 5 start\n");
  server->mark_waiting(long_gap);
  server->mark_waiting(short_gap);
  serve();
  write(client, "[2] 5 start\n");
  server->mark_waiting(short_gap);
  serve();

  EXPECT_EQ(old_lines, (std::vector<std::string>{"[1] 5 start", "[2] 5 start"}));
  EXPECT_EQ(gaps, (std::vector<Time>{long_gap, short_gap}));
}

}  // namespace
}  // namespace takt
