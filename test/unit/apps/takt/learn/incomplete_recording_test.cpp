// Recordings that begin in the middle, lack frames, or lack information.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>
#include <unistd.h>

#include "apps/takt/learn/network_text.hpp"
#include "apps/takt/learn/recording.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "test/support/folder.hpp"

namespace takt::learn {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

LearnedNetwork learned(const std::string& text) {
  std::istringstream in{text};
  return learned_network(read_recording(in, "boot.log", {}), {}, {});
}

bool has_rule(const LearnedNetwork& network, std::string_view rule) {
  return std::ranges::find(network.findings, rule, &Finding::rule) != network.findings.end();
}

TEST(IncompleteRecording, ADeviceWhoseHeartbeatIsHeardHas1017ThoughNobodyWroteIt) {
  std::string log = "(1.0) can0 000#8206\n(1.1) can0 706#00\n";
  for (int i = 12; i < 30; ++i) log += "(" + std::to_string(i) + ".0) can0 706#05\n";
  const LearnedNetwork network = learned(log);
  const test::Folder folder;
  for (const auto& [name, text] : network.made_files) folder.write(name, text);

  const LoadedNetwork again = load_network(folder.write("net.yaml", network.text));

  EXPECT_THAT(network.text, HasSubstr("    heartbeat_producer: 1000   # as measured\n"));
  EXPECT_FALSE(has_error(again.findings)) << network.text;
}

TEST(IncompleteRecording, APdoThatIsOnWithoutAMappingIsNotTaken) {
  const std::string log =
      "(1.0) can0 000#8206\n(1.1) can0 706#00\n"
      "(1.2) can0 606#2F001A0000000000\n(1.3) can0 586#60001A0000000000\n"
      "(1.4) can0 606#2F00180201000000\n(1.5) can0 586#6000180200000000\n"
      "(1.6) can0 606#2300180186010000\n(1.7) can0 586#6000180100000000\n";

  EXPECT_THAT(
      learned(log).text,
      HasSubstr(
          "      # 1: {cob_id: 0x186, transmission: 1}  the mapping is not in the recording\n"));
  EXPECT_THAT(learned(log).text, Not(HasSubstr("mapping: []")));
}

TEST(IncompleteRecording, WhatAMadeDeviceFileHoldsStandsInTheNetworkFileToo) {
  const LearnedNetwork network = learned(
      "(1.0) can0 000#8206\n(1.1) can0 706#00\n"
      "(1.2) can0 606#2F001A0001000000\n(1.3) can0 586#60001A0000000000\n"
      "(1.4) can0 606#23001A0110004160\n(1.5) can0 586#60001A0100000000\n"
      "(1.6) can0 606#2F00180602000000\n(1.7) can0 586#6000180600000000\n"
      "(1.8) can0 606#2B0018030A000000\n(1.9) can0 586#6000180300000000\n");

  EXPECT_THAT(network.text, HasSubstr("inhibit_time: 10, sync_start: 2"));
}

TEST(IncompleteRecording, AnInterpolationPeriodStaysWhereTheDeviceFileShowsNoDrive) {
  std::string log =
      "(1.0) can0 000#8206\n(1.1) can0 706#00\n"
      "(1.2) can0 606#4000100000000000\n(1.3) can0 586#4300100092010200\n"
      "(1.4) can0 606#2FC260010A000000\n(1.5) can0 586#60C2600100000000\n"
      "(1.6) can0 000#0106\n";
  for (int i = 10; i < 60; ++i) log += "(2." + std::to_string(i) + ") can0 080#\n";

  EXPECT_THAT(learned(log).text, HasSubstr("{index: 0x60C2, sub_index: 1, value: 10}"));
}

TEST(IncompleteRecording, AMappingAloneIsAPdo) {
  const std::string text = learned(
                               "(1.0) can0 000#8206\n(1.1) can0 706#00\n"
                               "(1.2) can0 606#2F001A0001000000\n(1.3) can0 586#60001A0000000000\n"
                               "(1.4) can0 606#23001A0110004160\n(1.5) can0 586#60001A0100000000\n")
                               .text;

  EXPECT_THAT(text, HasSubstr("      1: {mapping: [{index: 0x6041}]}\n"));
}

TEST(IncompleteRecording, AnEntryThatNoPdoHoldsIsNoMapping) {
  const std::string text = learned(
                               "(1.0) can0 000#8206\n(1.1) can0 706#00\n"
                               "(1.2) can0 606#2F001A0001000000\n(1.3) can0 586#60001A0000000000\n"
                               "(1.4) can0 606#23001A01C8004160\n(1.5) can0 586#60001A0100000000\n")
                               .text;

  EXPECT_THAT(text, HasSubstr("# 1: {}  the mapping is not in the recording\n"));
}

TEST(IncompleteRecording, ADeviceThatMakesSyncHasAPeriodThatCanBeSet) {
  const LearnedNetwork network = learned(
      "(1.0) can0 000#8206\n(1.1) can0 706#00\n"
      "(1.2) can0 606#2305100080000040\n(1.3) can0 586#6005100000000000\n"
      "(1.4) can0 606#4006100000000000\n(1.5) can0 586#4306100010270000\n");

  ASSERT_EQ(network.made_files.size(), 1U);
  const std::string& eds = network.made_files.begin()->second;
  const std::size_t period = eds.find("[1006]");
  ASSERT_NE(period, std::string::npos);
  EXPECT_THAT(eds.substr(period, 100), HasSubstr("AccessType=rw"));
}

TEST(IncompleteRecording, AMasterThatOnlyBootedUpBeforeTheCutIsNoDevice) {
  const LearnedNetwork network = learned(
      "(1.0) can0 77F#00\n(1.1) can0 000#8206\n(1.2) can0 706#00\n"
      "(1.3) can0 606#4000100000000000\n(1.4) can0 586#4300100092010200\n");

  EXPECT_THAT(network.text, HasSubstr("master:\n  node_id: 127\n"));
  EXPECT_THAT(network.text, Not(HasSubstr("node_127")));
}

TEST(IncompleteRecording, Node127ThatSendsFramesOfADeviceIsOneThoughNobodyAsksIt) {
  const std::string boots =
      "(1.0) can0 77F#00\n(1.1) can0 000#8206\n(1.2) can0 706#00\n"
      "(1.3) can0 606#4000100000000000\n(1.4) can0 586#4300100092010200\n";

  for (const char* frame :
       {"(1.5) can0 0FF#0010010000000000\n", "(1.5) can0 1FF#0102\n", "(1.5) can0 4FF#0102\n"}) {
    const LearnedNetwork network = learned(boots + frame);

    EXPECT_THAT(network.text, HasSubstr("master:\n  node_id: 126\n")) << frame;
    EXPECT_THAT(network.text, HasSubstr("node_127:")) << frame;
    EXPECT_TRUE(has_rule(network, "no-master-id")) << frame;
  }
  EXPECT_THAT(learned(boots + "(1.5) can0 27F#0102\n").text,
              HasSubstr("master:\n  node_id: 127\n"));
}

TEST(IncompleteRecording, HeartbeatsThatAreTooRareForAPeriodDoNotSayIt) {
  const std::string boot =
      "(1.0) can0 706#00\n(1.1) can0 606#4000100000000000\n(1.2) can0 586#4300100092010200\n";
  const std::string watched = "(1.3) can0 606#2316100196007F00\n(1.4) can0 586#6016100100000000\n";
  const auto beats = [](const char* id, int apart, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      text += "(" + std::to_string(2 + i * apart) + ".0) can0 " + id + "#05\n";
    }
    return text;
  };

  EXPECT_THAT(learned(boot + beats("77F", 100, 2)).text, HasSubstr("  heartbeat_producer: 100\n"));
  EXPECT_THAT(learned(boot + beats("77F", 100, 9)).text, HasSubstr("  heartbeat_producer: 100\n"));
  EXPECT_THAT(learned(boot + watched + beats("77F", 5, 2)).text,
              HasSubstr("  heartbeat_producer: 50\n"));
  EXPECT_THAT(learned(boot + watched + beats("77F", 5, 9)).text,
              HasSubstr("  heartbeat_producer: 5000\n"));
  EXPECT_THAT(learned(boot + beats("706", 100, 9)).text,
              HasSubstr("    heartbeat_producer: 0   # 0x1017 can't hold the measured time\n"));

  std::string guarding = boot;
  for (int i = 1; i < 9; ++i) guarding += "(" + std::to_string(i) + "00.0) can0 706#R1\n";
  EXPECT_THAT(learned(guarding).text, Not(HasSubstr("guard_time")));
}

TEST(IncompleteRecording, AMasterWhoseHeartbeatHasNoTimesIsNotSilent) {
  const std::string boot =
      "can0 77F [1] 00\ncan0 000 [2] 82 06\ncan0 706 [1] 00\n"
      "can0 606 [8] 40 00 10 00 00 00 00 00\ncan0 586 [8] 43 00 10 00 92 01 02 00\n";
  const std::string watched =
      "can0 606 [8] 23 16 10 01 96 00 7F 00\ncan0 586 [8] 60 16 10 01 00 00 00 00\n";
  const std::string heartbeat = "can0 77F [1] 05\n";

  EXPECT_THAT(learned(boot + heartbeat).text, HasSubstr("  heartbeat_producer: 100\n"));
  EXPECT_THAT(learned(boot + watched).text, HasSubstr("  heartbeat_producer: 50\n"));
  EXPECT_THAT(learned("(1.0) " + heartbeat + "(1.2) " + heartbeat + boot).text,
              HasSubstr("  heartbeat_producer: 200\n"));
  EXPECT_THAT(learned(boot).text, HasSubstr("  heartbeat_producer: 0\n"));
}

TEST(IncompleteRecording, TheMasterGetsAnIdThatNoDeviceHas) {
  const LearnedNetwork network = learned(
      "(1.1) can0 000#827F\n(1.2) can0 77F#00\n"
      "(1.3) can0 67F#4000100000000000\n(1.4) can0 5FF#4300100092010200\n");

  EXPECT_THAT(network.text, HasSubstr("master:\n  node_id: 126\n"));
  EXPECT_THAT(network.text, HasSubstr("    node_id: 127\n"));
}

TEST(IncompleteRecording, AFileForANodeThatIsNotThereIsReported) {
  DeviceFiles files;
  Findings findings;
  ASSERT_TRUE(files.assign(9, TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds", findings));
  std::istringstream in{"(1.1) can0 000#8206\n(1.2) can0 706#00\n"};

  const LearnedNetwork network = learned_network(read_recording(in, "boot.log", {}), files, {});

  EXPECT_TRUE(std::ranges::any_of(network.findings, [](const Finding& finding) {
    return finding.rule == "nobody-there" && finding.severity == Severity::warning;
  }));
}

TEST(IncompleteRecording, TimesThatAreDifferencesAreAnError) {
  std::string log = "(000.000000) can0 000#8206\n(000.100000) can0 706#00\n";
  for (int i = 0; i < 20; ++i) log += "(000.009500) can0 080#\n(000.000500) can0 186#11\n";

  std::istringstream in{log};
  EXPECT_TRUE(has_error(read_recording(in, "boot.log", {}).findings));
}

TEST(IncompleteRecording, OneStepBackInAFewFramesIsNoError) {
  std::istringstream in{"(2.0) can0 000#8206\n(1.9) can0 706#00\n(2.1) can0 706#05\n"};
  EXPECT_FALSE(has_error(read_recording(in, "boot.log", {}).findings));
}

TEST(IncompleteRecording, DatesAreTimesOfTheWallClock) {
  std::string log =
      "(2026-01-31 23:59:59.000000) can0 000#8206\n"
      "(2026-01-31 23:59:59.100000) can0 706#00\n";
  for (int i = 10; i < 60; ++i) {
    log += "(2026-02-01 00:00:00." + std::to_string(i) + "0000) can0 080#\n";
  }

  EXPECT_THAT(learned(log).text, HasSubstr("sync_period: 10000\n"));
}

}  // namespace
}  // namespace takt::learn
