// Foreign files may contain anything. None of their control characters may reach a terminal.
#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// ESC, BEL and DEL, and CSI of C1 in UTF-8. `[3m` and the other letters show that a text was
/// printed at all.
const std::string strange = "[3m\x1B[3m\x07\x7F\xC2\x9B";

bool is_plain(const std::string& text) {
  return std::ranges::none_of(text, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n') || byte == 0x7F || byte == 0x9B;
  });
}

/// Runs the program in `folder`. Fails the test unless it quotes the strange text without its
/// control characters.
void expect_plain(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                  const std::string& quoted = "[3m") {
  const Ended reported = run(arguments, folder);
  EXPECT_NE(reported.output.find(quoted), std::string::npos)
      << arguments[1] << ": " << reported.output;
  EXPECT_TRUE(is_plain(reported.output))
      << arguments[1] << ": " << testing::PrintToString(reported.output);
}

/// Returns the EDS of the drive with this text behind a key.
std::string drive_with(const std::string& key, const std::string& text) {
  std::string eds = read_file(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds");
  eds.insert(eds.find(key) + key.size(), text);
  return eds;
}

TEST(StrangeTexts, OfADeviceFileAreShownWithoutControlCharacters) {
  const Folder folder;
  const auto file =
      folder.write("evil.eds", drive_with("ProductName=", "\x1B]0;evil\x07" + strange));

  const Ended shown = run({TAKT, "eds", "show", "--node", "3", file.string()}, folder.path());

  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_NE(shown.output.find("]0;evil"), std::string::npos) << shown.output;
  EXPECT_TRUE(is_plain(shown.output));
  expect_plain({TAKT, "eds", "show", "--json", "--node", "3", file.string()}, folder.path());
}

TEST(StrangeTexts, OfFindingsAboutADeviceFileAreShownWithoutControlCharacters) {
  const Folder folder;
  const auto file =
      folder.write("evil.eds", drive_with("[1000]\n", strange + "=1\nDataType=" + strange + "\n"));
  for (const std::string verb : {"check", "dcf", "cdcf"}) {
    std::vector<std::string> arguments{TAKT, "eds", verb, file.string()};
    if (verb != "check") arguments.insert(arguments.end(), {"-o", folder / "out"});
    if (verb == "dcf" || verb == "cdcf") arguments.insert(arguments.end(), {"--node", "3"});
    const Ended reported = run(arguments, folder.path());
    EXPECT_TRUE(is_plain(reported.output))
        << verb << ": " << testing::PrintToString(reported.output);
  }
  expect_plain({TAKT, "eds", "check", file.string()}, folder.path());
  expect_plain({TAKT, "eds", "check", "--json", file.string()}, folder.path());
}

TEST(StrangeTexts, OfFindingsAboutANetworkFileAreShownWithoutControlCharacters) {
  const Folder folder;
  const auto file = folder.write("bus.yml",
                                 "master: {sync_period: 4000}\nnodes:\n  \"y\\e[3m\\x9b\": "
                                 "{node_id: 1, dcf: a.eds, \"fo\\e[3m\\x7f\\x9b\": \"\\a\"}\n");
  for (const std::string command :
       {"import", "plan", "simulate", "sim", "soak", "audit", "budget"}) {
    expect_plain({TAKT, command, file.string()}, folder.path());
  }
  expect_plain({TAKT, "dump", file.string(), "-"}, folder.path());
  expect_plain({TAKT, "export", "dbc", file.string(), "-o", folder / "out"}, folder.path());
  expect_plain({TAKTD, file.string(), "--check"}, folder.path());
  expect_plain({TAKTD, file.string(), "--bus", "sim"}, folder.path());
}

/// The name of a device file is part of a valid network, and so is the name in it.
TEST(StrangeTexts, OfAValidNetworkAreShownWithoutControlCharacters) {
  const Folder folder;
  folder.write("evil" + strange + ".eds", drive_with("ParameterName=Controlword", strange));
  const auto file = folder.write("net.yaml",
                                 "bus: {name: evil}\nmaster: {sync_period: 4000}\nnodes:\n"
                                 "  a: {node_id: 1, dcf: \"evil[3m\\e[3m\\a\\x7f\\x9b.eds\"}\n");
  const auto other =
      folder.write("other.yaml",
                   "bus: {name: evil}\nmaster: {sync_period: 4000}\nnodes:\n  b: {node_id: 2, "
                   "dcf: " TAKT_SOURCE_DIR "/share/eds/takt_io401.eds}\n");

  expect_plain({TAKT, "plan", file.string()}, folder.path());
  expect_plain({TAKT, "plan", "--json", file.string()}, folder.path());
  expect_plain({TAKT, "plan", file.string(), "--diff", other.string()}, folder.path());
  expect_plain({TAKT, "plan", file.string(), "--json", "--diff", other.string()}, folder.path());
  expect_plain({TAKTD, file.string(), "--check"}, folder.path());
  const Process daemon{{TAKTD, file.string(), "--bus", "sim", "--lcm-url", "memq://"},
                       folder / "log"};
  EXPECT_TRUE(daemon.says("[3m")) << daemon.output();
  EXPECT_TRUE(is_plain(daemon.output())) << testing::PrintToString(daemon.output());
}

TEST(StrangeTexts, OfATraceAreShownWithoutControlCharacters) {
  const Folder folder;
  const auto file = folder.write("evil.log", "(1.000000) can" + strange + " 080#\n");
  const Ended reported = run({TAKT, "dump", file.string()}, folder.path());
  EXPECT_TRUE(is_plain(reported.output)) << testing::PrintToString(reported.output);
}

}  // namespace
}  // namespace takt::test
