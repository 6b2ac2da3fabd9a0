#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>
#include <unistd.h>

#include "apps/takt/learn/network_text.hpp"
#include "apps/takt/learn/recording.hpp"
#include "apps/takt/simulate/simulation.hpp"
#include "eds_parser/network_file/keys/read_devices.hpp"
#include "eds_parser/read/eds.hpp"
#include "test/support/folder.hpp"

namespace takt::learn {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

const std::string data = TAKT_SOURCE_DIR "/test/unit/apps/takt/learn/data/";

LearnedBus heard(const std::string& text) {
  std::istringstream in{text};
  return read_recording(in, "boot.log", {});
}

LearnedNetwork learned(const std::string& text, const DeviceFiles& files = {}) {
  return learned_network(heard(text), files, {});
}

std::string whole(const std::string& path) {
  std::ifstream in{path};
  return {std::istreambuf_iterator<char>{in}, {}};
}

DeviceFiles our_files() {
  DeviceFiles files;
  Findings findings;
  files.add_folder(TAKT_SOURCE_DIR "/share/eds", findings);
  return files;
}

std::string rules(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) text += to_string(finding) + '\n';
  return text;
}

/// Returns everything that a plan does on the bus, without the names and purposes of steps.
std::string on_the_bus(const BusPlan& plan) {
  std::ostringstream out;
  out << plan.cycle.period.count() << ' ' << int{plan.cycle.sync_overflow} << ' '
      << plan.cycle.sync_cob_id.id() << ' ' << plan.master_heartbeat.count() << '\n';
  for (const NodePlan& node : plan.nodes) {
    out << "node " << int{node.id.value()} << ' ' << node.heartbeat_timeout.count() << ' '
        << node.guard.period.count() << '\n';
    for (const BootStep& step : node.boot_plan.steps) {
      // Limits of commands are internal to the master, so a recording does not show the limits of
      // the file.
      if (step.action == BootAction::read_limit) continue;
      out << "  " << int(step.action) << ' ' << to_string(step.object) << ' ' << step.mask;
      for (const std::byte byte : step.value) out << ' ' << std::to_integer<int>(byte);
      out << '\n';
    }
  }
  for (const auto* rows : {&plan.pdos.rpdos, &plan.pdos.tpdos}) {
    for (const PdoRow& row : *rows) {
      out << "pdo " << row.number << ' ' << row.cob_id.id() << ' ' << int{row.transmission} << ' '
          << int{row.length};
      if (rows == &plan.pdos.tpdos) {  // the master's times are visible only in sent frames
        out << ' ' << row.inhibit.count() << ' ' << row.event_timer.count();
      }
      for (std::uint16_t i = 0; i < row.field_count; ++i) {
        const PdoField& field = plan.pdos.fields[row.first_field + i];
        out << ' ' << to_string(plan.layout.signals[field.signal].object) << '@'
            << int{field.bit_offset} << '+' << int{field.bits};
      }
      out << '\n';
    }
  }
  return out.str();
}

class RoundTrip : public testing::TestWithParam<const char*> {};

TEST_P(RoundTrip, WhatIsLearnedFromABootDoesTheSameOnTheBus) {
  const test::Folder folder;
  const LoadedNetwork original =
      load_network(TAKT_SOURCE_DIR "/share/demo/" + std::string{GetParam()} + ".yaml");
  const std::string log = folder / "boot.log";
  simulate(original, {.duration = std::chrono::seconds{8}, .candump = log});
  Findings findings;
  LearnOptions options{.bitrate_kbit = original.plan.bitrate / 1000,
                       .folder = folder.path(),
                       .device_data = load_device_data(device_folders(), findings)};

  const LearnedNetwork network = learned_network(heard(whole(log)), our_files(), options);
  const LoadedNetwork again = load_network(folder.write("net.yaml", network.text));

  EXPECT_FALSE(has_error(again.findings)) << rules(again.findings) << network.text;
  EXPECT_EQ(on_the_bus(again.plan), on_the_bus(original.plan)) << network.text;
  EXPECT_TRUE(network.made_files.empty());
}

TEST_P(RoundTrip, WithoutDeviceFilesTheMadeOnesMakeAValidNetwork) {
  const test::Folder folder;
  const LoadedNetwork original =
      load_network(TAKT_SOURCE_DIR "/share/demo/" + std::string{GetParam()} + ".yaml");
  const std::string log = folder / "boot.log";
  simulate(original, {.duration = std::chrono::seconds{8}, .candump = log});

  const LearnedNetwork network =
      learned_network(heard(whole(log)), {}, {.bitrate_kbit = original.plan.bitrate / 1000});
  for (const auto& [name, content] : network.made_files) {
    folder.write(name, content);
    EXPECT_FALSE(has_error(read_eds(content, name).findings))
        << rules(read_eds(content, name).findings);
  }
  const LoadedNetwork again = load_network(folder.write("net.yaml", network.text));

  EXPECT_FALSE(has_error(again.findings)) << rules(again.findings) << network.text;
  EXPECT_EQ(again.plan.nodes.size(), original.plan.nodes.size());
}

INSTANTIATE_TEST_SUITE_P(Demos, RoundTrip,
                         testing::Values("two_axes", "sixteen_nodes", "lenze8400", "lenze8400_sync",
                                         "beckhoff", "plain301", "astraada_drv28"));

TEST(Learn, ReadsABootByPythonCanopen) {
  const LearnedNetwork network = learned(whole(data + "python_canopen.log"), our_files());

  EXPECT_THAT(network.text, HasSubstr("node_id: 127"));
  EXPECT_THAT(network.text, HasSubstr("  sync_period: 10000\n"));
  EXPECT_THAT(network.text, HasSubstr("    reset: node\n"));
  EXPECT_THAT(network.text, HasSubstr("    heartbeat_producer: 250\n"));
  EXPECT_THAT(network.text, HasSubstr("      1: {cob_id: 0x185, transmission: 1, "
                                      "mapping: [{index: 0x6041}, {index: 0x6064}]}\n"));
  EXPECT_THAT(network.text, HasSubstr("    sdo:\n"
                                      "      - {index: 0x6081, sub_index: 0, value: 100000}\n"
                                      "      - {index: 0x6060, sub_index: 0, value: 8}\n"));
}

TEST(Learn, SaysWhatIsNoPartOfTheBoot) {
  const LearnedNetwork network = learned(whole(data + "python_canopen.log"), our_files());

  EXPECT_THAT(network.text, HasSubstr("#   1081:60 = A0 86 01 00  06020000 object does not exist"));
  EXPECT_THAT(network.text, HasSubstr("# sent while OPERATIONAL, so not part of the boot:\n"
                                      "    #   6040:00 = 06"));
  EXPECT_THAT(
      network.text,
      HasSubstr(
          "#   0x2A0 (TPDO2 of node 32 by the predefined connection set, the mapping is not in "
          "the recording): 1 frames of 5 bytes"));
  EXPECT_THAT(rules(network.findings), HasSubstr("[unknown-traffic]"));
}

TEST(Learn, TakesTheFileThatTheUserNamesForANode) {
  DeviceFiles files;
  Findings findings;
  ASSERT_TRUE(files.assign(9, TAKT_SOURCE_DIR "/share/eds/takt_io401.eds", findings));

  const LearnedNetwork network = learned("(1.0) can0 709#00\n(1.1) can0 709#7F\n", files);

  EXPECT_THAT(network.text, HasSubstr("takt_io401.eds\"\n"));
  EXPECT_TRUE(network.made_files.empty());
}

TEST(Learn, FindsTheMasterByWhatTheDevicesWatch) {
  const LearnedNetwork network = learned(
      "(1.00) can0 701#05\n(1.10) can0 701#05\n(1.20) can0 701#05\n(1.30) can0 701#05\n"
      "(1.31) can0 702#00\n"
      "(1.32) can0 602#2316100190010100\n(1.33) can0 582#6016100100000000\n");

  EXPECT_THAT(network.text, HasSubstr("master:\n  node_id: 1\n  heartbeat_producer: 100\n"));
  EXPECT_THAT(network.text, HasSubstr("    heartbeat_multiplier: 4\n"));
  EXPECT_THAT(network.text, Not(HasSubstr("node_1:")));
}

TEST(Learn, LearnsGuarding) {
  std::string log = "(0.9) can0 000#8203\n(0.95) can0 703#00\n";
  for (int i = 0; i < 6; ++i) {
    log += "(1." + std::to_string(i) + ") can0 703#R1\n(1." + std::to_string(i) + "01) can0 703#" +
           (i % 2 == 0 ? "7F" : "FF") + "\n";
  }
  log += "(2.0) can0 603#2F0D100003000000\n(2.01) can0 583#600D100000000000\n";

  const LearnedNetwork network = learned(log);

  EXPECT_THAT(network.text, HasSubstr("heartbeat_producer: 0"));
  EXPECT_THAT(network.text, HasSubstr("    guard_time: 100\n    life_time_factor: 3\n"));
}

TEST(Learn, LearnsTheSyncCounterAndAnotherProducer) {
  const LearnedNetwork network = learned(
      "(1.000) can0 604#2305100080000040\n(1.001) can0 584#6005100000000000\n"
      "(1.002) can0 604#2F19100004000000\n(1.003) can0 584#6019100000000000\n"
      "(2.000) can0 080#01\n(2.005) can0 080#02\n(2.010) can0 080#03\n(2.015) can0 080#04\n"
      "(2.020) can0 080#01\n");

  EXPECT_THAT(network.text, HasSubstr("  sync_period: 5000\n  sync_overflow: 4\n"));
  EXPECT_THAT(network.text, HasSubstr("  sync_source: node_4\n"));
}

TEST(Learn, ThreeSyncsAreEnoughForAPeriodWithANote) {
  const LearnedNetwork network =
      learned("(2.000) can0 080#\n(2.005) can0 080#\n(2.010) can0 080#\n");

  EXPECT_THAT(network.text, HasSubstr("  sync_period: 5000\n"));
  EXPECT_THAT(rules(network.findings), HasSubstr("3 frames of SYNC do not show"));
}

TEST(Learn, WhereSyncsAreTooFewThePeriodIsThatOfAnSdoWrite) {
  const LearnedNetwork network = learned(
      "(1.000) can0 604#23061000D0070000\n(1.001) can0 584#6006100000000000\n"
      "(2.000) can0 080#\n");

  EXPECT_THAT(network.text, HasSubstr("  sync_period: 2000\n"));
  EXPECT_THAT(rules(network.findings), HasSubstr("takt uses the value that was written to 0x1006"));
}

TEST(Learn, OneSyncAloneIsListed) {
  const LearnedNetwork network = learned("(2.000) can0 080#\n");

  EXPECT_THAT(network.text, Not(HasSubstr("sync_period")));
  EXPECT_THAT(network.text, HasSubstr("#   0x080: 1 frames of 0 bytes"));
  EXPECT_THAT(rules(network.findings), HasSubstr("warning: 1 frames of SYNC do not show"));
}

TEST(Learn, FewFramesOfTimeAreAPeriodOrListed) {
  const LearnedNetwork two = learned("(1.0) can0 100#FF5B26054D39\n(2.0) can0 100#FF5B26054D39\n");
  const LearnedNetwork one = learned("(1.0) can0 100#FF5B26054D39\n");

  EXPECT_THAT(two.text, HasSubstr("  time_period: 1000\n"));
  EXPECT_THAT(rules(two.findings), HasSubstr("2 frames of TIME do not show"));
  EXPECT_THAT(one.text, Not(HasSubstr("  time_period:")));
  EXPECT_THAT(one.text, HasSubstr("# 1 frames of TIME (0x100)"));
}

TEST(Learn, TimesThatNoNetworkFileMayHaveAreListed) {
  const std::string first = "(1.0) can0 100#FF5B26054D39\n";

  for (const char* second : {"1.05", "200000.0"}) {
    const LearnedNetwork network =
        learned(first + "(" + second + ") can0 100#FF5B26054D39\n(300000.0) can0 706#05\n");

    EXPECT_THAT(network.text, Not(HasSubstr("  time_period:"))) << second;
    EXPECT_THAT(network.text, HasSubstr("# 2 frames of TIME (0x100)")) << second;
    EXPECT_THAT(rules(network.findings), HasSubstr("2 frames of TIME do not show")) << second;
  }
}

std::string syncs(const std::vector<std::string>& counters) {
  std::string log;
  for (std::size_t i = 0; i < counters.size(); ++i) {
    log += "(2." + std::to_string(100 + 5 * i) + ") can0 080#" + counters[i] + '\n';
  }
  return log;
}

/// Makes log lines with a write to 0x1019 of a node.
std::string counter_of(unsigned node, const std::string& overflow) {
  const std::string id = std::to_string(node);
  return "(1.0) can0 60" + id + "#2F191000" + overflow + "000000\n(1.1) can0 58" + id +
         "#6019100000000000\n";
}

TEST(Learn, ASyncWithoutCounterHasNoneWhateverADeviceWasReported) {
  const LearnedNetwork network = learned(counter_of(4, "0A") + syncs({"", "", "", "", ""}));

  EXPECT_THAT(network.text, HasSubstr("  sync_period: 5000\n"));
  EXPECT_THAT(network.text, Not(HasSubstr("sync_overflow")));
}

TEST(Learn, TheCounterTurnsOverWhereMostDevicesWereReportedOfThoseItReached) {
  const LearnedNetwork network = learned(
      counter_of(4, "0A") + counter_of(5, "0A") + counter_of(6, "F0") + counter_of(7, "02") +
      counter_of(8, "02") + counter_of(9, "02") + syncs({"01", "02", "03", "04", "05"}));

  EXPECT_THAT(network.text, HasSubstr("  sync_overflow: 10\n"));
}

TEST(Learn, ACounterThatNoNetworkFileMayHaveIsNotLearned) {
  const LearnedNetwork network = learned(syncs({"01", "01", "01", "01", "01"}));

  EXPECT_THAT(network.text, HasSubstr("  sync_overflow: 2\n"));
}

TEST(Learn, AResetOfAllCountsForNodesThatAreMetLater) {
  const std::string boot =
      "(1.1) can0 705#00\n(1.2) can0 605#2B17100064000000\n(1.3) can0 585#6017100000000000\n";

  EXPECT_THAT(learned("(1.0) can0 000#8100\n" + boot).text, HasSubstr("    reset: node\n"));
  EXPECT_THAT(learned("(0.9) can0 000#8100\n(1.0) can0 000#8200\n" + boot).text,
              Not(HasSubstr("    reset: node\n")));
}

TEST(Learn, LearnsHowOftenTheMasterRepeatsAnRpdo) {
  std::string log =
      "(1.0) can0 603#2300140103020000\n(1.1) can0 583#6000140100000000\n"
      "(1.2) can0 603#2F001402FE000000\n(1.3) can0 583#6000140200000000\n";
  for (int i = 0; i < 5; ++i) log += "(2." + std::to_string(i) + ") can0 203#01\n";

  const LearnedNetwork network = learned(log);

  EXPECT_THAT(network.text, HasSubstr("cob_id: 0x203, transmission: 254, event_timer: 100"));
}

TEST(Learn, ASecondBootThatChangesNothingTakesNothingAway) {
  const LearnedNetwork network = learned(
      "(1.0) can0 000#8206\n(1.1) can0 706#00\n"
      "(1.2) can0 606#2B17100064000000\n(1.3) can0 586#6017100000000000\n"
      "(1.4) can0 606#2F00200007000000\n(1.5) can0 586#6000200000000000\n"
      "(1.6) can0 000#0106\n"
      "(2.0) can0 000#8206\n(2.1) can0 706#00\n"
      "(2.2) can0 606#4017100000000000\n(2.3) can0 586#4B17100064000000\n(2.4) can0 000#0106\n");

  EXPECT_THAT(network.text, HasSubstr("    heartbeat_producer: 100\n"));
  EXPECT_THAT(network.text, HasSubstr("      - {index: 0x2000, sub_index: 0, value: 7}\n"));
}

TEST(Learn, AnObjectWrittenTwiceStaysTwiceInItsOrder) {
  const LearnedNetwork network = learned(
      "(1.0) can0 606#2F00200001000000\n(1.1) can0 586#6000200000000000\n"
      "(1.2) can0 606#2F01200005000000\n(1.3) can0 586#6001200000000000\n"
      "(1.4) can0 606#2F00200002000000\n(1.5) can0 586#6000200000000000\n");

  EXPECT_THAT(network.text,
              HasSubstr("- {index: 0x2000, sub_index: 0, value: 1}\n"
                        "      - {index: 0x2001, sub_index: 0, value: 5}\n"
                        "      - {index: 0x2000, sub_index: 0, value: 2, again: true}"));
}

TEST(PeriodMeter, FindsTheTimeThatSomebodyWrote) {
  EXPECT_EQ(as_configured(1999), 2000);
  EXPECT_EQ(as_configured(10'012), 10'000);
  EXPECT_EQ(as_configured(1252), 1250);
  EXPECT_EQ(as_configured(333), 333);
  EXPECT_EQ(as_configured(0), 0);
}

}  // namespace
}  // namespace takt::learn
