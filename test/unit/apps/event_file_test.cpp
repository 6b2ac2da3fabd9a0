#include "apps/taktd/event_file.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "master/linux/file_descriptor.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// A pipe in the place of a file: what is not read from it stalls its writer, as a disk may.
class EventFileTest : public testing::Test {
 protected:
  EventFileTest() {
    EXPECT_EQ(::mkfifo((folder_ / "events").c_str(), 0600), 0);
    reader_ =
        FileDescriptor{::open((folder_ / "events").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
    file = EventFile::open(folder_ / "events");
    ::fcntl(reader_.get(), F_SETFL, 0);
  }

  /// All lines until the file is closed.
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
  std::unique_ptr<EventFile> file;
};

TEST_F(EventFileTest, KeepsNobodyWaitingWhileTheDiskStallsAndCountsWhatIsLost) {
  constexpr std::size_t added = 3000;
  const std::string line(1000, 'x');

  for (std::size_t i = 0; i < added; ++i) file->add(line);
  EXPECT_FALSE(file->flush(20ms));
  const std::uint64_t lost = file->take_lost();
  EXPECT_GT(lost, 0U);
  EXPECT_EQ(file->take_lost(), 0U);

  std::size_t read = 0;
  std::thread reader{[&] { read = read_lines(); }};
  EXPECT_TRUE(file->flush(60s));
  file.reset();
  reader.join();
  EXPECT_EQ(read + lost, added);
}

TEST_F(EventFileTest, WritesAllBeforeItEnds) {
  for (int i = 0; i < 10; ++i) file->add("a line");
  file.reset();

  EXPECT_EQ(read_lines(), 10U);
}

TEST(EventFile, CountsWhatAFullDiskRefuses) {
  const auto file = EventFile::open("/dev/full");
  ASSERT_NE(file, nullptr);
  for (int i = 0; i < 3; ++i) file->add("a line");

  EXPECT_TRUE(file->flush(60s));
  EXPECT_EQ(file->take_lost(), 3U);
  EXPECT_EQ(EventFile::open("/nonexistent/events"), nullptr);
}

}  // namespace
}  // namespace takt
