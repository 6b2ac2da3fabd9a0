#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using test::compile;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Makes a network file with the node `arm`, node-ID 5, on line 2; `pdos` starts on line 3.
std::string arm(std::string_view pdos) {
  return "master: {sync_period: 10000}\narm: {node_id: 5, dcf: tiny.eds,\n" + std::string{pdos} +
         "}\n";
}

TEST(PdoCompiler, TakesValidPdosOfTheEdsAsTheyAre) {
  const auto net = compile(arm(""));

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
  const auto net =
      compile(arm("tpdo: {1: {transmission: 4, sync_start: 2, inhibit_time: 10, event_timer: 100,\n"
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
      compile(arm("tpdo: {1: {mapping: [\n"
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
  EXPECT_THAT(net.said("no-such-object"), HasSubstr("did you mean 0x6064 Position actual value?"));
  EXPECT_THAT(net.said("no-such-object"), HasSubstr("0x6041 Statusword has sub-index 00"));
  EXPECT_THAT(net.said("wrong-direction"), HasSubstr("belongs in a TPDO (device to master)"));
  EXPECT_THAT(net.said("not-mappable"), HasSubstr("PDOMapping=0"));
  EXPECT_THAT(net.said("wrong-width"), HasSubstr("16 bits wide, not 8"));
}

TEST(PdoCompiler, MoreThan64BitsAreAnError) {
  const auto net =
      compile(arm("rpdo: {1: {mapping: [{index: 0x607A}, {index: 0x60FF}, {index: 0x6060}]}}"));

  EXPECT_THAT(net.complaints(), ElementsAre("3:21 error [too-long]"));
  EXPECT_THAT(net.said("too-long"), HasSubstr("72 bits, a PDO holds 64: move 8 bits"));
}

TEST(PdoCompiler, GapsOfAnRpdoHaveNoField) {
  const auto net =
      compile(arm("rpdo: {1: {mapping: [{index: 0x6060}, {index: 5}, {index: 0x6040}]}}"));

  EXPECT_THAT(net.complaints(), IsEmpty());
  const PdoRow& row = net.plan.pdos.rpdos.at(0);
  EXPECT_EQ(row.length, 4);
  ASSERT_EQ(row.field_count, 2);
  EXPECT_EQ(net.plan.pdos.fields[row.first_field + 1U].bit_offset, 16);
}

TEST(PdoCompiler, APdoThatTheDeviceLacksIsAnError) {
  const auto net = compile(arm("tpdo: {6: {mapping: [{index: 0x6041}]}, 7: {enabled: false}}"));

  EXPECT_THAT(net.complaints(), ElementsAre("3:8 error [no-such-pdo]"));
  EXPECT_THAT(net.said("no-such-pdo"), HasSubstr("its 5 TPDOs end with number 5"));
}

TEST(PdoCompiler, APdoWithoutMappingIsAnErrorUnlessOff) {
  const auto net = compile(arm("tpdo: {3: {}, 4: {mapping: []}, 5: {enabled: false}}"));

  EXPECT_THAT(net.complaints(),
              ElementsAre("3:8 error [maps-nothing]", "3:28 error [maps-nothing]"));
}

TEST(PdoCompiler, AFixedMappingCanOnlyBeRepeated) {
  const std::string eds =
      test::tiny_objects() + test::pdo(true, 1, "$NODEID+0x180", 1, {"0x60410010"}, "const");

  EXPECT_THAT(compile(arm("tpdo: {1: {mapping: [{index: 0x6041}]}}"), eds).complaints(), IsEmpty());
  const auto net = compile(arm("tpdo: {1: {mapping: [{index: 0x6064}]}}"), eds);
  EXPECT_THAT(net.complaints(), ElementsAre("3:21 error [fixed-mapping]"));
  EXPECT_THAT(net.said("fixed-mapping"), HasSubstr("6041:00 Statusword"));
}

TEST(PdoCompiler, AMappingThatIsFixedEmptyIsSaidToBeEmpty) {
  const std::string eds =
      test::tiny_objects() + test::pdo(true, 1, "$NODEID+0x180", 1, {}, "const");

  EXPECT_THAT(compile(arm("tpdo: {1: {mapping: [{index: 0x6064}]}}"), eds).said("fixed-mapping"),
              HasSubstr("can't be remapped, it is fixed in the device without objects\n"));
}

// The EDS files of EPOS4 and Roboteq have this granularity.
TEST(PdoCompiler, GranularityZeroFixesNoMappingThatTheRecordsLetWrite) {
  std::string eds = test::tiny_objects() +
                    test::pdo(true, 1, "$NODEID+0x180", 1, {"0x60410010"}, "rw") +
                    test::pdo(true, 2, "$NODEID+0x280", 1, {"0x60410010"}, "ro");
  eds.replace(eds.find("Granularity=8"), 13, "Granularity=0");

  EXPECT_THAT(compile(arm("tpdo: {1: {mapping: [{index: 0x6064}]}}"), eds).complaints(), IsEmpty());
  EXPECT_THAT(compile(arm("tpdo: {2: {mapping: [{index: 0x6064}]}}"), eds).complaints(),
              ElementsAre("3:21 error [fixed-mapping]"));
}

TEST(PdoCompiler, RemoteRequestAndMultiplexedPdosOfTheEdsAreLeftOutWithANote) {
  const std::string eds = test::tiny_objects() +
                          test::pdo(true, 1, "$NODEID+0x180", 253, {"0x60410010"}) +
                          test::pdo(true, 2, "$NODEID+0x280", 1, {});

  const auto net = compile(arm(""), eds);

  EXPECT_TRUE(net.plan.pdos.tpdos.empty());
  EXPECT_THAT(net.said("pdo-left-out"),
              HasSubstr("TPDO1 of node `arm` is valid in tiny.eds but has "
                        "transmission type 253"));
  EXPECT_THAT(net.said("pdo-left-out"),
              HasSubstr("TPDO2 of node `arm`: valid in tiny.eds, but without mapped objects"));
}

TEST(PdoCompiler, PdoParametersWrittenBySdoCount) {
  const auto net = compile(
      arm("sdo: [{index: 0x1A00, sub_index: 1, value: 0x60640020}, {index: 0x1400, sub_index: 1,\n"
          " value: 0x80000205}]"));

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.layout.signals.at(0).object, (ObjectKey{0x6064, 0}));
  EXPECT_TRUE(net.plan.pdos.rpdos.empty());
}

TEST(PdoCompiler, EventTimerIsTheSendersAndEventDeadlineTheReceivers) {
  const auto net =
      compile(arm("tpdo: {1: {transmission: 255, event_timer: 20, event_deadline: 50}},\n"
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

// COB-IDs

TEST(CobIds, AutomaticIdsAboveFourTakeTheLowestFreeOne) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {5: {mapping: [{index: 0x6064}]}}}\n"
      "b: {node_id: 2, dcf: x, tpdo: {5: {mapping: [{index: 0x6064}]}}}\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.pdos.tpdos.at(1).cob_id, CobId::base(0x183));  // 0x181, 0x182: nodes 1, 2
  EXPECT_EQ(net.plan.pdos.tpdos.at(3).cob_id, CobId::base(0x184));
}

TEST(CobIds, AnIdThatWorksIsNeverMoved) {
  const std::string eds =
      test::tiny_objects() + test::pdo(true, 1, "0x40000333", 1, {"0x60410010"});

  const auto net = compile(arm(""), eds);

  EXPECT_EQ(net.plan.pdos.tpdos.at(0).cob_id, CobId::base(0x333));
}

TEST(CobIds, AbsoluteIdsOfAnEdsThatClashBecomeNodeRelativeWithANote) {
  const std::string eds =
      test::tiny_objects() + test::pdo(true, 1, "0x40000181", 1, {"0x60410010"});

  const auto net = compile(
      "master: {sync_period: 10000}\nb: {node_id: 2, dcf: x}\na: {node_id: 1, dcf: x}\n", eds);

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.pdos.tpdos.at(0).cob_id, CobId::base(0x181));
  EXPECT_EQ(net.plan.pdos.tpdos.at(1).cob_id, CobId::base(0x182));
  EXPECT_THAT(net.said("cob-id-moved"),
              HasSubstr("TPDO1 of node `b` has COB-ID 0x181 in tiny.eds, which is used by TPDO1 of "
                        "node `a`; takt uses 0x182"));
}

TEST(CobIds, TwoUsersOfOneIdAreAnError) {
  const auto net = compile(
      "a: {node_id: 1, dcf: x, tpdo: {1: {transmission: 255, cob_id: 0x190}}}\n"
      "b: {node_id: 2, dcf: x, tpdo: {1: {transmission: 255, cob_id: 0x190}}}\n");

  EXPECT_THAT(net.said("cob-id-clash"), HasSubstr("belongs to TPDO1 of node `a` (line 1) already"));
  EXPECT_THAT(net.said("cob-id-clash"), HasSubstr("`auto` would give 0x182"));
}

TEST(CobIds, RestrictedIdsAndServicesAreRefused) {
  for (const auto& [id, reason] : {std::pair{"0x180", "reserved"},
                                   {"0x101", "reserved"},
                                   {"0x000", "reserved"},
                                   {"0x580", ""},
                                   {"0x581", "reserved"},
                                   {"0x67F", "reserved"},
                                   {"0x6E0", "reserved"},
                                   {"0x701", "reserved"},
                                   {"0x7FF", "reserved"},
                                   {"0x80", "is SYNC"},
                                   {"0x85", "is EMCY"},
                                   {"0x100", "is TIME"},
                                   {"0x181", ""},
                                   {"0x86", ""}}) {
    const auto net = compile(arm("tpdo: {1: {transmission: 1, cob_id: " + std::string{id} + "}}"));
    EXPECT_THAT(net.said("cob-id"), HasSubstr(reason)) << id;
    EXPECT_EQ(net.complaints().empty(), std::string_view{reason}.empty()) << id;
  }
}

TEST(CobIds, TwentyNineBitsNeedBitTwentyNine) {
  EXPECT_THAT(compile(arm("tpdo: {1: {cob_id: 0x20012345}}")).plan.pdos.tpdos.at(0).cob_id,
              CobId::extended(0x12345));
  EXPECT_THAT(compile(arm("tpdo: {1: {cob_id: 0x12345}}")).complaints(),
              ElementsAre("3:20 error [cob-id]"));
}

TEST(CobIds, AnRpdoWithTheIdOfATpdoIsFedByThatDevice) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {cob_id: 0x190}}}\n"
      "b: {node_id: 2, dcf: x, rpdo: {1: {cob_id: 0x190}}}\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.pdos.rpdos.size(), 1U);
  EXPECT_EQ(net.plan.pdos.rpdos.at(0).node, 1_node);
  EXPECT_THAT(net.said("linked"), HasSubstr("RPDO1 of node `b` receives TPDO1 of node `a`"));
}

/// The RPDO1 of each device receives TPDO1 of node 1.
const std::string listener = test::tiny_objects() +
                             test::pdo(false, 1, "0x181", 1, {"0x60400010"}) +
                             test::pdo(true, 1, "$NODEID+0x180", 1, {"0x60410010"});

TEST(CobIds, ALinkThatOnlyTheEdsStatesIsKept) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, rpdo: {1: {enabled: false}}}\n"
      "b: {node_id: 2, dcf: x}\n"
      "c: {node_id: 3, dcf: x}\n",
      listener);

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_TRUE(net.plan.pdos.rpdos.empty());
  EXPECT_EQ(net.plan.pdos.tpdos.at(0).cob_id, CobId::base(0x181));
  EXPECT_THAT(net.said("linked"),
              testing::AllOf(HasSubstr("RPDO1 of node `b` receives TPDO1 of node `a` (both 0x181, "
                                       "which tiny.eds sets); the master does not send this RPDO"),
                             HasSubstr("RPDO1 of node `c` receives TPDO1 of node `a`")));
}

TEST(CobIds, ALinkOfTheEdsThatTheNetworkFileCutsIsAWarningWithItsRemedy) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, rpdo: {1: {enabled: false}}}\n"
      "b: {node_id: 2, dcf: x, rpdo: {1: {transmission: 255}}}\n",
      listener);

  EXPECT_THAT(net.complaints(), ElementsAre("3:32 warning [cob-id-moved]"));
  EXPECT_EQ(net.plan.pdos.rpdos.at(0).cob_id, CobId::base(0x202));
  EXPECT_THAT(net.said("cob-id-moved"),
              testing::AllOf(HasSubstr("write `cob_id: 0x181` for both PDOs"),
                             HasSubstr("`cob_id: auto` for this one")));
  EXPECT_THAT(compile("master: {sync_period: 10000}\n"
                      "a: {node_id: 1, dcf: x, rpdo: {1: {enabled: false}}}\n"
                      "b: {node_id: 2, dcf: x, rpdo: {1: {cob_id: auto}}}\n",
                      listener)
                  .complaints(),
              IsEmpty());
}

TEST(CobIds, ATpdoAndAnRpdoOfOneDeviceWithOneIdAreNoLink) {
  const auto net = compile("master: {sync_period: 10000}\na: {node_id: 1, dcf: x}\n", listener);

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(net.said("linked"), IsEmpty());
  EXPECT_EQ(net.plan.pdos.rpdos.at(0).cob_id, CobId::base(0x201));
}

TEST(CobIds, AnIdOfTheNetworkFileAndOneOfAnEdsMakeALinkToo) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {cob_id: 0x202}}}\n"
      "b: {node_id: 2, dcf: x}\n"
      "c: {node_id: 3, dcf: x, rpdo: {1: {cob_id: 0x182}}}\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(net.said("linked"),
              testing::AllOf(HasSubstr("RPDO1 of node `b` receives TPDO1 of node `a` (both 0x202"),
                             HasSubstr("RPDO1 of node `c` receives TPDO1 of node `b`")));
}

TEST(CobIds, AnIdOfATpdoThatIsThePredefinedOneOfAnAutomaticTpdoIsAnError) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {cob_id: auto}}}\n"
      "b: {node_id: 2, dcf: x, tpdo: {1: {cob_id: 0x181}}}\n");

  EXPECT_THAT(net.complaints(), ElementsAre("3:44 error [cob-id-clash]"));
  EXPECT_THAT(net.said("cob-id-clash"),
              HasSubstr("`cob_id` 0x181 of TPDO1 of node `b` is the predefined COB-ID of TPDO1 of "
                        "node `a`, which has no `cob_id` of its own: write `cob_id: 0x183` for "
                        "TPDO1 of node `a`, or another `cob_id` for TPDO1 of node `b`"));
}

TEST(CobIds, AnIdOfAnRpdoThatIsThePredefinedOneOfAnAutomaticTpdoMakesALink) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {cob_id: auto}}}\n"
      "b: {node_id: 2, dcf: x, rpdo: {1: {cob_id: 0x181}}}\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.pdos.tpdos.at(0).cob_id, CobId::base(0x181));
  EXPECT_EQ(net.plan.pdos.rpdos.size(), 1U);
  EXPECT_THAT(net.said("linked"), HasSubstr("RPDO1 of node `b` receives TPDO1 of node `a`"));
}

TEST(CobIds, ALinkOfTheEdsIsKeptWithAnAutomaticTpdo) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {cob_id: auto}}, rpdo: {1: {enabled: false}}}\n"
      "b: {node_id: 2, dcf: x}\n",
      listener);

  EXPECT_EQ(net.plan.pdos.tpdos.at(0).cob_id, CobId::base(0x181));
  EXPECT_THAT(net.said("linked"), HasSubstr("RPDO1 of node `b` receives TPDO1 of node `a`"));
}

TEST(CobIds, AnAutomaticTpdoHasItsPredefinedIdBeforeAnEdsThatUsesItForAnotherNode) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "b: {node_id: 2, dcf: x}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {cob_id: auto}}}\n",
      test::tiny_objects() + test::pdo(true, 1, "0x40000181", 1, {"0x60410010"}));

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.pdos.tpdos.at(0).cob_id, CobId::base(0x181));
  EXPECT_EQ(net.plan.pdos.tpdos.at(1).cob_id, CobId::base(0x182));
}

TEST(CobIds, AnAutomaticIdThatIsNotThePredefinedOneIsANote) {
  const auto with = [](const std::string& of_a, const std::string& of_b) {
    return compile("master: {sync_period: 10000}\na: {node_id: 1, dcf: x, " + of_a +
                   "}\nb: {node_id: 2, dcf: x, " + of_b + "}\n");
  };
  const auto service = with("tpdo: {1: {cob_id: auto}}", "emcy_cob_id: 0x181");
  EXPECT_THAT(service.said("cob-id-moved"),
              HasSubstr("the predefined COB-ID 0x181 of TPDO1 of node `a` is EMCY of node `b`; "
                        "takt uses 0x183"));
  const auto rpdos = with("rpdo: {1: {cob_id: auto}}", "rpdo: {1: {cob_id: 0x201}}");
  EXPECT_THAT(rpdos.complaints(), IsEmpty());
  EXPECT_THAT(rpdos.said("cob-id-moved"),
              HasSubstr("the predefined COB-ID 0x201 of RPDO1 of node `a` is used by RPDO1 of node "
                        "`b`; takt uses 0x183"));
}

TEST(CobIds, RestrictedRangesAreThoseOfTable40) {
  for (const std::uint32_t id : {0x000U, 0x07FU, 0x101U, 0x180U, 0x581U, 0x5FFU, 0x601U, 0x67FU,
                                 0x6E0U, 0x6FFU, 0x701U, 0x7FFU}) {
    EXPECT_TRUE(is_restricted(id)) << id;
  }
  for (const std::uint32_t id : {0x080U, 0x100U, 0x181U, 0x580U, 0x600U, 0x680U, 0x6DFU, 0x700U}) {
    EXPECT_FALSE(is_restricted(id)) << id;
  }
}

TEST(NodeIds, AreUsedOnce) {
  const auto net = compile(
      "master: {node_id: 3}\n"
      "a: {node_id: 1, dcf: x}\n"
      "b: {node_id: 1, dcf: x}\n"
      "c: {node_id: 3, dcf: x}\n"
      "A: {node_id: 4, dcf: x}\n");

  EXPECT_THAT(net.said("node-id-clash"), HasSubstr("node id 1 of `b` belongs to `a` (line 2)"));
  EXPECT_THAT(net.said("node-id-clash"), HasSubstr("node id 3 of `c` is the master's (line 1)"));
  EXPECT_THAT(net.said("name"), HasSubstr("`A` and `a` (line 2) would share their LCM channels"));
}

}  // namespace
}  // namespace takt
