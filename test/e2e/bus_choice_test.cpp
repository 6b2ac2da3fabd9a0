#include <gtest/gtest.h>
#include <utility>

#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

class BusChoice : public testing::Test {
 protected:
  Ended takt(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), TAKT);
    arguments.insert(arguments.end(), {"--lcm-url", daemon_.lcm_url()});
    return run(std::move(arguments), folder_.path());
  }
  void SetUp() override {
    ASSERT_TRUE(daemon_.hear([&] { return daemon_.all_ready(); }));
  }

  Folder folder_;
  DaemonProcess daemon_{slow_network(folder_.path())};
};

TEST_F(BusChoice, AnUnknownBusIsWrongUseForEachVerb) {
  for (std::vector<std::string> verb : {std::vector<std::string>{"status"},
                                        {"status", "--json"},
                                        {"top", "--once"},
                                        {"sdo", "read", "1", "1000"},
                                        {"nmt", "start", "1"}}) {
    verb.insert(verb.end(), {"--bus-name", "typo"});
    const Ended ended = takt(verb);
    EXPECT_EQ(ended.exit_code, 2) << verb[0];
    EXPECT_NE(ended.output.find("there is no bus 'typo'; the buses are: demo"), std::string::npos)
        << verb[0] << ": " << ended.output;
  }
}

TEST_F(BusChoice, ANameInCapitalsIsThatOfTheChannels) {
  EXPECT_EQ(takt({"status", "--bus-name", "DEMO"}).exit_code, 0);
  EXPECT_EQ(takt({"sdo", "read", "1", "1000", "--bus-name", "DEMO"}).exit_code, 0);
}

/// The second daemon is an observer, because a second master would be refused.
TEST_F(BusChoice, TwoDaemonsOfOneBusAreTrouble) {
  const Process second{{TAKTD, slow_network(folder_.path()).string(), "--bus", "sim", "--observe",
                        "--lcm-url", daemon_.lcm_url()},
                       folder_ / "second"};
  ASSERT_TRUE(daemon_.hear([&] { return daemon_.bus().two_daemons(); }));

  for (const std::vector<std::string>& verb :
       {std::vector<std::string>{"status"}, {"status", "--json"}, {"sdo", "read", "1", "1000"}}) {
    const Ended ended = takt(verb);
    EXPECT_EQ(ended.exit_code, 3) << verb[0];
    EXPECT_NE(ended.output.find("two daemons run a bus named 'demo'"), std::string::npos)
        << verb[0] << ": " << ended.output;
    EXPECT_NE(ended.output.find("choose with --lcm-url"), std::string::npos) << ended.output;
  }
}

TEST_F(BusChoice, WhoNamesThisBusOnTheChannelOfAnotherOneIsNoDaemonOfIt) {
  status_t forged = *daemon_.bus().status();
  forged.session += 1;
  std::vector<std::byte> buffer;
  const Bytes message = encode(forged, buffer);
  Process tool{
      {TAKT, "sdo", "read", "1", "1000", "--bus-name", "demo", "--lcm-url", daemon_.lcm_url()},
      folder_ / "tool"};

  const auto exit_code = tool.wait([&] { daemon_.publish("OTHER_STATUS", message); });

  EXPECT_EQ(exit_code, 0) << tool.output();
}

}  // namespace
}  // namespace takt::test
