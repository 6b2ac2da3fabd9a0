// Foreign files may contain anything. None of their control characters may reach a terminal.
#include <algorithm>
#include <gtest/gtest.h>
#include <string>

#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

bool is_plain(const std::string& text) {
  return std::ranges::none_of(text, [](char c) { return c == '\x1B' || c == '\x07'; });
}

TEST(StrangeTexts, OfADeviceFileAreShownWithoutControlCharacters) {
  const Folder folder;
  std::string eds = read_file(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds");
  const std::string key = "ProductName=";
  eds.insert(eds.find(key) + key.size(), "\x1B]0;evil\x07");
  const auto file = folder.write("evil.eds", eds);

  const Ended shown = run({TAKT, "eds", "show", "--node", "3", file.string()}, folder.path());

  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_NE(shown.output.find("]0;evil"), std::string::npos) << shown.output;
  EXPECT_TRUE(is_plain(shown.output));
}

TEST(StrangeTexts, OfANetworkFileAreShownWithoutControlCharacters) {
  const Folder folder;
  const auto file =
      folder.write("bus.yml",
                   "master: {sync_period: 4000}\nnodes:\n  \"y\\e[31m\": {node_id: 1, "
                   "dcf: a.eds, \"fo\\eo\": \"\\a\"}\n");
  for (const std::string command : {"import", "plan"}) {
    const Ended told = run({TAKT, command, file.string()}, folder.path());
    EXPECT_TRUE(is_plain(told.output)) << command;
    EXPECT_NE(told.output.find("unknown key"), std::string::npos) << told.output;
  }
}

}  // namespace
}  // namespace takt::test
