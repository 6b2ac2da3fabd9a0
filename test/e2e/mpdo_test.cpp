#include <fstream>
#include <gtest/gtest.h>

#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

TEST(MultiplexedPdos, CarryACommandToTheDeviceAndItsAnswerIntoTheImage) {
  const Folder folder;
  std::string network = read_file(TAKT_SOURCE_DIR "/test/simulate/data/multi.yaml");
  network.replace(network.find("multi.eds"), 9, TAKT_SOURCE_DIR "/test/simulate/data/multi.eds");
  std::ofstream{folder / "multi.yaml"} << network;
  DaemonProcess daemon{folder / "multi.yaml"};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); })) << daemon.log();

  const auto command = [&] {
    daemon.command(
        daemon.command_for("e2e", {{"tank.level_1", 70'000}, {"tank.level_2", 0xFFFF'FFFF}}));
  };

  EXPECT_TRUE(daemon.work(command, [&] {
    return daemon.value("tank", "level_1_2") == 70'000 &&
           daemon.value("tank", "level_2_2") == 0xFFFF'FFFF;
  })) << daemon.log();
}

}  // namespace
}  // namespace takt::test
