#include "eds_parser/network_file/keys/read_network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using test::Compiled;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Compiled read(std::string_view yaml) {
  Compiled out;
  out.spec = read_network(yaml, "net.yaml", out.findings);
  return out;
}

constexpr std::string_view one_node = "nodes: {arm: {node_id: 5, dcf: tiny.eds}}\n";

std::string with_node(std::string_view text) { return std::string{text} + std::string{one_node}; }

TEST(ReadNetwork, NodesMayStandAtTopLevelAndUnderNodes) {
  const auto net = read(
      "master: {node_id: 1, sync_period: 10000}\n"
      "joint_1: {node_id: 2, dcf: a.eds}\n"
      "nodes:\n"
      "  joint_2: {node_id: 0x3, dcf: b.eds}\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  ASSERT_EQ(net.spec.nodes.size(), 2U);
  EXPECT_EQ(net.spec.nodes[0].name, "joint_1");
  EXPECT_EQ(*net.spec.nodes[1].id, 3);
  EXPECT_EQ(net.spec.nodes[1].id.pos, (SourcePos{4, 22}));
  EXPECT_EQ(*net.spec.master.sync_period_us, 10000U);
}

TEST(ReadNetwork, DefaultsFillWhatANodeDoesNotSay) {
  const auto net = read(
      "defaults: {dcf: a.eds, heartbeat_producer: 50, mandatory: true}\n"
      "nodes:\n"
      "  one: {node_id: 1}\n"
      "  two: {node_id: 2, dcf: b.eds, mandatory: false}\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(*net.spec.nodes[0].dcf, "a.eds");
  EXPECT_EQ(*net.spec.nodes[1].dcf, "b.eds");
  EXPECT_EQ(*net.spec.nodes[1].heartbeat_producer, 50);
  EXPECT_FALSE(*net.spec.nodes[1].mandatory);
}

TEST(ReadNetwork, KeysOfOtherReadersGiveANoteOnceAndNoError) {
  const auto net = read(
      "defaults: {dcf: a.eds, driver: x, polling: true, scale_pos_from_dev: 0.001}\n"
      "nodes: {one: {node_id: 1}, two: {node_id: 2}}\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.findings.size(), 3U);
  EXPECT_THAT(net.declared("unused-key"), HasSubstr("units: {position: {scale"));
}

TEST(ReadNetwork, KeysThatHaveNoEffectOnTheMasterSayWhy) {
  const auto net = read(
      "master: {emcy_inhibit_time: 100, error_behavior: {1: 0}, sdo_timeout_ms: 100}\n"
      "nodes: {one: {node_id: 1, dcf: a.eds}}\n");
  const std::string declared = net.declared("unused-key");

  EXPECT_THAT(declared,
              HasSubstr("`emcy_inhibit_time` of `master` has no effect: the master sends no "
                        "EMCY"));
  EXPECT_THAT(declared,
              HasSubstr("`error_behavior` of `master` has no effect: the master has no 0x1029"));
  EXPECT_THAT(declared,
              HasSubstr("`sdo_timeout_ms` of `master` has no effect: write it under the nodes"));
}

TEST(ReadNetwork, QuotedNumbersAndBooleansAreRead) {
  const auto net = read(
      "nodes:\n"
      "  arm:\n"
      "    node_id: \"5\"\n"
      "    dcf: a.eds\n"
      "    tpdo: {\"1\": {enabled: \"false\", transmission: \"0x01\"}}\n");

  EXPECT_THAT(net.complaints(), ElementsAre("5:27 warning [quoted]"));
  EXPECT_EQ(*net.spec.nodes[0].id, 5);
  EXPECT_FALSE(*net.spec.nodes[0].tpdos[0].enabled);
  EXPECT_EQ(*net.spec.nodes[0].tpdos[0].transmission, 1);
}

TEST(ReadNetwork, UnknownKeysGetASuggestion) {
  const auto net = read(
      "master: {baud_rate: 500}\n"
      "nodes:\n"
      "  arm: {node_id: 5, eds: a.eds, dcf: b.eds}\n"
      "mastr: {}\n");

  EXPECT_THAT(net.complaints(), ElementsAre("1:10 error [unknown-key]", "4:1 error [unknown-key]",
                                            "3:21 error [unknown-key]"));
  EXPECT_THAT(net.declared("unknown-key"), HasSubstr("did you mean `baudrate`?"));
  EXPECT_THAT(net.declared("unknown-key"), HasSubstr("did you mean `master`?"));
}

TEST(ReadNetwork, ABaudrateThatCanOnlyBeBitsPerSecondIsTakenForThat) {
  const auto net = read(with_node("master: {baudrate: 500000}\n"));

  EXPECT_THAT(net.complaints(), ElementsAre("1:20 warning [unit]"));
  EXPECT_THAT(net.declared("unit"), HasSubstr("kbit/s"));
  EXPECT_THAT(net.declared("unit"), HasSubstr("write 500"));
  EXPECT_EQ(*net.spec.master.baudrate_kbit, 500U);
}

TEST(ReadNetwork, ABitRateOutOfRangeIsRefusedWithASentence) {
  const auto odd = read(with_node("master: {baudrate: 512000}\n"));
  const auto own = read(with_node("bus: {bitrate_kbit: 500000}\n"));

  EXPECT_THAT(odd.complaints(), ElementsAre("1:20 error [unit]"));
  EXPECT_THAT(own.complaints(), ElementsAre("1:21 error [unit]"));
  EXPECT_THAT(own.declared("unit"), HasSubstr("write 500"));
}

TEST(ReadNetwork, ASyncPeriodInMillisecondsIsRefusedWithASentence) {
  const auto net = read(with_node("master: {sync_period: 10}\n"));

  EXPECT_THAT(net.complaints(), ElementsAre("1:23 error [unit]"));
  EXPECT_THAT(net.declared("unit"), HasSubstr("for 10 ms write 10000"));
}

TEST(ReadNetwork, LeadingZerosAreReportedNotGuessed) {
  const auto net = read("nodes: {arm: {node_id: 010, dcf: a.eds}}\n");

  EXPECT_THAT(net.complaints(), ElementsAre("1:24 error [octal]"));
  EXPECT_THAT(net.declared("octal"), HasSubstr("octal to some YAML readers"));
}

TEST(ReadNetwork, RangesAreChecked) {
  const auto net = read(
      "master: {node_id: 128, sync_overflow: 1, heartbeat_producer: -1}\n"
      "realtime: {priority: 100, mode: hard}\n"
      "nodes:\n"
      "  arm:\n"
      "    node_id: 0\n"
      "    dcf: a.eds\n"
      "    heartbeat_multiplier: 1.0\n"
      "    tpdo: {513: {}, 1: {transmission: 245, sync_start: 241}, 2: {transmission: 253}}\n"
      "    rpdo: {1: {inhibit_time: 65536, event_timer: x}}\n");

  EXPECT_THAT(net.complaints(),
              ElementsAre("2:33 error [unknown-value]", "2:22 error [out-of-range]",
                          "1:19 error [out-of-range]", "1:62 error [out-of-range]",
                          "1:39 error [out-of-range]", "5:14 error [out-of-range]",
                          "7:27 error [out-of-range]", "8:12 error [out-of-range]",
                          "8:56 error [out-of-range]", "8:39 error [transmission-type]",
                          "9:30 error [out-of-range]", "9:50 error [not-a-number]"));
}

TEST(ReadNetwork, WrongShapesSayWhatIsExpected) {
  const auto net = read(
      "nodes:\n"
      "  arm: {node_id: 1, dcf: a.eds, heartbeat_consumer: {1: 100}, sdo: {index: 1}}\n"
      "  leg: [1]\n"
      "  eye: {node_id: [2], dcf: a.eds, tpdo: {1: {mapping: {index: 1}}}}\n");

  EXPECT_THAT(net.declared("wrong-type"),
              HasSubstr("`heartbeat_consumer` has to be true or false"));
  EXPECT_THAT(net.declared("wrong-type"), HasSubstr("node `leg` has to be a map"));
  EXPECT_THAT(net.declared("wrong-type"),
              HasSubstr("`node_id` has to be a number, but this is a list"));
  EXPECT_THAT(net.declared("wrong-type"), HasSubstr("`mapping` of TPDO1"));
}

TEST(ReadNetwork, MissingKeysAreNamed) {
  const auto net = read(
      "nodes:\n"
      "  arm: {}\n"
      "  leg: {node_id: 2, dcf: a.eds, sdo: [{index: 0x6081}, {value: 3}]}\n");

  EXPECT_THAT(net.declared("missing-key"), HasSubstr("node `arm` lacks `node_id`"));
  EXPECT_THAT(net.declared("missing-key"), HasSubstr("node `arm` lacks `dcf`"));
  EXPECT_THAT(net.declared("missing-key"), HasSubstr("lacks `value`"));
  EXPECT_THAT(net.declared("missing-key"), HasSubstr("lacks `index`"));
}

TEST(ReadNetwork, AnEdsUnderTheKeyEdsIsReportedItsKey) {
  const auto net = read("nodes: {arm: {node_id: 1, eds: a.eds}}\n");

  EXPECT_THAT(net.complaints(), ElementsAre("1:27 error [missing-key]"));
  EXPECT_THAT(net.declared("missing-key"), HasSubstr("the key is `dcf`"));
}

TEST(ReadNetwork, TheSameObjectWrittenTwiceIsReportedUnlessMeant) {
  const auto net = read(
      "nodes:\n"
      "  arm:\n"
      "    node_id: 1\n"
      "    dcf: a.eds\n"
      "    sdo:\n"
      "      - {index: 0x6083, sub_index: 0, value: 1000}\n"
      "      - {index: 0x6083, sub_index: 0, value: 2000}  # deceleration\n"
      "      - {index: 0x6083, sub_index: 0, value: 3000, again: true}\n");

  EXPECT_THAT(net.complaints(), ElementsAre("7:9 warning [written-twice]"));
  EXPECT_EQ(net.spec.nodes[0].sdo.size(), 3U);
  EXPECT_THAT(net.declared("written-twice"), HasSubstr("6083:00"));
  EXPECT_THAT(net.declared("written-twice"), HasSubstr("first in line 6"));
}

TEST(ReadNetwork, HeartbeatKeysOfOtherReadersAreReadAsTheyReadThem) {
  const auto net = read(
      "master: {heartbeat_consumer: 0, heartbeat_producer: false}\n"
      "nodes:\n"
      "  arm: {node_id: 1, dcf: a.eds, heartbeat_consumer: 2000, heartbeat_producer: off}\n"
      "  leg: {node_id: 2, dcf: a.eds, retry_factor: 0, software_file: \"\"}\n");

  EXPECT_THAT(net.complaints(),
              ElementsAre("1:53 warning [wrong-type]", "3:53 warning [wrong-type]",
                          "3:79 warning [wrong-type]"));
  EXPECT_FALSE(*net.spec.master.heartbeat_consumer);
  EXPECT_EQ(*net.spec.master.heartbeat_producer, 0);
  EXPECT_TRUE(*net.spec.nodes[0].heartbeat_consumer);
  EXPECT_EQ(*net.spec.nodes[0].heartbeat_producer, 0);
  EXPECT_EQ(*net.spec.nodes[1].retry_factor, 0);
  EXPECT_FALSE(net.spec.nodes[1].software_file.given);
}

TEST(ReadNetwork, ASyncWindowNeedsNoSyncOfTheMaster) {
  EXPECT_THAT(read("master: {sync_window: 1000}\narm: {node_id: 1, dcf: a.eds}\n").complaints(),
              IsEmpty());
}

TEST(ReadNetwork, ValuesOfSdoMayBeWholeRealOrText) {
  const auto net = read(
      "nodes:\n"
      "  arm:\n"
      "    node_id: 1\n"
      "    dcf: a.eds\n"
      "    sdo: [{index: 1, value: -3}, {index: 2, value: 0xFFFFFFFF}, {index: 3, value: 1.5e3},\n"
      "          {index: 4, value: save}]\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  const auto& sdo = net.spec.nodes[0].sdo;
  EXPECT_EQ(std::get<std::int64_t>(sdo[0].value), -3);
  EXPECT_EQ(std::get<std::int64_t>(sdo[1].value), 0xFFFFFFFF);
  EXPECT_EQ(std::get<double>(sdo[2].value), 1500.0);
  EXPECT_EQ(std::get<std::string>(sdo[3].value), "save");
}

TEST(ReadNetwork, AnSdoValueInQuotesKeepsItsText) {
  const auto net = read(
      "nodes: {arm: {node_id: 1, dcf: a.eds, sdo: [{index: 1, value: \"012\"}, {index: 2, value: "
      "'7'},\n"
      "        {index: 3, value: 7}]}}\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  const auto& sdo = net.spec.nodes[0].sdo;
  EXPECT_EQ(sdo[0].quoted, "012");
  EXPECT_EQ(std::get<std::string>(sdo[0].value), "012");
  EXPECT_EQ(sdo[1].quoted, "7");
  EXPECT_EQ(std::get<std::int64_t>(sdo[1].value), 7);
  EXPECT_EQ(sdo[2].quoted, std::nullopt);
}

TEST(ReadNetwork, LcmAuthenticatesImagesWhereAskedAndWithKeysOnly) {
  EXPECT_FALSE(read(with_node("lcm: {keys: a.keys}\n")).spec.lcm.signs);
  EXPECT_FALSE(read(with_node("lcm: {keys: a.keys, authenticate: commands}\n")).spec.lcm.signs);
  EXPECT_TRUE(read(with_node("lcm: {keys: a.keys, authenticate: images}\n")).spec.lcm.signs);
  EXPECT_THAT(read(with_node("lcm: {keys: a.keys, authenticate: all}\n")).complaints(),
              ElementsAre("1:35 error [unknown-value]"));
  EXPECT_THAT(read(with_node("lcm: {authenticate: images}\n")).complaints(),
              ElementsAre("1:21 error [lcm]"));
}

TEST(ReadNetwork, AUnicastAddressIsNoUdpmUrl) {
  const auto net = read(with_node("lcm: {url: \"udpm://127.0.0.1:7667\"}\n"));

  EXPECT_THAT(net.complaints(), ElementsAre("1:12 error [lcm-url]"));
  EXPECT_THAT(read(with_node("lcm: {url: \"udpm://239.255.76.67:7667?ttl=0\"}\n")).complaints(),
              IsEmpty());
}

TEST(ReadNetwork, NamesHaveToFitIntoLcmChannels) {
  const auto net = read(
      "bus: {name: \"my bus\"}\n"
      "nodes: {\"a/b\": {node_id: 1, dcf: a.eds}}\n");

  EXPECT_THAT(net.complaints(), ElementsAre("1:13 error [name]", "2:9 error [name]"));
}

TEST(ReadNetwork, AFileWithoutNodesIsAnError) {
  EXPECT_THAT(read("master: {node_id: 1}\n").complaints(), ElementsAre("1:1 error [no-nodes]"));
  EXPECT_THAT(read("- 1\n").complaints(), ElementsAre("1:1 error [wrong-type]"));
}

}  // namespace
}  // namespace takt
