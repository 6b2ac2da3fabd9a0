#include "apps/taktd/process/line_writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/resource.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "master/linux/file_descriptor.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// A pipe in place of a file. A full pipe stalls the writer, as a slow disk may.
class LineWriterTest : public testing::Test {
 protected:
  LineWriterTest() {
    EXPECT_EQ(::mkfifo((folder_ / "events").c_str(), 0600), 0);
    reader_ =
        FileDescriptor{::open((folder_ / "events").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
    writer = LineWriter::open(folder_ / "events");
    ::fcntl(reader_.get(), F_SETFL, 0);
  }

  /// Reads all lines until the file is closed and returns their number.
  std::size_t read_lines() const {
    std::array<char, 65536> chunk;
    std::size_t lines = 0;
    for (ssize_t size = 0; (size = ::read(reader_.get(), chunk.data(), chunk.size())) > 0;) {
      lines += static_cast<std::size_t>(std::count(chunk.begin(), chunk.begin() + size, '\n'));
    }
    return lines;
  }

  const test::Folder folder_;
  FileDescriptor reader_;
  std::unique_ptr<LineWriter> writer;
};

TEST_F(LineWriterTest, KeepsNobodyWaitingWhileTheDiskStallsAndCountsWhatIsLost) {
  constexpr std::size_t added = 3000;
  const std::string line(1000, 'x');

  for (std::size_t i = 0; i < added; ++i) writer->add(line);
  EXPECT_FALSE(writer->flush(20ms));
  const std::uint64_t lost = writer->take_lost();
  EXPECT_GT(lost, 0U);
  EXPECT_EQ(writer->take_lost(), 0U);

  std::size_t read = 0;
  std::thread reader{[&] { read = read_lines(); }};
  EXPECT_TRUE(writer->flush(60s));
  writer.reset();
  reader.join();
  EXPECT_EQ(read + lost, added);
}

TEST_F(LineWriterTest, WritesAllEvenWhereItsOwnerHasEnded) {
  for (int i = 0; i < 10; ++i) writer->add("a line");
  writer.reset();

  EXPECT_EQ(read_lines(), 10U);
}

TEST_F(LineWriterTest, DoesNotKeepItsOwnerFromEndingWhileTheDiskStalls) {
  const std::string line(1000, 'x');
  for (int i = 0; i < 500; ++i) writer->add(line);

  writer.reset();

  EXPECT_EQ(read_lines(), 500U);
}

TEST(LineWriter, CountsWhatAFullDiskRefuses) {
  const auto file = LineWriter::open("/dev/full");
  ASSERT_NE(file, nullptr);
  for (int i = 0; i < 3; ++i) file->add("a line");

  EXPECT_TRUE(file->flush(60s));
  EXPECT_EQ(file->take_lost(), 3U);
}

TEST(LineWriter, RefusesAFileBelowSomethingThatIsNoFolder) {
  EXPECT_EQ(LineWriter::open("/dev/full/events"), nullptr);
}

TEST(LineWriter, RefusesAPipeThatNobodyReadsInsteadOfWaitingForAReader) {
  const test::Folder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);

  EXPECT_EQ(LineWriter::open(folder / "pipe"), nullptr);
  EXPECT_EQ(errno, ENXIO);
}

/// Limits the size of files to `bytes`, as on a disk that then is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit full{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file{path};
  return {std::istreambuf_iterator<char>{file}, {}};
}

TEST(LineWriter, LeavesNoHalfLineOnAFullDisk) {
  const test::Folder folder;
  const auto file = LineWriter::open(folder / "events");
  {
    const FullDisk disk{10};
    file->add("first");
    ASSERT_TRUE(file->flush(60s));
    file->add("second, cut");
    ASSERT_TRUE(file->flush(60s));
  }
  file->add("third");
  ASSERT_TRUE(file->flush(60s));

  EXPECT_EQ(content_of(folder / "events"), "first\nthird\n");
  EXPECT_EQ(file->take_lost(), 1U);
}

TEST(LineWriter, BeginsOnALineOfItsOwnWhereAnEarlierRunWasCut) {
  const test::Folder folder;
  const auto path = folder.write("events", "whole\n{\"utime\":17");

  const auto file = LineWriter::open(path);
  file->add("next");
  ASSERT_TRUE(file->flush(60s));

  EXPECT_EQ(content_of(path), "whole\n{\"utime\":17\nnext\n");
}

TEST(LineWriter, KeepsLinesUntilThereIsAThreadToWriteThem) {
  const test::Folder folder;
  FileDescriptor file{::open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600)};
  int refused = 0;
  LineWriter writer{std::move(file), [&](std::function<void()> body) {
                      if (refused == 1) return LineWriter::start_detached(std::move(body));
                      ++refused;
                      return false;
                    }};

  writer.add("a line");
  EXPECT_FALSE(writer.has_thread());
  EXPECT_EQ(content_of(folder / "log"), "");

  EXPECT_TRUE(writer.flush(60s));
  EXPECT_EQ(content_of(folder / "log"), "a line\n");
}

}  // namespace
}  // namespace takt
