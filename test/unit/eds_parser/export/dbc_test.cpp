#include <gtest/gtest.h>
#include <utility>

#include "eds_parser/export/dbc_text.hpp"
#include "eds_parser/export/export.hpp"

namespace takt {
namespace {

/// Makes a plan with one node "axis" (node-ID 5) whose TPDO1 holds the given signals in sequence.
BusPlan plan_of(std::vector<Signal> signals) {
  BusPlan plan;
  plan.cycle.period = std::chrono::milliseconds{2};
  plan.nodes.push_back({.name = "axis", .id = 5_node, .cia402 = true});
  PdoRow row{.cob_id = CobId::base(0x185), .node = 5_node, .transmission = 1, .length = 8};
  unsigned at = 0;
  for (auto& signal : signals) {
    const bool sign = takt::is_signed(signal.type);
    plan.pdos.fields.push_back({static_cast<SignalIndex>(row.field_count++),
                                static_cast<std::uint8_t>(at), signal.bits, sign});
    at += signal.bits;
    plan.layout.signals.push_back(std::move(signal));
  }
  plan.layout.inputs = plan.layout.signals.size();
  plan.pdos.tpdos.push_back(row);
  return plan;
}

Signal signal(std::string name, ObjectKey object, DataType type) {
  return {.name = std::move(name),
          .node = 5_node,
          .object = object,
          .type = type,
          .bits = static_cast<std::uint8_t>(bit_width(type)),
          .unit = {},
          .safe_value = {},
          .seeded_from = {}};
}

bool holds(const std::string& text, std::string_view line) {
  return text.find(line) != std::string::npos;
}

TEST(Dbc, ASignalHasItsPlaceSignScaleAndUnit) {
  auto position = signal("position_actual_value", {0x6064, 0}, DataType::integer32);
  position.scale = 0.001;
  position.offset = -2.5;
  position.unit = "rad";
  const auto dbc =
      to_dbc(plan_of({signal("gap", {0x2000, 0}, DataType::unsigned8), std::move(position)}));
  EXPECT_TRUE(holds(dbc,
                    "BO_ 389 axis_TPDO1: 8 axis\n"
                    " SG_ gap : 0|8@1+ (1,0) [0|0] \"\" master\n"
                    " SG_ position_actual_value : 8|32@1- (0.001,-2.5) [0|0] \"rad\" master\n"))
      << dbc;
  EXPECT_TRUE(holds(dbc, "CM_ SG_ 389 position_actual_value \"6064:00 INTEGER32\";\n"));
  EXPECT_TRUE(holds(dbc, "BA_ \"GenMsgCycleTime\" BO_ 389 2;\n"));
}

TEST(Dbc, AStatuswordIsItsBitsOrOneValue) {
  const auto plan = plan_of({signal("statusword", {0x6041, 0}, DataType::unsigned16)});
  const auto bits = to_dbc(plan);
  EXPECT_TRUE(holds(bits, " SG_ statusword_operation_enabled : 2|1@1+ (1,0) [0|0] \"\" master\n"));
  EXPECT_TRUE(
      holds(bits, "VAL_ 389 statusword_quick_stop 0 \"quick stop\" 1 \"no quick stop\" ;\n"));
  const auto word = to_dbc(plan, {.word_bits = false});
  EXPECT_TRUE(holds(word, " SG_ statusword : 0|16@1+ (1,0) [0|0] \"\" master\n"));
  EXPECT_FALSE(holds(word, "statusword_"));
}

TEST(Dbc, RealsAreMarkedAsSuch) {
  const auto dbc = to_dbc(plan_of({signal("force", {0x2001, 0}, DataType::real32)}));
  EXPECT_TRUE(holds(dbc, "SIG_VALTYPE_ 389 force : 1;\n"));
}

TEST(Dbc, LongNamesAreCutAndKeptAsAttributes) {
  const auto first = "a_name_of_more_than_thirty_two_characters_one";
  const auto second = "a_name_of_more_than_thirty_two_characters_two";
  const auto dbc = to_dbc(plan_of({signal(first, {0x2001, 0}, DataType::unsigned8),
                                   signal(second, {0x2002, 0}, DataType::unsigned8)}));
  EXPECT_TRUE(holds(dbc, " SG_ a_name_of_more_than_thirty_two_c : 0|8"));
  EXPECT_TRUE(holds(dbc, " SG_ a_name_of_more_than_thirty_two_2 : 8|8")) << dbc;
  EXPECT_TRUE(holds(dbc,
                    "BA_ \"SystemSignalLongSymbol\" SG_ 389 "
                    "a_name_of_more_than_thirty_two_2 \"" +
                        std::string{second} + "\";\n"));
}

TEST(Dbc, AnOutputThatAPdoCarriesTwiceHasTwoNames) {
  auto plan = plan_of({signal("target", {0x607A, 0}, DataType::integer32)});
  PdoField again = plan.pdos.fields[0];
  again.bit_offset = 32;
  plan.pdos.fields.push_back(again);
  plan.pdos.tpdos[0].field_count = 2;

  const auto dbc = to_dbc(plan);

  EXPECT_TRUE(holds(dbc, " SG_ target : 0|32@1-")) << dbc;
  EXPECT_TRUE(holds(dbc, " SG_ target_2 : 32|32@1-")) << dbc;
  EXPECT_FALSE(holds(dbc, "SystemSignalLongSymbol\" SG_ 389")) << dbc;
}

TEST(Dbc, ObjectsOfAnMpdoAreMultiplexed) {
  auto plan = plan_of({signal("one", {0x2001, 1}, DataType::unsigned8),
                       signal("two", {0x2001, 2}, DataType::unsigned8)});
  auto& rows = plan.pdos.tpdos;
  rows[0].header = 0x01200105;
  rows[0].field_count = 1;
  rows.push_back(rows[0]);
  rows[1].header = 0x02200105;
  rows[1].first_field = 1;
  plan.pdos.fields[0].bit_offset = plan.pdos.fields[1].bit_offset = 32;
  EXPECT_TRUE(holds(to_dbc(plan),
                    "BO_ 389 axis_TPDO1: 8 axis\n"
                    " SG_ object M : 0|32@1+ (1,0) [0|0] \"\" master\n"
                    " SG_ one m18874629 : 32|8@1+ (1,0) [0|0] \"\" master\n"
                    " SG_ two m35651845 : 32|8@1+ (1,0) [0|0] \"\" master\n"))
      << to_dbc(plan);
}

TEST(Dbc, IdentifiersOf29BitsCarryTheFlag) {
  auto plan = plan_of({signal("one", {0x2001, 1}, DataType::unsigned8)});
  plan.pdos.tpdos[0].cob_id = CobId::extended(0x12345);
  EXPECT_TRUE(holds(to_dbc(plan), "BO_ 2147558213 axis_TPDO1:"));
}

TEST(Dbc, ANodeMayBeCalledMaster) {
  auto plan = plan_of({signal("one", {0x2001, 1}, DataType::unsigned8)});
  plan.nodes[0].name = "master";
  plan.nodes.push_back({.name = "master_2", .id = 6_node});
  const auto dbc = to_dbc(plan);
  EXPECT_TRUE(holds(dbc, "BU_: master master_2 master_2_2\n")) << dbc;
  EXPECT_TRUE(holds(dbc,
                    "BO_ 389 master_2_TPDO1: 8 master_2\n SG_ one : 0|8@1+ (1,0) [0|0] \"\" "
                    "master\n"))
      << dbc;
}

TEST(CppHeader, NamesOfTheHeaderAndOfCppAreNotThoseOfNodesOrSignals) {
  auto plan = plan_of({signal("new", {0x2001, 1}, DataType::unsigned8),
                       signal("co_await", {0x2001, 2}, DataType::unsigned8),
                       signal("a.b", {0x2001, 3}, DataType::unsigned8),
                       signal("a_b", {0x2001, 4}, DataType::unsigned8)});
  plan.name = "can";
  plan.nodes[0].name = "signals";
  for (const char* name : {"signals_", "layout_hash", "num_inputs", "std", "static_cast"}) {
    plan.nodes.push_back({.name = name, .id = 6_node});
  }
  const auto header = to_cpp_header(plan);
  for (const char* line :
       {"namespace signals_ {\n", "namespace signals__ {\n", "namespace layout_hash_ {\n",
        "namespace num_inputs_ {\n", "namespace std_ {\n", "namespace static_cast_ {\n",
        "std::uint16_t new_ = 0;", "std::uint16_t co_await_ = 1;", "std::uint16_t a_b = 2;",
        "std::uint16_t a_b_ = 3;"}) {
    EXPECT_TRUE(holds(header, line)) << line << header;
  }
}

TEST(Dbc, TextIsWindows1252WithoutQuotes) {
  EXPECT_EQ(dbc_text("\xC2\xB0"
                     "C \"x\" \xCE\xA9"),
            "\xB0"
            "C 'x' ?");
  EXPECT_EQ(dbc_name("3-axis"), "_3_axis");
}

}  // namespace
}  // namespace takt
