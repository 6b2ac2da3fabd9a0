#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using test::arm_with;
using test::compile;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(PdoCompiler, TakesValidPdosOfTheEdsAsTheyAre) {
  const auto net = compile(arm_with(""));

  EXPECT_THAT(net.complaints(), IsEmpty());
  ASSERT_EQ(net.plan.pdos.tpdos.size(), 1U);
  EXPECT_EQ(net.plan.pdos.tpdos[0].cob_id, CobId::base(0x185));
  EXPECT_EQ(net.plan.pdos.tpdos[0].transmission, 1);
  ASSERT_EQ(net.plan.pdos.rpdos.size(), 1U);
  EXPECT_EQ(net.plan.pdos.rpdos[0].cob_id, CobId::base(0x205));
  EXPECT_EQ(net.plan.pdos.route[0x185], 0);
  EXPECT_EQ(net.plan.pdos.route[0x186], PdoTable::no_row);
}

TEST(PdoCompiler, TheNetworkFileOverlaysTheEds) {
  const auto net = compile(
      arm_with("tpdo: {1: {transmission: 4, sync_start: 2, inhibit_time: 10, event_timer: 100,\n"
               "  mapping: [{index: 0x6064}, {index: 0x6061}, {index: 0x6041}]},\n"
               " 2: {}}"));

  EXPECT_THAT(net.complaints(), IsEmpty());
  const PdoRow& row = net.plan.pdos.tpdos.at(0);
  EXPECT_EQ(row.transmission, 4);
  EXPECT_EQ(row.sync_start, 2);
  EXPECT_EQ(row.inhibit, std::chrono::milliseconds{1});
  EXPECT_EQ(row.event_timer, std::chrono::milliseconds{100});
  EXPECT_EQ(row.length, 7);
  ASSERT_EQ(row.field_count, 3);
  const PdoField* field = &net.plan.pdos.fields[row.first_field];
  EXPECT_EQ(field[1].bit_offset, 32);
  EXPECT_EQ(field[1].bits, 8);
  EXPECT_TRUE(field[1].sign_extend);
  EXPECT_EQ(field[2].bit_offset, 40);
  EXPECT_FALSE(field[2].sign_extend);
  EXPECT_EQ(net.plan.pdos.tpdos.at(1).cob_id, CobId::base(0x285));
}

TEST(PdoCompiler, ReportsEveryBadMappingAtItsPlace) {
  const auto net =
      compile(arm_with("tpdo: {1: {mapping: [\n"
                       "  {index: 0x6065},\n"
                       "  {index: 0x6041, sub_index: 1},\n"
                       "  {index: 0x2000},\n"
                       "  {index: 0x2001},\n"
                       "  {index: 0x0005},\n"
                       "  {index: 0x6041, bits: 8},\n"
                       "  {index: 0x6064},\n"
                       "  {index: 0x6064}]}},\n"
                       "rpdo: {1: {mapping: [\n"
                       "  {index: 0x6041},\n"
                       "  {index: 0x0006},\n"
                       "  {index: 0x2002}]}}"));

  EXPECT_THAT(net.complaints(), testing::UnorderedElementsAre(
                                    "4:3 error [no-such-object]", "5:3 error [no-such-object]",
                                    "6:3 error [not-mappable]", "7:3 error [wrong-direction]",
                                    "8:3 error [dummy]", "9:3 error [wrong-width]",
                                    "11:3 warning [mapped-twice]", "13:3 error [wrong-direction]",
                                    "14:3 error [dummy]", "15:3 error [not-mappable]"));
  EXPECT_THAT(net.declared("no-such-object"),
              HasSubstr("did you mean 0x6064 Position actual value?"));
  EXPECT_THAT(net.declared("no-such-object"), HasSubstr("0x6041 Statusword has sub-index 00"));
  EXPECT_THAT(net.declared("wrong-direction"), HasSubstr("belongs in a TPDO (device to master)"));
  EXPECT_THAT(net.declared("not-mappable"), HasSubstr("PDOMapping=0"));
  EXPECT_THAT(net.declared("wrong-width"), HasSubstr("16 bits wide, not 8"));
}

TEST(PdoCompiler, MoreThan64BitsAreAnError) {
  const auto net = compile(
      arm_with("rpdo: {1: {mapping: [{index: 0x607A}, {index: 0x60FF}, {index: 0x6060}]}}"));

  EXPECT_THAT(net.complaints(), ElementsAre("3:21 error [too-long]"));
  EXPECT_THAT(net.declared("too-long"), HasSubstr("72 bits, a PDO holds 64: move 8 bits"));
}

TEST(PdoCompiler, APdoOfTheDeviceWithMoreThan64BitsIsLeftOut) {
  const auto tpdos = [](std::vector<std::string> mapping) {
    const std::string eds = test::tiny_objects() + test::entry("2006", "Bit", 1, "ro", "0", true) +
                            test::pdo(true, 1, "$NODEID+0x180", 1, std::move(mapping));
    return compile("master: {sync_period: 10000}\narm: {node_id: 5, dcf: x}\n", eds)
        .plan.pdos.tpdos.size();
  };
  EXPECT_EQ(tpdos({"0x60640020", "0x606C0020"}), 1U);
  EXPECT_EQ(tpdos({"0x60640020", "0x606C0020", "0x20060001"}), 0U);
}

TEST(PdoCompiler, ABooleanHasOneBitOrAByte) {
  const auto declared = [](const std::string& bits) {
    return compile(arm_with("tpdo: {1: {mapping: [{index: 0x2006, bits: " + bits + "}]}}"),
                   test::tiny_eds() + test::entry("2006", "Bit", 1, "ro", "0", true))
        .declared("wrong-width");
  };
  EXPECT_EQ(declared("1"), "");
  EXPECT_EQ(declared("8"), "");
  EXPECT_THAT(declared("4"), HasSubstr("1 bits wide, not 4"));
}

TEST(PdoCompiler, GapsOfAnRpdoHaveNoField) {
  const auto net =
      compile(arm_with("rpdo: {1: {mapping: [{index: 0x6060}, {index: 5}, {index: 0x6040}]}}"));

  EXPECT_THAT(net.complaints(), IsEmpty());
  const PdoRow& row = net.plan.pdos.rpdos.at(0);
  EXPECT_EQ(row.length, 4);
  ASSERT_EQ(row.field_count, 2);
  EXPECT_EQ(net.plan.pdos.fields[row.first_field + 1U].bit_offset, 16);
}

TEST(PdoCompiler, APdoThatTheDeviceLacksIsAnError) {
  const auto net =
      compile(arm_with("tpdo: {6: {mapping: [{index: 0x6041}]}, 7: {enabled: false}}"));

  EXPECT_THAT(net.complaints(), ElementsAre("3:8 error [no-such-pdo]"));
  EXPECT_THAT(net.declared("no-such-pdo"), HasSubstr("its 5 TPDOs end with number 5"));
}

TEST(PdoCompiler, APdoWithoutMappingIsAnErrorUnlessOff) {
  const auto net = compile(arm_with("tpdo: {3: {}, 4: {mapping: []}, 5: {enabled: false}}"));

  EXPECT_THAT(net.complaints(),
              ElementsAre("3:8 error [maps-nothing]", "3:28 error [maps-nothing]"));
}

TEST(PdoCompiler, AFixedMappingCanOnlyBeRepeated) {
  const std::string eds =
      test::tiny_objects() + test::pdo(true, 1, "$NODEID+0x180", 1, {"0x60410010"}, "const");

  EXPECT_THAT(compile(arm_with("tpdo: {1: {mapping: [{index: 0x6041}]}}"), eds).complaints(),
              IsEmpty());
  const auto net = compile(arm_with("tpdo: {1: {mapping: [{index: 0x6064}]}}"), eds);
  EXPECT_THAT(net.complaints(), ElementsAre("3:21 error [fixed-mapping]"));
  EXPECT_THAT(net.declared("fixed-mapping"), HasSubstr("6041:00 Statusword"));
}

TEST(PdoCompiler, AMappingThatIsFixedEmptyIsDeclaredToBeEmpty) {
  const std::string eds =
      test::tiny_objects() + test::pdo(true, 1, "$NODEID+0x180", 1, {}, "const");

  EXPECT_THAT(
      compile(arm_with("tpdo: {1: {mapping: [{index: 0x6064}]}}"), eds).declared("fixed-mapping"),
      HasSubstr("can't be remapped, it is fixed in the device without objects\n"));
}

// The EDS files of EPOS4 and Roboteq have this granularity.

TEST(PdoCompiler, GranularityZeroFixesNoMappingThatTheRecordsLetWrite) {
  std::string eds = test::tiny_objects() +
                    test::pdo(true, 1, "$NODEID+0x180", 1, {"0x60410010"}, "rw") +
                    test::pdo(true, 2, "$NODEID+0x280", 1, {"0x60410010"}, "ro");
  eds.replace(eds.find("Granularity=8"), 13, "Granularity=0");

  EXPECT_THAT(compile(arm_with("tpdo: {1: {mapping: [{index: 0x6064}]}}"), eds).complaints(),
              IsEmpty());
  EXPECT_THAT(compile(arm_with("tpdo: {2: {mapping: [{index: 0x6064}]}}"), eds).complaints(),
              ElementsAre("3:21 error [fixed-mapping]"));
}

TEST(PdoCompiler, RemoteRequestAndMultiplexedPdosOfTheEdsAreLeftOutWithANote) {
  const std::string eds = test::tiny_objects() +
                          test::pdo(true, 1, "$NODEID+0x180", 253, {"0x60410010"}) +
                          test::pdo(true, 2, "$NODEID+0x280", 1, {});

  const auto net = compile(arm_with(""), eds);

  EXPECT_TRUE(net.plan.pdos.tpdos.empty());
  EXPECT_THAT(net.declared("pdo-left-out"),
              HasSubstr("TPDO1 of node `arm` is valid in tiny.eds but has "
                        "transmission type 253"));
  EXPECT_THAT(net.declared("pdo-left-out"),
              HasSubstr("TPDO2 of node `arm`: valid in tiny.eds, but without mapped objects"));
}

TEST(PdoCompiler, PdoParametersWrittenBySdoCount) {
  const auto net = compile(arm_with(
      "sdo: [{index: 0x1A00, sub_index: 1, value: 0x60640020}, {index: 0x1400, sub_index: 1,\n"
      " value: 0x80000205}]"));

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.layout.signals.at(0).object, (ObjectKey{0x6064, 0}));
  EXPECT_TRUE(net.plan.pdos.rpdos.empty());
}

TEST(PdoCompiler, EventTimerIsTheSendersAndEventDeadlineTheReceivers) {
  const auto net =
      compile(arm_with("tpdo: {1: {transmission: 255, event_timer: 20, event_deadline: 50}},\n"
                       "rpdo: {1: {transmission: 255, event_timer: 30, event_deadline: 70}}"));

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.pdos.tpdos.at(0).event_timer, std::chrono::milliseconds{20});
  EXPECT_EQ(net.plan.pdos.tpdos.at(0).deadline, std::chrono::milliseconds{50});
  EXPECT_EQ(net.plan.pdos.rpdos.at(0).event_timer, std::chrono::milliseconds{30});
  const auto& steps = net.plan.nodes[0].boot_plan.steps;
  const auto deadline = std::ranges::find(steps, ObjectKey{0x1400, 5}, &BootStep::object);
  ASSERT_NE(deadline, steps.end());
  EXPECT_EQ(deadline->value, (std::vector{std::byte{70}, std::byte{0}}));
}

}  // namespace
}  // namespace takt
