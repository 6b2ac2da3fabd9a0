#include "eds_parser/plan/image/layout_compiler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdexcept>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using test::compile;
using test::Compiled;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view csp_pdos =
    "  tpdo: {1: {mapping: [{index: 0x6041}, {index: 0x6064}]}, 2: {transmission: 1, mapping: "
    "[{index: 0x6061}]}}\n"
    "  rpdo: {1: {mapping: [{index: 0x6040}, {index: 0x607A}]}, 2: {transmission: 1, mapping: "
    "[{index: 0x6060}, {index: 0x60FF}]}}\n";

Compiled two_axes(std::string_view more = "") {
  return compile(
      "master: {sync_period: 4000}\n"
      "defaults:\n  dcf: tiny.eds\n" +
      std::string{csp_pdos} + std::string{more} + "nodes:\n  b: {node_id: 2}\n  a: {node_id: 1}\n");
}

std::vector<std::string> names(const BusPlan& plan) {
  std::vector<std::string> out;
  for (const Signal& signal : plan.layout.signals) {
    out.push_back(plan.nodes[signal.node_index].name + "." + signal.name);
  }
  return out;
}

const Signal& find(const BusPlan& plan, std::uint16_t index, std::size_t node = 0) {
  for (const Signal& signal : plan.layout.signals) {
    if (signal.object.index == index && signal.node_index == node) return signal;
  }
  throw std::runtime_error{"no such signal"};
}

TEST(LayoutCompiler, OrdersInputsThenOutputsByObjectThenNode) {
  const auto net = two_axes();

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.layout.inputs, 6U);
  EXPECT_THAT(names(net.plan),
              ElementsAre("a.statusword", "b.statusword", "a.modes_of_operation_display",
                          "b.modes_of_operation_display", "a.position_actual_value",
                          "b.position_actual_value", "a.controlword", "b.controlword",
                          "a.modes_of_operation", "b.modes_of_operation", "a.target_position",
                          "b.target_position", "a.target_velocity", "b.target_velocity"));
}

TEST(LayoutCompiler, RpdosGoOutByPriority) {
  const auto net = two_axes();

  std::vector<std::uint32_t> ids;
  for (const PdoRow& row : net.plan.pdos.rpdos) ids.push_back(row.cob_id.id());
  EXPECT_THAT(ids, ElementsAre(0x201, 0x202, 0x301, 0x302));
}

TEST(LayoutCompiler, EveryFieldLeadsToItsSignal) {
  const auto net = two_axes();

  for (const auto* rows : {&net.plan.pdos.tpdos, &net.plan.pdos.rpdos}) {
    for (std::size_t r = 0; r < rows->size(); ++r) {
      const PdoRow& row = (*rows)[r];
      for (unsigned i = 0; i < row.field_count; ++i) {
        const Signal& signal =
            net.plan.layout.signals.at(net.plan.pdos.fields.at(row.first_field + i).signal);
        EXPECT_EQ(signal.node, row.node);
        EXPECT_EQ(signal.row, r);
      }
    }
  }
}

TEST(LayoutCompiler, AnObjectInTwoTpdosIsTwoSignalsWithNumberedNames) {
  const auto net = compile(
      "master: {sync_period: 4000}\n"
      "a: {node_id: 1, dcf: x, tpdo: {1: {mapping: [{index: 0x6041}]}, 2: {transmission: 1, "
      "mapping: [{index: 0x6041}, {index: 0x6064}]}}}\n");

  EXPECT_THAT(names(net.plan), ElementsAre("a.statusword", "a.statusword_2",
                                           "a.position_actual_value", "a.controlword"));
  EXPECT_EQ(net.plan.pdos.fields[net.plan.pdos.tpdos[1].first_field].signal, 1);
}

TEST(LayoutCompiler, AnObjectInTwoRpdosIsOneSignalCopiedIntoBoth) {
  const auto net = compile(
      "master: {sync_period: 4000}\n"
      "a: {node_id: 1, dcf: x, rpdo: {2: {cob_id: auto}}}\n");

  EXPECT_THAT(names(net.plan), ElementsAre("a.statusword", "a.controlword", "a.target_position"));
  EXPECT_EQ(net.plan.pdos.fields[net.plan.pdos.rpdos.at(0).first_field].signal, 1);
  EXPECT_EQ(net.plan.pdos.fields[net.plan.pdos.rpdos.at(1).first_field].signal, 1);
}

TEST(LayoutCompiler, AnObjectInBothDirectionsKeepsItsPlainNameAsOutput) {
  const auto net = compile(
      "a: {node_id: 1, dcf: x, tpdo: {1: {transmission: 255, mapping: [{index: 0x2003}]}},\n"
      "    rpdo: {1: {transmission: 255, mapping: [{index: 0x2003}]}}}\n");

  EXPECT_THAT(names(net.plan), ElementsAre("a.wide_2", "a.wide"));
}

TEST(LayoutCompiler, TheHashFollowsNamesAndUnits) {
  const auto plain = two_axes().plan.layout.hash;

  EXPECT_EQ(plain, two_axes().plan.layout.hash);
  EXPECT_NE(plain, two_axes("  units: {position: {scale: 0.001, unit: rad}}\n").plan.layout.hash);
}

TEST(Units, SignTurnsDirectionsOffsetShiftsPositionsOnly) {
  const auto net = two_axes(
      "  units:\n"
      "    position: {scale: 0.5, offset: 2, sign: -1, unit: rad}\n"
      "    velocity: {scale: 0.25, unit: rad/s}\n"
      "    objects: [{index: 0x6041, scale: 1, unit: bits}]\n");

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(find(net.plan, 0x6064).scale, -0.5);
  EXPECT_EQ(find(net.plan, 0x6064).offset, 2.0);
  EXPECT_EQ(find(net.plan, 0x607A).unit, "rad");
  EXPECT_EQ(find(net.plan, 0x60FF).scale, 0.25);
  EXPECT_EQ(find(net.plan, 0x6041).unit, "bits");
  EXPECT_EQ(find(net.plan, 0x6040).unit, "");
}

TEST(Seeds, TargetsStartWhereTheAxisIs) {
  const auto net = two_axes();

  EXPECT_EQ(find(net.plan, 0x607A, 1).seeded_from, SignalIndex{5});
  EXPECT_EQ(find(net.plan, 0x607A).safe_value, std::nullopt);
  EXPECT_EQ(find(net.plan, 0x6060).seeded_from, SignalIndex{2});
  EXPECT_EQ(find(net.plan, 0x6040).safe_value, 0);
  EXPECT_EQ(find(net.plan, 0x60FF).safe_value, 0);
}

TEST(Seeds, ATargetPositionIsNeverPresetByTheSdoList) {
  const auto net = two_axes(
      "  sdo: [{index: 0x607A, value: 0}, {index: 0x6060, value: 8}, {index: 0x6040, value: "
      "15}]\n");

  EXPECT_EQ(find(net.plan, 0x607A).safe_value, std::nullopt);
  EXPECT_EQ(find(net.plan, 0x6060).safe_value, 8);
  EXPECT_EQ(find(net.plan, 0x6040).safe_value, 0);
}

TEST(Seeds, WithoutFeedbackATargetWaitsForItsCommand) {
  const auto net = compile(
      "master: {sync_period: 4000}\n"
      "a: {node_id: 1, dcf: x, rpdo: {1: {mapping: [{index: 0x607A}]}}}\n");

  EXPECT_EQ(find(net.plan, 0x607A).seeded_from, std::nullopt);
  EXPECT_EQ(find(net.plan, 0x607A).safe_value, std::nullopt);
}

TEST(Fallback, ADriveStopsQuicklyAfter50MillisecondsByDefault) {
  const auto net = two_axes();

  EXPECT_EQ(find(net.plan, 0x6040).fallback, Fallback::value);
  EXPECT_EQ(find(net.plan, 0x6040).fallback_value, 0x0002);
  EXPECT_EQ(find(net.plan, 0x6040).fallback_cycles, 13U);
  EXPECT_EQ(find(net.plan, 0x60FF).fallback, Fallback::value);
  EXPECT_EQ(find(net.plan, 0x60FF).fallback_value, 0);
  EXPECT_EQ(find(net.plan, 0x607A).fallback, Fallback::hold);
  EXPECT_EQ(find(net.plan, 0x6060).fallback, Fallback::hold);
}

TEST(Fallback, PoliciesDoWhatTheySay) {
  const auto disable = two_axes("  on_timeout: {fallback: disable, after_cycles: 7}\n");
  EXPECT_EQ(find(disable.plan, 0x6040).fallback_value, 0);
  EXPECT_EQ(find(disable.plan, 0x607A).fallback_cycles, 7U);

  const auto zero = two_axes("  on_timeout: {fallback: zero}\n");
  EXPECT_EQ(find(zero.plan, 0x60FF).fallback, Fallback::value);
  EXPECT_EQ(find(zero.plan, 0x607A).fallback, Fallback::hold);  // zero would be a movement

  const auto safe =
      two_axes("  on_timeout: {fallback: safe}\n  safe_values: [{index: 0x60FF, value: -5}]\n");
  EXPECT_EQ(find(safe.plan, 0x60FF).fallback_value, -5);
  EXPECT_EQ(find(safe.plan, 0x607A).fallback, Fallback::hold);
}

TEST(Fallback, OfARealIsItsBitPattern) {
  const auto fallback = [](int type, const std::string& value) {
    const auto net = compile(
        test::arm_with("on_timeout: {fallback: safe}, safe_values: [{index: 0x2005, value: " +
                       value + "}], rpdo: {1: {mapping: [{index: 0x2005}]}}"),
        test::tiny_eds() + test::entry("2005", "Gain", type, "rww", "0", true));
    return find(net.plan, 0x2005).fallback_value;
  };
  EXPECT_EQ(fallback(8, "0.5"), 0x3F00'0000);             // REAL32
  EXPECT_EQ(fallback(11, "0.5"), 0x3FE0'0000'0000'0000);  // REAL64, which is type 0x11
  EXPECT_EQ(fallback(11, "2"), 0x4000'0000'0000'0000);
}

TEST(Fallback, BeginsAfterMillisecondsOrCyclesButNotBothAndNotBeforeThreeCycles) {
  const auto cycles = [](const std::string& timeout) {
    return find(two_axes("  on_timeout: {" + timeout + "}\n").plan, 0x6040).fallback_cycles;
  };
  EXPECT_EQ(cycles("after: 80"), 20U);
  EXPECT_EQ(cycles("after: 81"), 21U);
  EXPECT_EQ(cycles("after: 1"), 3U);
  EXPECT_EQ(cycles("after_cycles: 1"), 3U);
  EXPECT_EQ(cycles("after_cycles: 2"), 3U);
  EXPECT_EQ(cycles("after_cycles: 4"), 4U);
  EXPECT_EQ(cycles("after_cycles: 0"), 0U) << "no limit";
  EXPECT_EQ(cycles("after: 0"), 0U) << "no limit";
  EXPECT_THAT(two_axes("  on_timeout: {after: 0}\n").complaints(),
              testing::Contains(HasSubstr("warning [no-time-to-live]")));
  EXPECT_EQ(two_axes("  on_timeout: {after_cycles: 2}\n").declared("short-time-to-live"),
            "commands last for 3 cycles at least: 3 is used instead of 2\n");
  EXPECT_EQ(two_axes("  on_timeout: {after_cycles: 3}\n").declared("short-time-to-live"), "");
  EXPECT_THAT(two_axes("  on_timeout: {after: 8, after_cycles: 2}\n").complaints(),
              testing::Contains(HasSubstr("error [duplicate-key]")));
}

TEST(Fallback, KnowsTheKeyThatSetsItsTime) {
  const auto key = [](const std::string& timeout) {
    return find(two_axes("  on_timeout: {" + timeout + "}\n").plan, 0x6040).fallback_key;
  };
  EXPECT_EQ(key("after: 80"), TimeToLiveKey::after);
  EXPECT_EQ(key("after_cycles: 4"), TimeToLiveKey::after_cycles);
  EXPECT_EQ(key("fallback: hold"), TimeToLiveKey::after);
}

TEST(Fallback, ANodeThatIsNoDriveHoldsAfterTheSameTime) {
  const auto net = two_axes("  profile: none\n");

  EXPECT_EQ(find(net.plan, 0x6040).fallback, Fallback::hold);
  EXPECT_EQ(find(net.plan, 0x6040).fallback_cycles, 13U);
  EXPECT_EQ(find(net.plan, 0x6040).safe_value, std::nullopt);
}

TEST(Fallback, WhatANodeCanNotDoIsAnError) {
  const auto quick = two_axes("  profile: none\n  on_timeout: {fallback: quick_stop}\n");
  EXPECT_THAT(quick.declared("fallback"), HasSubstr("is not a CiA 402 drive"));

  const auto safe = two_axes("  on_timeout: {fallback: safe}\n");
  EXPECT_THAT(safe.declared("fallback"), HasSubstr("needs `safe_values"));
}

}  // namespace
}  // namespace takt
