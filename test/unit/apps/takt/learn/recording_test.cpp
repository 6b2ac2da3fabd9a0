// The lines that a recording may contain, and the distinction between nodes and master on the bus.
#include "apps/takt/learn/recording.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ios>
#include <random>
#include <sstream>
#include <unistd.h>

#include "apps/takt/learn/network_text.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/read/eds.hpp"
#include "test/support/folder.hpp"

namespace takt::learn {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

LearnedBus heard(const std::string& text, const std::string& interface = {}) {
  std::istringstream in{text};
  return read_recording(in, "boot.log", interface);
}

LearnedNetwork learned(const std::string& text) { return learned_network(heard(text), {}, {}); }

std::string rules(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) text += to_string(finding) + '\n';
  return text;
}

TEST(Learn, WhoStaysSilentWhenAllAreResetIsTheMaster) {
  const LearnedNetwork network = learned(
      "(1.00) can0 701#00\n(1.01) can0 000#8200\n(1.02) can0 702#00\n"
      "(1.03) can0 602#4000100000000000\n(1.04) can0 582#4300100092010200\n");

  EXPECT_THAT(network.text, HasSubstr("master:\n  node_id: 1\n"));
  EXPECT_THAT(network.text, Not(HasSubstr("node_1:")));
  EXPECT_THAT(rules(network.findings), Not(HasSubstr("no-master-id")));
}

TEST(Learn, ADeviceThatComesBackAfterTheResetOfAllIsNotTheMaster) {
  const LearnedNetwork network = learned(
      "(1.00) can0 703#00\n(1.01) can0 000#8200\n(1.02) can0 702#00\n(1.03) can0 703#00\n"
      "(1.04) can0 602#4000100000000000\n(1.05) can0 582#4300100092010200\n");

  EXPECT_THAT(network.text, HasSubstr("node_3:"));
  EXPECT_THAT(rules(network.findings), HasSubstr("no-master-id"));
}

TEST(Learn, WhoIsAskedBySdoIsNotTheMasterThoughItStaysSilent) {
  const LearnedNetwork network = learned(
      "(1.00) can0 705#00\n(1.01) can0 706#00\n(2.00) can0 000#8100\n(2.01) can0 705#00\n"
      "(2.20) can0 605#4000100000000000\n(2.21) can0 585#4300100092010200\n"
      "(2.22) can0 606#4000100000000000\n(2.72) can0 606#4000100000000000\n");

  EXPECT_THAT(network.text, HasSubstr("node_6:"));
  EXPECT_THAT(rules(network.findings), HasSubstr("no-master-id"));
}

TEST(Learn, WhoSendsEmcyOrTpdosIsThereThoughItsSdoServerIsSilent) {
  const std::string asked =
      "(1.00) can0 605#4000100000000000\n(1.01) can0 585#4300100092010200\n"
      "(1.10) can0 606#4000100000000000\n";

  EXPECT_THAT(learned(asked + "(1.2) can0 086#0010810000000000\n").text, HasSubstr("node_6:"));
  EXPECT_THAT(learned(asked + "(1.2) can0 486#0102\n").text, HasSubstr("node_6:"));
  EXPECT_THAT(learned(asked + "(1.2) can0 206#0102\n").text, Not(HasSubstr("node_6:")));
  EXPECT_THAT(learned(asked + "(1.2) can0 186#R\n").text, Not(HasSubstr("node_6:")));
  EXPECT_THAT(rules(learned(asked).findings),
              HasSubstr("SDO requests to 1 node id that sent no frame (6): takt leaves it out"));
}

TEST(Learn, ATpdoOfAnotherNodeDoesNotMakeANode) {
  const LearnedNetwork network = learned(
      "(1.00) can0 605#2301180186010000\n(1.01) can0 585#6001180100000000\n"
      "(1.10) can0 606#4000100000000000\n(1.20) can0 186#0102\n");

  EXPECT_THAT(network.text, Not(HasSubstr("node_6:")));
}

TEST(Learn, NodeIdsThatAScanAsksInVainAreNoNodes) {
  const LearnedNetwork network = learned(
      "(1.00) can0 602#4000100000000000\n(1.01) can0 603#4000100000000000\n"
      "(1.02) can0 583#4300100092010200\n(1.03) can0 604#4000100000000000\n"
      "(1.20) can0 602#8000100000000405\n(1.21) can0 604#8000100000000405\n");

  EXPECT_THAT(network.text, HasSubstr("node_3:"));
  EXPECT_THAT(network.text, Not(HasSubstr("node_2:")));
  EXPECT_EQ(network.made_files.size(), 1u);
  EXPECT_THAT(rules(network.findings),
              HasSubstr("SDO requests to 2 node ids that sent no frame (2, 4)"));
}

TEST(Learn, ANodeThatTheMasterCommandsByNameIsOneWithoutAnAnswerToo) {
  const LearnedNetwork network =
      learned("(1.00) can0 000#8202\n(1.01) can0 602#4000100000000000\n");

  EXPECT_THAT(network.text, HasSubstr("node_2:"));
}

TEST(Learn, ReadsTheTerminalFormatToo) {
  const LearnedNetwork network = learned(
      " (009.100000)  can0  708   [1]  00\n (009.200000)  can0  608   [8]  2B 17 10 00 64 00 00 "
      "00\n"
      " (009.200500)  can0  588   [8]  60 17 10 00 00 00 00 00\n");

  EXPECT_THAT(network.text, HasSubstr("heartbeat_producer: 100\n"));
}

TEST(Learn, AStrangeInterfaceNameStaysAName) {
  const LearnedNetwork network = learned("(1.0) x\"},{ 701#00\n");

  EXPECT_THAT(network.text, HasSubstr("bus: {interface: \"x\\\"},{\", bitrate_kbit: 1000}\n"));
}

TEST(Learn, LeavesOtherInterfacesOutAndSaysSo) {
  const std::string log = "(1.0) can0 701#00\n(1.1) can1 702#00\n";

  const LearnedBus first = heard(log);
  const LearnedBus second = heard(log, "can1");

  EXPECT_TRUE(first.nodes.contains(1) && !first.nodes.contains(2));
  EXPECT_THAT(rules(first.findings), HasSubstr("--bus can1 learns from them"));
  EXPECT_TRUE(second.nodes.contains(2) && !second.nodes.contains(1));
}

TEST(Learn, AnErrorFrameDoesNotChooseTheInterface) {
  const LearnedBus bus = heard(
      "(1.0) can1 20000008#0000190000000000\n(1.1) can0 20000008#0000190000000000\n"
      "(1.2) can0 701#00\n(1.3) can0 20000008#0000190000000000\n");

  EXPECT_EQ(bus.interface, "can0");
  EXPECT_TRUE(bus.nodes.contains(1));
  EXPECT_EQ(bus.frames, 3U);
  EXPECT_EQ(bus.error_frames, 2U);
  EXPECT_THAT(rules(bus.findings), HasSubstr("1 frames of other interfaces (can1)"));
}

TEST(Learn, ARecordingOfErrorFramesAloneIsThatOfTheFirst) {
  const LearnedBus bus =
      heard("(1.0) can1 20000008#0000190000000000\n(1.1) can0 20000008#0000190000000000\n");

  EXPECT_EQ(bus.interface, "can1");
  EXPECT_EQ(bus.error_frames, 1U);
}

TEST(Learn, NamesTheLinesThatAreNoFrames) {
  const LearnedBus bus = heard("hello\n(1.0) can0 701#00\n(1.1) can0 701##100\n\n");

  EXPECT_EQ(bus.frames, 1u);
  EXPECT_THAT(rules(bus.findings), HasSubstr("boot.log:1:0: warning: not a frame of candump"));
  EXPECT_THAT(rules(bus.findings), HasSubstr("boot.log:3:0: warning: not a frame of candump"));
}

TEST(Learn, ReadsDatedStampsAndPcanTraces) {
  const LearnedBus dated = heard(
      " (2023-01-31 23:59:59.900000)  can0  705   [1]  05\n"
      " (2023-02-01 00:00:00.000000)  can0  705   [1]  05\n"
      " (2023-02-01 00:00:00.100000)  can0  705   [1]  05\n"
      " (2023-02-01 00:00:00.200000)  can0  705   [1]  05\n");
  const LearnedBus traced = heard(
      ";$FILEVERSION=1.1\n"
      "     1)     100.0  Rx         0705  1  05\n     2)     200.0  Rx         0705  1  05\n"
      "     3)     300.0  Rx         0705  1  05\n     4)     400.0  Rx         0705  1  05\n");

  EXPECT_EQ(dated.nodes.at(5).heartbeats.median(), 100'000);
  EXPECT_EQ(traced.nodes.at(5).heartbeats.median(), 100'000);
  EXPECT_TRUE(traced.findings.empty());
}

TEST(Learn, ReadsADecimalVectorLog) {
  const LearnedBus bus = heard(
      "date Mon Nov 23 10:00:00 2026\nbase dec  timestamps absolute\n"
      "   1.001000 1  389  Rx  d 2 55 64\n   1.1 1 1797 Rx d 1 05\n");

  EXPECT_EQ(bus.frames, 2u);
  EXPECT_TRUE(bus.traffic.contains(CobId::base(0x185)));
  EXPECT_TRUE(bus.nodes.contains(5));
  EXPECT_TRUE(bus.findings.empty()) << rules(bus.findings);
}

// Words of all formats in random order; the only requirement is that the parser ends.
TEST(Learn, SurvivesNoiseInTheFormsOfTraces) {
  const std::array<std::string_view, 40> words{
      "1)",  "2)",   "12",  "1",    "8",   "0",        "1060.0", "1.001",      "0601",     "581",
      "701", "00",   "40",  "FF",   "Rx",  "Tx",       "DT",     "RR",         "-",        "d",
      "r",   "RTR",  "12x", "base", "dec", "hex",      "date",   "Timestamp:", "ID:",      "DL:",
      "S",   "DLC:", "X",   "R",    "E",   "Channel:", "can0",   "Warng",      "00012345", "Start"};
  std::mt19937 random{11};
  std::string log;
  for (int i = 0; i < 30'000; ++i) {
    std::vector<std::string_view> line;
    switch (random() % 5) {
      case 0:
        line = {"1)", "1060.0", "Rx", "0601", "8", "40", "00", "10", "00", "00", "00", "00", "00"};
        break;
      case 1:
        line = {"1", "1060.0", "DT", "0581", "Rx", "4", "40", "00", "10", "00"};
        break;
      case 2:
        line = {"1.001", "1", "601", "Rx", "d", "4", "40", "00", "10", "00"};
        break;
      case 3:
        line = {"Timestamp:", "1.0", "ID:", "0601", "S", "Rx", "DL:", "2", "40", "00"};
        break;
      default:
        line.assign(random() % 12, "ID:");
        for (auto& word : line) word = words[random() % words.size()];
    }
    for (auto& word : line) {
      if (random() % 6 == 0) word = words[random() % words.size()];
    }
    line.resize(line.size() - (random() % 4 == 0 && !line.empty() ? 1 : 0));
    for (const std::string_view word : line) log += std::string{word} + ' ';
    log += '\n';
  }

  EXPECT_GT(heard(log).frames, 500u);  // frames of the first interface
}

TEST(Learn, SurvivesARecordingOfNoise) {
  std::mt19937 random{7};
  const auto any = [&](unsigned below) { return static_cast<unsigned>(random() % below); };
  std::string log;
  for (int i = 0; i < 30'000; ++i) {
    std::ostringstream line;
    const unsigned id = any(4) == 0 ? any(0x800) : 0x580 + any(2) * 0x80 + 1 + any(3);
    line << '(' << any(5) << '.' << any(1000) << ") can0 " << std::hex << std::uppercase;
    line << hex(id, 3).substr(2) << '#';
    const unsigned length = any(3) == 0 ? any(9) : 8;
    for (unsigned b = 0; b < length; ++b) line << hex(any(256), 2).substr(2);
    log += line.str() + (any(100) == 0 ? "\xFF\n" : "\n");
  }

  const LearnedNetwork network = learned(log);

  const test::Folder folder;
  for (const auto& [name, content] : network.made_files) {
    folder.write(name, content);
    EXPECT_TRUE(read_eds(content, name).readable);
  }
  const LoadedNetwork again = load_network(folder.write("net.yaml", network.text));
  for (const Finding& finding : again.findings) {
    EXPECT_NE(finding.rule, "syntax") << to_string(finding);
    EXPECT_NE(finding.rule, "unknown-key") << to_string(finding);
  }
}

TEST(Learn, ALineOfAnyLengthCostsNoMemory) {
  const LearnedBus bus = heard(std::string(5'000'000, 'A') + "\n(1.0) can0 701#00\n");

  EXPECT_EQ(bus.frames, 1u);
}

}  // namespace
}  // namespace takt::learn
