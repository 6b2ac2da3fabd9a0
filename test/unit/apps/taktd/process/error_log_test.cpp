#include "apps/taktd/process/error_log.hpp"

#include <array>
#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "apps/taktd/process/open_again.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// Both ends of a pipe.
struct Pipe {
  FileDescriptor reader;
  FileDescriptor writer;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  return {FileDescriptor{ends[0]}, FileDescriptor{ends[1]}};
}

std::string read_until(const FileDescriptor& pipe, const std::string& end) {
  std::string text;
  std::array<char, 4096> chunk;
  while (text.find(end) == std::string::npos) {
    const ssize_t size = ::read(pipe.get(), chunk.data(), chunk.size());
    if (size <= 0) break;
    text.append(chunk.data(), static_cast<std::size_t>(size));
  }
  return text;
}

TEST(ErrorLog, SaysEachSentenceWithTheTimeOfDayAndItsWeight) {
  Pipe pipe = make_pipe();
  ErrorLog log{std::move(pipe.writer)};

  log.say(Weight::note, "one");
  log.say(Weight::warning, "two");
  log.say(Weight::error, "three");

  EXPECT_THAT(read_until(pipe.reader, "three\n"),
              ContainsRegex("^[0-9:]{8}\\.[0-9]{3}  info   one\n"
                            "[0-9:]{8}\\.[0-9]{3} warning two\n"
                            "[0-9:]{8}\\.[0-9]{3}  error  three\n$"));
}

TEST(ErrorLog, GivesTheJournalPrioritiesAndNoTime) {
  Pipe pipe = make_pipe();
  struct stat status{};
  ASSERT_EQ(::fstat(pipe.writer.get(), &status), 0);
  const std::string stream = std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
  ASSERT_EQ(::setenv("JOURNAL_STREAM", stream.c_str(), 1), 0);
  ErrorLog log{std::move(pipe.writer)};
  ::unsetenv("JOURNAL_STREAM");

  log.say(Weight::note, "one");
  log.say(Weight::warning, "two\n  more");
  log.say(Weight::error, "three");

  EXPECT_EQ(read_until(pipe.reader, "three\n"), "<6>one\n<4>two\n<4>  more\n<3>three\n");
}

TEST(ErrorLog, OfAnotherFileThanTheJournalHasTheTime) {
  for (const char* const stream : {"", "1:2", "x", "1", ":", "18446744073709551616:1"}) {
    Pipe pipe = make_pipe();
    ASSERT_EQ(::setenv("JOURNAL_STREAM", stream, 1), 0);
    ErrorLog log{std::move(pipe.writer)};
    ::unsetenv("JOURNAL_STREAM");

    log.say(Weight::note, "one");

    EXPECT_THAT(read_until(pipe.reader, "one\n"), HasSubstr("  info   one")) << stream;
  }
}

/// The test would hang if a writer waited, because the pipe is full long before the last message.
TEST(ErrorLog, WaitsForNobodyAndReportsHowMuchWasLost) {
  Pipe pipe = make_pipe();
  ErrorLog log{std::move(pipe.writer)};
  const std::string sentence(1000, 'x');

  for (int i = 0; i < 3000; ++i) log.say(Weight::note, sentence);
  EXPECT_FALSE(log.flush(10ms));
  std::string text = read_until(pipe.reader, "x\n");
  while (!log.flush(0ms)) text += read_until(pipe.reader, "x\n");
  log.say(Weight::note, "the end");

  text += read_until(pipe.reader, "the end\n");
  EXPECT_THAT(text, HasSubstr(" lines are lost here\n"));
}

TEST(ErrorLog, ReportsOnceThatItHasNoThreadWhenItHasOne) {
  Pipe pipe = make_pipe();
  bool possible = false;
  ErrorLog log{std::move(pipe.writer), [&](std::function<void()> body) {
                 return possible && LineWriter::start_detached(std::move(body));
               }};

  log.say(Weight::note, "one");
  log.say(Weight::note, "two");
  possible = true;
  EXPECT_TRUE(log.flush(60s));
  log.say(Weight::note, "three");

  const std::string text = read_until(pipe.reader, "three\n");
  const std::size_t reported = text.find("no thread can be created for stderr");
  EXPECT_NE(reported, std::string::npos) << text;
  EXPECT_EQ(text.find("no thread can be created", reported + 1), std::string::npos) << text;
}

TEST(ErrorLog, SaysItsSentencesWhereNoThreadCanEverBeCreated) {
  Pipe pipe = make_pipe();
  ErrorLog log{std::move(pipe.writer), [](const std::function<void()>&) { return false; }};

  log.say(Weight::error, "the bus thread can't be created");

  const std::string text = read_until(pipe.reader, "the other lines wait\n");
  EXPECT_THAT(text, HasSubstr(" error  the bus thread can't be created\n"));
  EXPECT_THAT(text, HasSubstr("no thread can be created for stderr"));
}

/// The test would hang if a writer waited.
TEST(ErrorLog, WithoutAThreadWaitsForNobodyEither) {
  Pipe pipe = make_pipe();
  ErrorLog log{std::move(pipe.writer), [](const std::function<void()>&) { return false; }};
  const std::string sentence(1000, 'x');

  for (int i = 0; i < 3000; ++i) log.say(Weight::note, sentence);

  EXPECT_FALSE(log.flush(1ms));
  read_until(pipe.reader, "x\n");
  log.say(Weight::note, "the end");
  EXPECT_FALSE(log.flush(0ms)) << "a pipe holds less than what waits";
}

/// A terminal that nobody reads. The slave side is opened as a shell does for its programs.
struct Terminal {
  FileDescriptor master{::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)};
  FileDescriptor slave = open_slave(master.get());

  static FileDescriptor open_slave(int master) {
    EXPECT_EQ(::grantpt(master), 0);
    EXPECT_EQ(::unlockpt(master), 0);
    return FileDescriptor{::open(::ptsname(master), O_RDWR | O_NOCTTY | O_CLOEXEC)};
  }
};

/// The test hangs if a write to the terminal blocks.
TEST(ErrorLog, WithoutAThreadWaitsForNoTerminalThatNobodyReads) {
  const Terminal terminal;
  ErrorLog log{open_again(terminal.slave.get()),
               [](const std::function<void()>&) { return false; }};

  for (std::size_t i = 0; i < 20'000; ++i) log.say(Weight::note, std::string(i % 300, 'x'));

  EXPECT_FALSE(log.flush(20ms)) << "nobody has read anything";
  EXPECT_THAT(read_until(terminal.master, " xx\r\n"), HasSubstr("no thread can be created"));
}

/// After `su` the terminal can't be opened again. The test hangs if a write blocks.
TEST(ErrorLog, WithoutAThreadWaitsForNoTerminalWhoseDescriptorIsThatOfTheShell) {
  const Terminal terminal;
  const int shell = terminal.slave.get();
  ErrorLog log{FileDescriptor{::fcntl(shell, F_DUPFD_CLOEXEC, 3)},
               [](const std::function<void()>&) { return false; }};

  for (std::size_t i = 0; i < 20'000; ++i) log.say(Weight::note, std::string(i % 300, 'x'));

  EXPECT_FALSE(log.flush(20ms)) << "nobody has read anything";
  EXPECT_EQ(::fcntl(shell, F_GETFL) & O_NONBLOCK, 0);
  EXPECT_THAT(read_until(terminal.master, " xx\r\n"), HasSubstr("no thread can be created"));
}

/// The test hangs if a write blocks.
TEST(ErrorLog, WithoutAThreadWaitsForNoSocketThatNobodyReads) {
  for (const int type : {SOCK_STREAM, SOCK_DGRAM, SOCK_SEQPACKET}) {
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, type | SOCK_CLOEXEC, 0, ends), 0);
    const FileDescriptor reader{ends[0]};
    ErrorLog log{FileDescriptor{ends[1]}, [](const std::function<void()>&) { return false; }};

    for (std::size_t i = 0; i < 20'000; ++i) log.say(Weight::note, std::string(i % 300, 'x'));

    EXPECT_FALSE(log.flush(20ms)) << "nobody has read anything";
  }
}

TEST(OpenAgain, LeavesTheTerminalOfTheShellBlocking) {
  const Terminal terminal;

  const FileDescriptor again = open_again(terminal.slave.get());

  EXPECT_NE(::fcntl(again.get(), F_GETFL) & O_NONBLOCK, 0);
  EXPECT_EQ(::fcntl(terminal.slave.get(), F_GETFL) & O_NONBLOCK, 0);
}

TEST(OpenAgain, NeverOpensTheMasterSideOfAnotherTerminal) {
  const Terminal terminal;

  const FileDescriptor again = open_again(terminal.master.get());

  EXPECT_EQ(::write(again.get(), "input\n", 6), 6);
  EXPECT_EQ(read_until(terminal.slave, "\n"), "input\n");
}

TEST(OpenAgain, KeepsThePositionThatIsSharedWithTheShell) {
  const FileDescriptor file{::open("/tmp", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600)};
  EXPECT_EQ(::write(file.get(), "shell ", 6), 6);

  EXPECT_EQ(::write(open_again(file.get()).get(), "taktd", 5), 5);

  std::array<char, 11> text{};
  EXPECT_EQ(::pread(file.get(), text.data(), text.size(), 0), 11);
  EXPECT_EQ(std::string(text.data(), text.size()), "shell taktd");
}

TEST(OpenAgain, WritesToThePipeOfTheOldDescriptor) {
  const Pipe pipe = make_pipe();

  const FileDescriptor again = open_again(pipe.writer.get());

  EXPECT_NE(::fcntl(again.get(), F_GETFL) & O_NONBLOCK, 0);
  EXPECT_EQ(::fcntl(pipe.writer.get(), F_GETFL) & O_NONBLOCK, 0);
  EXPECT_EQ(::write(again.get(), "a\n", 2), 2);
  EXPECT_EQ(read_until(pipe.reader, "\n"), "a\n");
}

}  // namespace
}  // namespace takt
