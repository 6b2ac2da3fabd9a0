#include "master/linux/bus/bus_claim.hpp"

#include <filesystem>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test/support/folder.hpp"

namespace takt {
namespace {

/// A private bus for each test.
class BusClaimTest : public testing::Test {
 protected:
  BusName bus(const std::string& name = "bus") const {
    return {.kind = BusName::Kind::unix_path, .name = folder_ / name};
  }
  const test::Folder folder_;
};

TEST_F(BusClaimTest, IsForOneMasterWhoIsNamedToTheSecond) {
  const auto first = BusClaim::take(bus());
  ASSERT_TRUE(first) << first.error().message;

  const auto second = BusClaim::take(bus());

  ASSERT_FALSE(second);
  const std::string holder = "process " + std::to_string(::getpid()) + " (";
  EXPECT_NE(second.error().message.find(holder), std::string::npos) << second.error().message;
  EXPECT_NE(second.error().message.find("is the master of this bus already"), std::string::npos)
      << second.error().message;
  EXPECT_TRUE(BusClaim::take(bus("another")));
}

TEST_F(BusClaimTest, IsFreeAgainWhenItsHolderIsKilled) {
  const pid_t child = ::fork();
  if (child == 0) {
    const auto claim = BusClaim::take(bus());
    ::kill(::getpid(), claim ? SIGKILL : SIGTERM);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(WTERMSIG(status), SIGKILL);

  EXPECT_TRUE(BusClaim::take(bus()));
}

TEST_F(BusClaimTest, IsOfTheBusWhateverTheWayToIt) {
  std::filesystem::create_directory(folder_ / "a");
  std::filesystem::create_symlink(folder_ / "a", folder_ / "b");
  const auto first = BusClaim::take(bus("a/bus"));
  ASSERT_TRUE(first);

  EXPECT_FALSE(BusClaim::take(bus("b/bus")));
  EXPECT_FALSE(BusClaim::take(bus("a/../b/bus")));
}

/// A claim is taken before the socket of the bus exists.
TEST_F(BusClaimTest, OfARelativePathIsForItsFolder) {
  const auto before = std::filesystem::current_path();
  const BusName relative{.kind = BusName::Kind::unix_path, .name = "bus"};
  for (const char* name : {"a", "b"}) std::filesystem::create_directory(folder_ / name);
  std::filesystem::current_path(folder_ / "a");
  const auto first = BusClaim::take(relative);
  std::filesystem::current_path(folder_ / "b");
  const auto elsewhere = BusClaim::take(relative);
  const auto same = BusClaim::take(bus("a/bus"));
  std::filesystem::current_path(before);

  EXPECT_TRUE(first);
  EXPECT_TRUE(elsewhere) << "another bus of the same name";
  EXPECT_FALSE(same) << "the same bus by its absolute path";
}

TEST_F(BusClaimTest, ReportsLongPathsApart) {
  const std::string folder(150, 'x');
  const auto first = BusClaim::take(bus(folder + "/1"));
  ASSERT_TRUE(first) << first.error().message;

  EXPECT_FALSE(BusClaim::take(bus(folder + "/1")));
  EXPECT_TRUE(BusClaim::take(bus(folder + "/2")));
}

TEST_F(BusClaimTest, OfASimulatedBusIsNeverRefused) {
  const auto first = BusClaim::take({});
  const auto second = BusClaim::take({});

  EXPECT_TRUE(first);
  EXPECT_TRUE(second);
}

}  // namespace
}  // namespace takt
