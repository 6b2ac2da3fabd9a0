// Keys of the network file for polled, requested, late and multiplexed PDOs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::compile;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string arm(const std::string& line) {
  return "master: {sync_period: 10000}\nnodes:\n  arm: {node_id: 5, dcf: tiny.eds, " + line + "}\n";
}

/// Returns the boot steps of the only node whose purpose starts with `text`.
std::vector<BootStep> steps(const test::Compiled& net, std::string_view text) {
  std::vector<BootStep> found;
  for (const BootStep& step : net.plan.nodes[0].boot_plan.steps) {
    if (step.purpose.starts_with(text)) found.push_back(step);
  }
  return found;
}

const PdoRow* tpdo(const test::Compiled& net, unsigned number) {
  for (const PdoRow& row : net.plan.pdos.tpdos) {
    if (row.number == number) return &row;
  }
  return nullptr;
}

TEST(PdoKinds, RemoteTypesAreTakenWithTheirPoll) {
  const auto net =
      compile(arm("tpdo: {1: {transmission: 253, poll_ms: 100}, 2: {transmission: 252, "
                  "poll_syncs: 5, mapping: [{index: 0x6064}]}}"));
  EXPECT_THAT(net.complaints(), IsEmpty());
  ASSERT_NE(tpdo(net, 1), nullptr);
  EXPECT_EQ(tpdo(net, 1)->poll, 100ms);
  ASSERT_NE(tpdo(net, 2), nullptr);
  EXPECT_EQ(tpdo(net, 2)->poll_syncs, 5);
}

// The EDS has 0x40000185, where bit 30 forbids remote requests. The boot writes the complete value
// 0x00000185.
TEST(PdoKinds, RemoteRequestsAreAllowedInTheDevice) {
  const auto net = compile(arm("tpdo: {1: {transmission: 253, poll_ms: 100}}"));
  const auto on = steps(net, "TPDO1 on, COB-ID 0x185");
  ASSERT_EQ(on.size(), 1U);
  EXPECT_EQ(on[0].action, BootAction::write);
  EXPECT_EQ(on[0].value,
            (std::vector{std::byte{0x85}, std::byte{0x01}, std::byte{0}, std::byte{0}}));
}

TEST(PdoKinds, WithoutAPollARemoteTypeIsNoted) {
  const auto net = compile(arm("tpdo: {1: {transmission: 253}}"));
  EXPECT_THAT(net.declared("not-polled"), HasSubstr("is sent on remote request only"));
}

TEST(PdoKinds, ReservedAndWrongKeysAreRefusedAtTheirPlace) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "nodes:\n"
      "  arm:\n"
      "    node_id: 5\n"
      "    dcf: tiny.eds\n"
      "    tpdo: {1: {transmission: 241}, 2: {transmission: 251, mapping: [{index: 0x6064}]}}\n"
      "    rpdo: {1: {transmission: 252}, 2: {poll_ms: 5, late: drop, mpdo: sam, mapping: "
      "[{index: 0x6040}]}}\n");
  EXPECT_THAT(net.complaints(),
              ElementsAre("6:30 error [transmission-type]", "6:54 error [transmission-type]",
                          "7:30 error [transmission-type]", "7:49 error [wrong-direction]",
                          "7:58 error [wrong-direction]", "7:36 error [transmission-type]",
                          "7:36 error [dispatching-list]"));
}

TEST(PdoKinds, ReservedTypesAreRefusedAlsoWhereTheyAreWrittenBySdo) {
  const auto sdo = [](const char* index, const char* type) {
    return compile(
        arm(std::string{"sdo: [{index: "} + index + ", sub_index: 2, value: " + type + "}]"));
  };
  EXPECT_THAT(sdo("0x1800", "245").declared("transmission-type"),
              HasSubstr("241..251 are reserved"));
  EXPECT_THAT(sdo("0x1400", "241").declared("transmission-type"),
              HasSubstr("241..251 are reserved"));
  EXPECT_THAT(sdo("0x1400", "252").declared("transmission-type"), HasSubstr("only a TPDO"));
  EXPECT_THAT(sdo("0x1800", "252").declared("transmission-type"), IsEmpty());
}

TEST(PdoKinds, LateFramesAreDroppedWhereTheFileSaysSo) {
  EXPECT_TRUE(tpdo(compile(arm("tpdo: {1: {late: drop}}")), 1)->drop_late);
  EXPECT_FALSE(tpdo(compile(arm("tpdo: {1: {late: use}}")), 1)->drop_late);
}

TEST(PdoKinds, APairOnRequestIsNoPartOfTheImage) {
  const auto net =
      compile(arm("tpdo: {3: {request: true, cob_id: 0x385}}, "
                  "rpdo: {2: {enabled: false}, 1: {mapping: [{index: 0x6040}]}}"));
  EXPECT_THAT(net.complaints(), IsEmpty());
  const PdoRow* row = tpdo(net, 3);
  ASSERT_NE(row, nullptr);
  EXPECT_TRUE(row->on_request);
  EXPECT_EQ(row->length, 8);
  EXPECT_EQ(row->field_count, 0);
  EXPECT_TRUE(steps(net, "TPDO3 maps").empty()) << "its mapping is the device's own affair";
}

TEST(PdoKinds, AnRpdoOnRequestNeedsTheTpdoThatAnswers) {
  const auto net = compile(arm("tpdo: {1: {enabled: false}}, rpdo: {1: {request: true}}"));
  EXPECT_THAT(net.declared("request-pair"), HasSubstr("TPDO1, which answers it, is off"));
}

TEST(PdoKinds, ASamPdoHasARowForEachObject) {
  const auto net =
      compile(arm("tpdo: {3: {mpdo: sam, transmission: 255, cob_id: 0x385, mapping: "
                  "[{index: 0x6064}, {index: 0x6041}]}}"));
  EXPECT_THAT(net.complaints(), IsEmpty());
  const std::uint16_t first = net.plan.pdos.route[0x385];
  ASSERT_LT(first + 1U, net.plan.pdos.tpdos.size());
  const PdoRow& statusword = net.plan.pdos.tpdos[first];
  const PdoRow& position = net.plan.pdos.tpdos[first + 1U];
  EXPECT_EQ(statusword.header, 0x0060'4105U);
  EXPECT_EQ(statusword.siblings, 2);
  EXPECT_EQ(position.header, 0x0060'6405U);
  EXPECT_EQ(position.siblings, 0);
  EXPECT_EQ(position.length, 8);
  const PdoField& field = net.plan.pdos.fields[position.first_field];
  EXPECT_EQ(field.bit_offset, 32);
  EXPECT_EQ(field.bits, 32);
  EXPECT_TRUE(field.sign_extend);
  const auto mark = steps(net, "TPDO3 mapping on");
  ASSERT_EQ(mark.size(), 1U);
  EXPECT_EQ(mark[0].value, std::vector{std::byte{0xFE}});
}

TEST(PdoKinds, ADamPdoIsSentToItsNodeAndTakenForTheMaster) {
  const auto net =
      compile(arm("tpdo: {3: {mpdo: dam, transmission: 255, cob_id: 0x385, mapping: "
                  "[{index: 0x2000, sub_index: 1, bits: 16}]}}, rpdo: {2: {mpdo: dam, "
                  "transmission: 255, mapping: [{index: 0x6081}]}}"));
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.pdos.tpdos[net.plan.pdos.route[0x385]].header, 0x0120'00FFU) << "node 127";
  const auto rpdo = std::ranges::find(net.plan.pdos.rpdos, 2, &PdoRow::number);
  ASSERT_NE(rpdo, net.plan.pdos.rpdos.end());
  EXPECT_EQ(rpdo->header, 0x0060'8185U);
}

TEST(PdoKinds, AMultiplexedPdoCarries32BitsByEvent) {
  const auto net =
      compile(arm("tpdo: {3: {mpdo: dam, transmission: 1, cob_id: 0x385, mapping: "
                  "[{index: 0x2000, sub_index: 1, bits: 33}]}}"));
  EXPECT_THAT(net.declared("wrong-width"), HasSubstr("up to 32 bits"));
  EXPECT_THAT(net.declared("transmission-type"), HasSubstr("by event"));
}

TEST(PdoKinds, FiveHundredAndTwelvePdosOfANodeAreTaken) {
  std::string eds = test::tiny_objects();
  for (int number = 1; number <= 512; ++number) {
    eds += test::pdo(true, number, std::to_string(0x20010000 + number), 255, {"0x60410010"});
  }
  std::string file =
      "master: {sync_period: 100000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: "
      "tiny.eds\n    tpdo:\n";
  for (int number = 1; number <= 512; ++number) {
    file += "      " + std::to_string(number) +
            ": {cob_id: " + std::to_string(0x2001'0000 + number) +
            ", mapping: [{index: 0x6041}]}\n";
  }
  const auto net = compile(file, eds);
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.pdos.tpdos.size(), 512U);
  EXPECT_EQ(net.plan.pdos.tpdos[511].cob_id, CobId::extended(0x10200));
  EXPECT_EQ(net.plan.pdos.tpdos[511].number, 512);
}

}  // namespace
}  // namespace takt
