// `takt param` and `takt status --pdos` against a daemon with a simulated DRV-28.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

class Drv28Daemon : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(daemon_.hear([&] { return daemon_.all_ready(); })) << daemon_.log();
  }
  Ended takt(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), TAKT);
    arguments.insert(arguments.end(), {"--lcm-url", daemon_.lcm_url()});
    return run(std::move(arguments), folder_.path());
  }

  /// Returns the part about RPDO1 from `takt status --pdos`.
  nlohmann::json rpdo1() {
    using namespace nlohmann::literals;
    const auto document =
        nlohmann::json::parse(takt({"status", "--pdos", "--json"}).output, nullptr, false);
    for (const nlohmann::json& pdo : document.at("/buses/0/pdos"_json_pointer)) {
      if (pdo["pdo"] == "RPDO1") return pdo;
    }
    return {};
  }

  Folder folder_;
  DaemonProcess daemon_{std::string{TAKT_SOURCE_DIR} + "/share/demo/astraada_drv28.yaml"};
};

TEST_F(Drv28Daemon, ReadsAndWritesAParameterOverPdo1) {
  const Ended written = takt({"param", "write", "pump", "P15.13", "1"});
  EXPECT_EQ(written.exit_code, 0) << written.output;

  const Ended read = takt({"param", "read", "pump", "P15.13"});
  EXPECT_EQ(read.exit_code, 0);
  EXPECT_EQ(read.output, "1\n");

  const Ended again = takt({"param", "read", "4", "0x0F0D", "--json"});
  EXPECT_NE(again.output.find("\"value\":1"), std::string::npos) << again.output;
}

TEST_F(Drv28Daemon, ReportsTheErrorOfTheDriveInWords) {
  const Ended read = takt({"param", "read", "pump", "P99.99"});
  EXPECT_EQ(read.exit_code, 1);
  EXPECT_NE(read.output.find("error 2, no such parameter address"), std::string::npos)
      << read.output;
}

TEST_F(Drv28Daemon, SaysWhichPdosCanBeAsked) {
  const Ended other = takt({"param", "read", "pump", "P15.13", "--pdo", "2"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.output.find("takt plan"), std::string::npos) << other.output;
  EXPECT_EQ(takt({"param", "read", "pump", "P15"}).exit_code, 2);
}

TEST_F(Drv28Daemon, ShowsEachPdoInItsStatus) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(takt({"param", "read", "pump", "P15.13"}).exit_code, 0);
  }
  const Ended status = takt({"status", "--pdos"});
  EXPECT_EQ(status.exit_code, 0);
  EXPECT_NE(status.output.find("TPDO2"), std::string::npos) << status.output;
  EXPECT_NE(status.output.find("0x284"), std::string::npos);
  const Ended json = takt({"status", "--pdos", "--json"});
  EXPECT_NE(json.output.find("\"age_cycles\""), std::string::npos) << json.output;
  nlohmann::json shown = rpdo1();
  for (int i = 0; i < 50 && shown.value("count", 0) < 3; ++i) shown = rpdo1();
  EXPECT_EQ(shown.value("count", 0), 3) << "one frame for each request: " << shown;
  EXPECT_TRUE(shown.value("toggle", false)) << shown;
}

}  // namespace
}  // namespace takt::test
