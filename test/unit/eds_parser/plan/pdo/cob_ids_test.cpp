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

  const auto net = compile(arm_with(""), eds);

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
  EXPECT_THAT(net.declared("cob-id-moved"),
              HasSubstr("TPDO1 of node `b` has COB-ID 0x181 in tiny.eds, which is used by TPDO1 of "
                        "node `a`; takt uses 0x182"));
}

TEST(CobIds, TwoUsersOfOneIdAreAnError) {
  const auto net = compile(
      "a: {node_id: 1, dcf: x, tpdo: {1: {transmission: 255, cob_id: 0x190}}}\n"
      "b: {node_id: 2, dcf: x, tpdo: {1: {transmission: 255, cob_id: 0x190}}}\n");

  EXPECT_THAT(net.declared("cob-id-clash"),
              HasSubstr("belongs to TPDO1 of node `a` (line 1) already"));
  EXPECT_THAT(net.declared("cob-id-clash"), HasSubstr("`auto` would give 0x182"));
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
    const auto net =
        compile(arm_with("tpdo: {1: {transmission: 1, cob_id: " + std::string{id} + "}}"));
    EXPECT_THAT(net.declared("cob-id"), HasSubstr(reason)) << id;
    EXPECT_EQ(net.complaints().empty(), std::string_view{reason}.empty()) << id;
  }
}

TEST(CobIds, TwentyNineBitsNeedBitTwentyNine) {
  EXPECT_THAT(compile(arm_with("tpdo: {1: {cob_id: 0x20012345}}")).plan.pdos.tpdos.at(0).cob_id,
              CobId::extended(0x12345));
  EXPECT_THAT(compile(arm_with("tpdo: {1: {cob_id: 0x12345}}")).complaints(),
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
  EXPECT_THAT(net.declared("linked"), HasSubstr("RPDO1 of node `b` receives TPDO1 of node `a`"));
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
  EXPECT_THAT(net.declared("linked"),
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
  EXPECT_THAT(net.declared("cob-id-moved"),
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
  EXPECT_THAT(net.declared("linked"), IsEmpty());
  EXPECT_EQ(net.plan.pdos.rpdos.at(0).cob_id, CobId::base(0x201));
}

TEST(CobIds, AnIdOfTheNetworkFileAndOneOfAnEdsMakeALinkToo) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {cob_id: 0x202}}}\n"
      "b: {node_id: 2, dcf: x}\n"
      "c: {node_id: 3, dcf: x, rpdo: {1: {cob_id: 0x182}}}\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(net.declared("linked"),
              testing::AllOf(HasSubstr("RPDO1 of node `b` receives TPDO1 of node `a` (both 0x202"),
                             HasSubstr("RPDO1 of node `c` receives TPDO1 of node `b`")));
}

TEST(CobIds, AnIdOfATpdoThatIsThePredefinedOneOfAnAutomaticTpdoIsAnError) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {cob_id: auto}}}\n"
      "b: {node_id: 2, dcf: x, tpdo: {1: {cob_id: 0x181}}}\n");

  EXPECT_THAT(net.complaints(), ElementsAre("3:44 error [cob-id-clash]"));
  EXPECT_THAT(net.declared("cob-id-clash"),
              HasSubstr("`cob_id` 0x181 of TPDO1 of node `b` is the predefined COB-ID of TPDO1 of "
                        "node `a`, which has no fixed `cob_id`: write `cob_id: 0x183` for "
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
  EXPECT_THAT(net.declared("linked"), HasSubstr("RPDO1 of node `b` receives TPDO1 of node `a`"));
}

TEST(CobIds, ALinkOfTheEdsIsKeptWithAnAutomaticTpdo) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {cob_id: auto}}, rpdo: {1: {enabled: false}}}\n"
      "b: {node_id: 2, dcf: x}\n",
      listener);

  EXPECT_EQ(net.plan.pdos.tpdos.at(0).cob_id, CobId::base(0x181));
  EXPECT_THAT(net.declared("linked"), HasSubstr("RPDO1 of node `b` receives TPDO1 of node `a`"));
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
  EXPECT_THAT(service.declared("cob-id-moved"),
              HasSubstr("the predefined COB-ID 0x181 of TPDO1 of node `a` is EMCY of node `b`; "
                        "takt uses 0x183"));
  const auto rpdos = with("rpdo: {1: {cob_id: auto}}", "rpdo: {1: {cob_id: 0x201}}");
  EXPECT_THAT(rpdos.complaints(), IsEmpty());
  EXPECT_THAT(rpdos.declared("cob-id-moved"),
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

  EXPECT_THAT(net.declared("node-id-clash"), HasSubstr("node id 1 of `b` belongs to `a` (line 2)"));
  EXPECT_THAT(net.declared("node-id-clash"),
              HasSubstr("node id 3 of `c` is the master's (line 1)"));
  EXPECT_THAT(net.declared("name"),
              HasSubstr("`A` and `a` (line 2) would share their LCM channels"));
}

}  // namespace
}  // namespace takt
