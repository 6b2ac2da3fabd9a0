#include "master/black_box/black_box.hpp"

#include <atomic>
#include <csignal>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>

#include "test/black_box/recorded_run.hpp"
#include "test/support/folder.hpp"

namespace {

std::atomic<int> remover{0};  // the thread that last removed a file

}  // namespace

/// Replaces remove() of the C library in this program.
extern "C" int remove(const char* path) noexcept {
  remover = ::gettid();
  return ::unlink(path) == 0 ? 0 : ::rmdir(path);
}

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Folder;

/// A black box whose bus thread does nothing but begin cycles.
class BlackBoxTest : public testing::Test {
 protected:
  BlackBoxTest() { plan.name = "lift"; }
  void open(std::size_t keep = 20) {
    auto opened = BlackBox::open({.folder = folder / "box", .bytes = 65536, .keep = keep}, plan,
                                 {.bus = "lift"},
                                 [this](const std::string& sentence, const std::string& file) {
                                   (file.empty() ? failed : declared).push_back(sentence);
                                   newest = file;
                                 });
    ASSERT_TRUE(opened) << opened.error();
    box = std::move(*opened);
  }
  /// Runs the front thread for this time.
  void pass(Time time) {
    const Time end = now + time;
    for (; now < end; now += 100ms) {
      box->journal().begin_cycle(++cycle);
      box->serve(now);
    }
  }
  /// The writer is another thread.
  void await_files() {
    const std::size_t before = declared.size() + failed.size();
    while (declared.size() + failed.size() == before) box->serve(now);
  }
  std::set<std::string> files() {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator{folder / "box"}) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }
  Folder folder;
  BusPlan plan;
  std::unique_ptr<BlackBox> box;
  std::vector<std::string> declared;
  std::vector<std::string> failed;
  std::string newest;
  Time now = 100s;
  std::uint64_t cycle = 0;
};

TEST_F(BlackBoxTest, WritesASecondAfterTheFault) {
  open();
  pass(1s);
  box->on_fault("emcy", 5, "node 5 is hot\nand more", now);
  pass(900ms);
  EXPECT_TRUE(files().empty());
  pass(300ms);
  await_files();

  EXPECT_EQ(files().size(), 3U);
  ASSERT_EQ(declared.size(), 1U);
  EXPECT_NE(declared[0].find("(node 5 is hot)"), std::string::npos) << declared[0];
  EXPECT_NE(declared[0].find("box/lift-"), std::string::npos) << declared[0];
}

TEST_F(BlackBoxTest, WritesOneKindOfFaultOfANodeOnceInFiveMinutes) {
  open();
  for (int i = 0; i < 60; ++i) {
    box->on_fault("emcy", 5, "node 5 is hot", now);
    pass(1s);
  }
  EXPECT_LE(files().size(), 3U);
  box->on_fault("emcy", 6, "node 6 is hot", now);
  pass(1200ms);
  EXPECT_TRUE(box->finish("", 60s));
  EXPECT_EQ(files().size(), 6U);
}

TEST_F(BlackBoxTest, KeepsTenSecondsBetweenTwoRecordings) {
  open();
  box->on_request("asked for", now);
  pass(200ms);
  await_files();
  box->on_request("asked for", now);
  pass(9s);
  EXPECT_EQ(declared.size(), 1U);
  pass(1200ms);
  await_files();
  EXPECT_EQ(declared.size(), 2U);
}

TEST_F(BlackBoxTest, RemovesTheOldestRecordingsOfItsBusOnly) {
  open(2);
  for (const std::string name : {"lift-20200101T000000", "lift-20200102T000000", "lift-notes",
                                 "lift-a20200101T000000", "pump-20200101T000000"}) {
    for (const std::string ending : {".log", ".journal", ".events.json"}) {
      std::ofstream{folder / ("box/" + name + ending)} << "x";
    }
  }
  box->on_request("asked for", now);
  pass(200ms);
  await_files();

  const auto names = files();
  EXPECT_EQ(names.size(), 15U);
  EXPECT_FALSE(names.contains("lift-20200101T000000.log"));
  EXPECT_TRUE(names.contains("lift-20200102T000000.log"));
  EXPECT_TRUE(names.contains("lift-notes.log"));
  EXPECT_TRUE(names.contains("lift-a20200101T000000.log"));
  EXPECT_TRUE(names.contains("pump-20200101T000000.log"));
}

TEST_F(BlackBoxTest, LeavesTheWorkInTheFolderToItsWriter) {
  open(1);
  std::ofstream{folder / "box/lift-20200101T000000.log"} << "x";
  remover = 0;
  box->on_request("asked for", now);
  pass(200ms);
  await_files();

  EXPECT_FALSE(files().contains("lift-20200101T000000.log"));
  EXPECT_NE(remover, 0);
  EXPECT_NE(remover, ::gettid());
}

TEST_F(BlackBoxTest, WritesTheEndOfARunThatFailed) {
  open();
  pass(1s);
  EXPECT_TRUE(box->finish("", 60s));
  EXPECT_TRUE(files().empty());
  EXPECT_TRUE(box->finish("node 1 is mandatory and did not boot", 60s));
  EXPECT_EQ(files().size(), 3U);
}

TEST_F(BlackBoxTest, ReportsWhoAskedAndWhichFileItIs) {
  open();
  box->on_request("asked for by takt-77", now);
  pass(200ms);
  await_files();

  ASSERT_EQ(declared.size(), 1U);
  EXPECT_NE(declared[0].find("(asked for by takt-77)"), std::string::npos) << declared[0];
  EXPECT_TRUE(std::filesystem::exists(newest)) << newest;
}

TEST_F(BlackBoxTest, WritesWhileTheBusThreadRunsOnWhenNobodyWaitsForIt) {
  open();
  pass(1s);
  std::atomic<bool> over = false;
  std::thread bus{[&] {
    for (std::uint64_t beat = cycle; !over;) box->journal().begin_cycle(++beat);
  }};

  const bool written = box->finish_running("stopped at once", 60s);
  over = true;
  bus.join();

  EXPECT_TRUE(written);
  EXPECT_EQ(files().size(), 3U);
  ASSERT_EQ(declared.size(), 1U);
  EXPECT_NE(declared[0].find("(stopped at once)"), std::string::npos) << declared[0];
}

TEST_F(BlackBoxTest, DoesNotWaitForABusThreadThatBeginsNoCycleAnyMore) {
  open();
  pass(1s);

  EXPECT_FALSE(box->finish_running("stopped at once", 10ms));
  EXPECT_TRUE(files().empty());
}

/// A limit of the size of files, which imitates a full disk.
class FullDisk {
 public:
  FullDisk() {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit full{.rlim_cur = 100, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST_F(BlackBoxTest, LosesNoRecordingToAFullDiskAndLeavesNoHalfOne) {
  open(1);
  std::ofstream{folder / "box/lift-20200101T000000.log"} << "x";
  {
    const FullDisk disk;
    box->on_request("asked for", now);
    pass(200ms);
    await_files();
  }

  EXPECT_TRUE(declared.empty());
  ASSERT_EQ(failed.size(), 1U);
  EXPECT_NE(failed[0].find("can't be written: File too large"), std::string::npos) << failed[0];
  EXPECT_EQ(files(), std::set<std::string>{"lift-20200101T000000.log"});
  pass(11s);
  box->on_request("asked for", now);
  pass(200ms);
  await_files();
  EXPECT_EQ(files().size(), 3U);
  EXPECT_FALSE(files().contains("lift-20200101T000000.log"));
}

TEST_F(BlackBoxTest, IsThereThoughNoFileCanBeMadeNow) {
  // UBSan needs descriptors of its own when it sees the type of an object for the first time.
  open();
  box.reset();
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  const rlimit none{.rlim_cur = 0, .rlim_max = before.rlim_max};
  ::setrlimit(RLIMIT_NOFILE, &none);
  open();
  ::setrlimit(RLIMIT_NOFILE, &before);

  box->on_request("asked for", now);
  pass(200ms);
  await_files();
  EXPECT_EQ(files().size(), 3U);
}

TEST_F(BlackBoxTest, RemovesWhatARunLeftBehindThatWasEndedWhileItWrote) {
  std::filesystem::create_directories(folder / "box");
  for (const char* name : {".part-lift-20200101T000000.log", ".part-pump-20200101T000000.log",
                           "lift-20200101T000000.log"}) {
    std::ofstream{folder / "box" / name} << "x";
  }

  open();

  EXPECT_EQ(files(),
            (std::set<std::string>{".part-pump-20200101T000000.log", "lift-20200101T000000.log"}));
}

TEST_F(BlackBoxTest, SaysWhyAFolderCannotBeUsed) {
  std::ofstream{folder / "file"} << "x";
  const auto opened = BlackBox::open({.folder = folder / "file/below"}, plan, {},
                                     [](const std::string&, const std::string&) {});
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().find("file/below: Not a directory"), std::string::npos)
      << opened.error();
}

}  // namespace
}  // namespace takt
