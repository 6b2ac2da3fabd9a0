// The messages about a network file that can't be run or that would do something unintended.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>
#include <unistd.h>

#include "eds_parser/network_file/load_network.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class WrongNetwork : public testing::Test {
 protected:
  /// Returns the findings of `path`, one per line, without the folder.
  static std::string reported(const fs::path& path) {
    std::string text;
    for (Finding finding : load_network(path).findings) {
      finding.file = fs::path{finding.file}.filename();
      text += to_string(finding) + "\n";
    }
    return text;
  }
  std::string reported_of(const std::string& text) {
    return reported(folder_.write("net.yaml", text));
  }

  /// Returns the findings of a network with one node, which is an axis with these additional lines.
  std::string of_axis(const std::string& lines) {
    return reported_of(std::string{"master: {sync_period: 10000}\nnodes:\n  a:\n    node_id: 1\n"} +
                       "    dcf: " TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds\n" + lines);
  }

  const test::Folder folder_;
};

TEST_F(WrongNetwork, SafeValuesThatNoRpdoCarriesAreErrors) {
  EXPECT_THAT(of_axis("    safe_values: [{index: 0x6041, value: 1}]\n"),
              AllOf(HasSubstr("net.yaml:6:19: error"), HasSubstr("no RPDO carries 6041:00")));
  EXPECT_THAT(of_axis("    safe_values: [{index: 0x7777, value: 1}]\n"),
              HasSubstr("7777:00 is not in"));
}

TEST_F(WrongNetwork, SafeValuesAreNotToBlameForAnRpdoWithAnError) {
  EXPECT_THAT(of_axis("    rpdo: {1: {mapping: [{index: 607A}]}}\n"
                      "    safe_values: [{index: 0x607A, value: 1}]\n"),
              AllOf(HasSubstr("[not-a-number]"), Not(HasSubstr("[not-an-output]"))));
}

TEST_F(WrongNetwork, SafeValuesHaveToFitTheirObject) {
  EXPECT_THAT(of_axis("    rpdo: {1: {mapping: [{index: 0x607A}]}}\n"
                      "    safe_values: [{index: 0x607A, value: 99999999999}]\n"),
              HasSubstr("607A:00 Target position (INTEGER32) does not hold 99999999999"));
}

TEST_F(WrongNetwork, UnitsOfAnObjectThatTheDeviceHasNotAreErrors) {
  EXPECT_THAT(of_axis("    units: {objects: [{index: 0x9999, scale: 2}]}\n"),
              AllOf(HasSubstr("`units: objects` of node `a`"), HasSubstr("9999:00 is not in")));
}

TEST_F(WrongNetwork, TheRestOfANodeIsJudgedThoughItsIdIsWrongOrTaken) {
  const std::string text = reported_of(
      "nodes:\n"
      "  a: {node_id: 1, dcf: " TAKT_SOURCE_DIR
      "/share/eds/takt_drive402.eds}\n"
      "  b: {node_id: 130, dcf: nope.eds}\n"
      "  c:\n"
      "    node_id: 1\n"
      "    dcf: " TAKT_SOURCE_DIR
      "/share/eds/takt_drive402.eds\n"
      "    tpdo: {1: {mapping: [{index: 0x7777}]}}\n"
      "    sdo: [{index: 0x8888, value: 1}]\n");

  EXPECT_THAT(text, AllOf(HasSubstr("net.yaml:3:16: error"), HasSubstr("net.yaml:3:26: error"),
                          HasSubstr("`nope.eds` not found")));
  EXPECT_THAT(text, AllOf(HasSubstr("net.yaml:5:14: error"), HasSubstr("net.yaml:7:26: error"),
                          HasSubstr("net.yaml:8:11: error")));
}

TEST_F(WrongNetwork, IdentifiersOfServicesClashWithPdosAndWithEachOther) {
  const std::string drive = "dcf: " TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds";
  const auto two = [&](const std::string& master, const std::string& a, const std::string& b) {
    return reported_of("master: {sync_period: 10000" + master + "}\nnodes:\n  a: {node_id: 5, " +
                       drive + a + "}\n  b: {node_id: 6, " + drive + b + "}\n");
  };
  const std::string pdo = ", tpdo: {1: {cob_id: ";

  EXPECT_THAT(two(", time_period: 1000, time_cob_id: 0x185", pdo + "0x185}}", ""),
              HasSubstr("`cob_id` 0x185 of TPDO1 of node `a` is TIME"));
  EXPECT_THAT(two("", ", emcy_cob_id: 0x186", pdo + "0x186}}"),
              HasSubstr("`cob_id` 0x186 of TPDO1 of node `b` is EMCY of node `a`"));
  EXPECT_THAT(two("", ", sdo_channel: {request: 0x645, answer: 0x6C5}", pdo + "0x6C5}}"),
              HasSubstr("is in the SDO channel of node `a`"));
  EXPECT_THAT(two(", sync_cob_id: 0x86", "", ""), HasSubstr("EMCY (1014) of `b` 0x086 is SYNC"));
  EXPECT_THAT(two("", ", emcy_cob_id: 0x86", ""), HasSubstr("is EMCY of node `a`"));
  EXPECT_THAT(two("", "", ""), Not(HasSubstr("error")));
}

TEST_F(WrongNetwork, NumbersAndAllAreNoNamesOfNodes) {
  const std::string file =
      "nodes:\n  5: {node_id: 6, dcf: x.eds}\n  all: {node_id: 7, dcf: x.eds}\n";

  EXPECT_THAT(reported_of(file),
              AllOf(HasSubstr("net.yaml:2:3: error: `5` can't be the name of a node"),
                    HasSubstr("net.yaml:3:3: error: `all` can't be the name of a node")));
}

TEST_F(WrongNetwork, AnInterfaceHasTheLengthThatLinuxTakes) {
  EXPECT_THAT(reported_of("bus: {interface: averyveryverylonginterface}\n"),
              HasSubstr("[interface]"));
  EXPECT_THAT(reported_of("bus: {interface: \"unix:\"}\n"), HasSubstr("[interface]"));
  EXPECT_THAT(reported_of("bus: {interface: unix:/run/bus}\n"), Not(HasSubstr("[interface]")));
  EXPECT_THAT(reported_of("bus: {interface: can0}\n"), Not(HasSubstr("[interface]")));
}

TEST_F(WrongNetwork, AFolderIsCalledAFolder) {
  EXPECT_THAT(reported(folder_.path()), HasSubstr("is a folder; name the network file"));
  EXPECT_THAT(reported(folder_ / "none.yaml"), HasSubstr("there is no such file"));
  EXPECT_THAT(reported_of("nodes: {a: {node_id: 1, dcf: .}}\n"), HasSubstr("`.` is a folder"));
  EXPECT_THAT(reported_of("nodes: {a: {node_id: 1, dcf: /dev/zero}}\n"),
              HasSubstr("`/dev/zero` is not a regular file"));
}

TEST_F(WrongNetwork, OfAFileThatIsNoEdsOnlyThatIsReported) {
  std::string noise;
  for (int i = 0; i < 200; ++i) noise += "no key and no section\n";
  folder_.write("noise.eds", noise);

  const std::string text = reported_of("nodes: {a: {node_id: 1, dcf: noise.eds}}\n");

  EXPECT_THAT(text, HasSubstr("the file is not an EDS or DCF"));
  EXPECT_LE(std::ranges::count(text, '\n'), 3);
}

TEST_F(WrongNetwork, AnEdsThatIsCutOffIsAWarning) {
  std::ostringstream eds;
  eds << std::ifstream{TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds"}.rdbuf();
  folder_.write("half.eds", eds.str().substr(0, eds.str().size() / 2));

  EXPECT_THAT(reported_of("nodes: {a: {node_id: 1, dcf: half.eds}}\n"),
              AllOf(HasSubstr("half.eds: warning"), HasSubstr("is the file cut off?")));
}

TEST_F(WrongNetwork, ATabIsCalledATab) {
  EXPECT_THAT(reported_of("bus:\n\tname: t\n"),
              AllOf(HasSubstr("net.yaml:2:"), HasSubstr("the line begins with a tab")));
  EXPECT_THAT(reported_of("nodes:\n  a: {node_id: 1\n"), Not(HasSubstr("tab")));
}

TEST_F(WrongNetwork, WhatFollowsFromAWrongSyncPeriodIsNotReported) {
  const std::string axis =
      "nodes: {a: {node_id: 1, dcf: " TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds}}\n";

  EXPECT_THAT(reported_of("master: {sync_period: 2ms}\n" + axis),
              AllOf(HasSubstr("`2ms` is not a whole number"), Not(HasSubstr("[no-sync]"))));
  EXPECT_THAT(reported_of("master: {sync_period: 2}\n" + axis),
              AllOf(HasSubstr("for 2 ms write 2000"), Not(HasSubstr("[does-not-fit]"))));
}

TEST_F(WrongNetwork, ANodeThatIsNoMapLacksNothingElse) {
  const std::string text = reported_of("nodes: {a: 5, b: [1, 2]}\n");

  EXPECT_THAT(
      text, AllOf(HasSubstr("node `a` has to be a map (`key: value`), but this is a single value"),
                  HasSubstr("this is a list"), Not(HasSubstr("lacks"))));
}

TEST_F(WrongNetwork, AnUnknownModelOrQuirkOfTheSimulationIsAnErrorThatListsWhatThereIs) {
  EXPECT_THAT(
      of_axis("    sim: {model: drive420}\n"),
      AllOf(HasSubstr("net.yaml:6:18: error: `model`: `drive420` is not one of plain, drive402"),
            HasSubstr("did you mean `drive402`?")));
  EXPECT_THAT(of_axis("    sim: {quirks: [no_bootup, mute]}\n"),
              AllOf(HasSubstr("net.yaml:6:31: error: `quirks`: `mute` is not one of late_bootup"),
                    HasSubstr("mute_sdo, mute_pdo"), HasSubstr("loopback")));
  EXPECT_THAT(of_axis("    sim: {quirks: {mute_sdo: true}}\n"), HasSubstr("net.yaml:6:19: error"));
  EXPECT_THAT(of_axis("    sim: {quirks: mute_sdo}\n"), Not(HasSubstr("error")));
}

TEST_F(WrongNetwork, AWrongLcmUrlIsAnErrorOfTheFile) {
  EXPECT_THAT(
      reported_of("lcm: {url: \"upd://1.2.3.4\"}\n"),
      AllOf(HasSubstr("net.yaml:1:12: error: `url` of `lcm`"), HasSubstr("expected udpm://")));
  EXPECT_THAT(reported_of("lcm: {url: \"tcpq://127.0.0.1:99999\"}\n"), HasSubstr("0..65535"));
  EXPECT_THAT(reported_of("black_box: {folder: a, size_mb: 0}\n"), HasSubstr("1..1024 MiB"));
  EXPECT_THAT(reported_of("black_box: {dir: a}\n"), HasSubstr("`dir`"));
  EXPECT_THAT(reported_of("black_box: {folder: \"\"}\n"), HasSubstr("`folder` is empty"));
  EXPECT_THAT(reported_of("lcm: {url: \"udpm://239.255.76:7667\"}\n"), HasSubstr("dotted"));
}

TEST_F(WrongNetwork, TheHighBitsOfACobIdAreExplained) {
  const auto tpdo = [this](const std::string& keys) {
    return of_axis("    tpdo: {1: {" + keys + "}}\n");
  };

  EXPECT_THAT(tpdo("cob_id: 0x80000181"), AllOf(HasSubstr("net.yaml:6:24: warning"),
                                                HasSubstr("bit 31 set: the PDO is switched "
                                                          "off"),
                                                HasSubstr("0x181 switches the PDO on")));
  EXPECT_THAT(
      tpdo("cob_id: 0x40000181"),
      AllOf(HasSubstr("net.yaml:6:24: note"), HasSubstr("leaves this bit as it is in the device")));
  EXPECT_THAT(tpdo("cob_id: 0x40000181, poll_ms: 100, transmission: 253"),
              AllOf(HasSubstr("net.yaml:6:24: error"), HasSubstr("clear the bit")));
  EXPECT_THAT(tpdo("cob_id: 0x20000181"),
              AllOf(HasSubstr("net.yaml:6:24: warning"), HasSubstr("identifier 0x00000181")));
  EXPECT_THAT(of_axis("    rpdo: {1: {cob_id: 0x40000201}}\n"),
              AllOf(HasSubstr("net.yaml:6:24: warning"), HasSubstr("no meaning for an RPDO")));
}

}  // namespace
}  // namespace takt
