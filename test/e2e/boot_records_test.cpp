#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// The demo with an unexpected vendor-ID, a read-only mapping and a mute device. No node is
/// mandatory, so the daemon keeps running and tries again.
std::filesystem::path three_troubles(const std::filesystem::path& folder) {
  return slow_network(folder, [](std::string& text) {
    const auto replace = [&](const std::string& what, const std::string& with) {
      const std::size_t at = text.find(what);
      ASSERT_NE(at, std::string::npos) << what;
      text.replace(at, what.size(), with);
    };
    replace("mandatory: true", "mandatory: false");
    replace("node_id: 1}", "node_id: 1, vendor_id: 0x1234}");
    replace("node_id: 2}", "node_id: 2, sim: {quirks: [fixed_mapping]}}");
    replace("node_id: 10\n", "node_id: 10\n    sim: {quirks: [mute_sdo]}\n");
  });
}

class BootRecords : public testing::Test {
 protected:
  /// Returns the newest record of a node on LCM; empty if there is none yet.
  std::string heard(int node) {
    std::string text;
    for (const event_t& event : daemon_.bus().events()) {
      if (event.kind == "boot_failed" && event.node_id == node) text = event.text;
    }
    return text;
  }
  /// Returns the first record of a node in the --events file.
  std::string written(int node) const {
    std::ifstream file{daemon_.event_file()};
    for (std::string line; std::getline(file, line);) {
      const auto event = nlohmann::json::parse(line, nullptr, false);
      if (!event.is_object()) break;  // the daemon is still writing this line
      if (event["kind"] == "boot_failed" && event["node"] == node) return event["text"];
    }
    return {};
  }
  void expect_both(int node, const std::vector<std::string>& parts) {
    ASSERT_TRUE(daemon_.hear([&] { return !heard(node).empty() && !written(node).empty(); }))
        << daemon_.log();
    for (const std::string& part : parts) {
      EXPECT_NE(heard(node).find(part), std::string::npos) << part << '\n' << heard(node);
      EXPECT_NE(written(node).find(part), std::string::npos) << part << '\n' << written(node);
    }
  }

  Folder folder_;
  DaemonProcess daemon_{three_troubles(folder_.path())};
};

TEST_F(BootRecords, OfAnotherVendorAReadOnlyMappingAndAMuteDeviceAreReportedWhole) {
  expect_both(1, {"node 1 'shoulder' failed to boot at step ", " (vendor id) after ",
                  "\n  sent      601  40 18 10 01 00 00 00 00   read 1018:01",
                  "\n  received  581  43 18 10 01 CD AB 00 00", "\n  expected  0x00001234",
                  "\n  status    D of CiA 302-2: vendor id differs", "\n  try       "});
  expect_both(2, {"node 2 'elbow' failed to boot at step ", " mapping off) after ",
                  "\n  sent      602  2F 0", "\n  received  582  80 0",
                  "\n  meaning   abort 0601 0002: attempt to write a read-only object",
                  "\n  status    J of CiA 302-2: configuration failed", "\n  try       "});
  expect_both(
      10,
      {"node 10 'io' failed to boot at step ",
       "\n  sent      60A  40 00 10 00 00 00 00 00   read 1000:00", "\n  received  nothing within ",
       "\n  status    B of CiA 302-2: no answer to the read of 0x1000", "\n  try       "});
}

}  // namespace
}  // namespace takt::test
