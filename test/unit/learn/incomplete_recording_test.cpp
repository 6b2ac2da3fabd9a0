// Recordings that begin in the middle, lack frames, or leave things unsaid.
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>
#include <unistd.h>

#include "apps/learn/network_text.hpp"
#include "apps/learn/recording.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

LearnedNetwork learned(const std::string& text) {
  std::istringstream in{text};
  return learned_network(read_recording(in, "boot.log", {}), {}, {});
}

TEST(IncompleteRecording, ADeviceWhoseHeartbeatIsHeardHas1017ThoughNobodyWroteIt) {
  std::string log = "(1.0) can0 000#8206\n(1.1) can0 706#00\n";
  for (int i = 12; i < 30; ++i) log += "(" + std::to_string(i) + ".0) can0 706#05\n";
  const LearnedNetwork network = learned(log);
  const fs::path folder = fs::temp_directory_path() / ("takt_cut_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream{folder / "net.yaml"} << network.text;
  for (const auto& [name, text] : network.made_files) std::ofstream{folder / name} << text;

  const LoadedNetwork again = load_network(folder / "net.yaml");
  fs::remove_all(folder);

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
          "      # 1: {cob_id: 0x186, transmission: 1}  its mapping is not in the recording\n"));
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

  EXPECT_THAT(text, HasSubstr("# 1: {}  its mapping is not in the recording\n"));
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
}  // namespace takt
