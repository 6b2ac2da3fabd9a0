#include <gtest/gtest.h>

#include "test/e2e/daemon_process.hpp"

namespace takt::test {
namespace {

class FamilyDemos : public testing::TestWithParam<const char*> {};

TEST_P(FamilyDemos, RunInTaktdWithTheirSimulatedDevice) {
  DaemonProcess daemon{TAKT_SOURCE_DIR "/share/demo/" + std::string{GetParam()} + ".yaml"};

  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); })) << daemon.log();
  const std::int64_t syncs = daemon.bus().status()->diagnosis.sync_count;
  ASSERT_TRUE(daemon.hear([&] {
    const diagnosis_t& diagnosis = daemon.bus().status()->diagnosis;
    return diagnosis.sync_count > syncs && diagnosis.nodes_not_ok == 0;
  }));

  EXPECT_EQ(daemon.bus().status()->diagnosis.state, 0);
  EXPECT_EQ(daemon.events_in_file("boot_failed"), 0U) << daemon.log();
}

INSTANTIATE_TEST_SUITE_P(Demos, FamilyDemos,
                         testing::Values("lenze8400", "beckhoff", "plain301", "astraada_drv28"),
                         [](const auto& demo) { return std::string{demo.param}; });

}  // namespace
}  // namespace takt::test
