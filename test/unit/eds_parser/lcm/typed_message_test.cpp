#include "eds_parser/lcm/typed_message.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <utility>

#include "eds_parser/export/export.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {
namespace {

using testing::HasSubstr;

const BusPlan& demo() {
  static const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  return network.plan;
}

/// Makes a plan with one node and these signals.
BusPlan plan_of(std::vector<Signal> signals, const std::string& bus = "lift",
                const std::string& node = "arm") {
  BusPlan plan;
  plan.name = bus;
  plan.nodes.push_back({.name = node, .id = 5_node});
  plan.layout.inputs = signals.size();
  plan.layout.signals = std::move(signals);
  return plan;
}

Signal signal(const std::string& name, DataType type, std::uint8_t bits) {
  Signal made{.name = name,
              .node = 5_node,
              .object = {0x2000, 1},
              .unit = {},
              .safe_value = {},
              .seeded_from = {}};
  made.type = type;
  made.bits = bits;
  return made;
}

TEST(TypedMessage, FingerprintIsThatOfLcmGen) {
  const TypedMessage message{
      .package = "pk",
      .name = "probe_t",
      .channel = "PK_PROBE",
      .fields = {
          {"utime", LcmPrimitive::int64},
          {"stale", LcmPrimitive::boolean},
          {"sender", LcmPrimitive::string},
          {"a", LcmPrimitive::int8},
          {"b", LcmPrimitive::int16},
          {"a_rather_long_field_name_that_makes_the_sum_overflow_many_times", LcmPrimitive::int32},
          {"f", LcmPrimitive::float32},
          {"d", LcmPrimitive::float64}}};

  EXPECT_EQ(message.fingerprint(), 0xECF96A28576B2807);  // from the generated Python code
}

TEST(TypedMessage, EveryNodeHasAStateAndACommand) {
  const auto messages = typed_messages(demo());

  ASSERT_EQ(messages.size(), 6u);
  EXPECT_EQ(messages[0].package, "demo");
  EXPECT_EQ(messages[0].name, "shoulder_state_t");
  EXPECT_EQ(messages[1].name, "shoulder_command_t");
  EXPECT_FALSE(messages[0].command);
  EXPECT_TRUE(messages[1].command);
  for (const TypedMessage& message : messages) {
    for (const TypedField& field : message.fields) {
      if (!field.signal) continue;
      const Signal& signal = demo().layout.signals[*field.signal];
      EXPECT_EQ(signal.node_index, message.node_index);
      EXPECT_EQ(signal.output, message.command);
    }
  }
}

TEST(TypedMessage, UnsignedNumbersGetTheNextWiderType) {
  const auto messages = typed_messages(
      plan_of({signal("a", DataType::unsigned8, 8), signal("b", DataType::integer8, 8),
               signal("c", DataType::unsigned16, 16), signal("d", DataType::unsigned32, 32),
               signal("e", DataType::unsigned64, 64), signal("f", DataType::boolean, 1),
               signal("g", DataType::real32, 32), signal("h", DataType::integer24, 24)}));

  ASSERT_EQ(messages.size(), 1u);
  std::vector<LcmPrimitive> types;
  for (const TypedField& field : messages[0].fields) {
    if (field.signal) types.push_back(field.type);
  }
  using enum LcmPrimitive;
  EXPECT_THAT(types,
              testing::ElementsAre(int16, int8, int32, int64, int64, boolean, float32, int32));
}

TEST(TypedMessage, ScaledValuesAreDoublesInSi) {
  Signal scaled = signal("position", DataType::integer32, 32);
  scaled.scale = 0.5;
  scaled.unit = "rad";

  const auto messages = typed_messages(plan_of({scaled}));

  EXPECT_EQ(messages.at(0).fields.back().type, LcmPrimitive::float64);
  EXPECT_EQ(messages.at(0).fields.back().comment, "2000:01 INTEGER32, rad");
}

TEST(TypedMessage, OnlyAnUnsigned64IsABitPattern) {
  const auto messages = typed_messages(
      plan_of({signal("u", DataType::unsigned64, 64), signal("i", DataType::integer64, 64),
               signal("r", DataType::real64, 64)}));

  const auto& fields = messages.at(0).fields;
  EXPECT_EQ(fields.at(fields.size() - 3).comment, "2000:01 UNSIGNED64, as bit pattern");
  EXPECT_EQ(fields.at(fields.size() - 2).comment, "2000:01 INTEGER64");
  EXPECT_EQ(fields.back().comment, "2000:01 REAL64");
}

TEST(TypedMessage, NamesAreNoWordsOfAnyLanguageAndUnique) {
  const auto messages = typed_messages(
      plan_of({signal("class", DataType::integer8, 8), signal("from", DataType::integer8, 8),
               signal("None", DataType::integer8, 8), signal("9_lives", DataType::integer8, 8),
               signal("utime", DataType::integer8, 8), signal("a", DataType::integer8, 8),
               signal("A", DataType::integer8, 8)},
              "import", "while"));

  std::vector<std::string> names;
  for (const TypedField& field : messages.at(0).fields) {
    if (field.signal) names.push_back(field.name);
  }
  EXPECT_THAT(names,
              testing::ElementsAre("class_", "from_", "none_", "x9_lives", "utime_2", "a", "a_2"));
  EXPECT_EQ(messages.at(0).package, "import_");
  EXPECT_EQ(messages.at(0).name, "while__state_t");
}

TEST(TypedMessage, ANodeWithoutOutputsHasNoCommand) {
  EXPECT_EQ(typed_messages(plan_of({signal("a", DataType::integer8, 8)})).size(), 1u);
  EXPECT_TRUE(typed_messages(plan_of({})).empty());
}

TEST(TypedMessage, EveryChannelIsAnotherOneHoweverTheNodesAreCalled) {
  BusPlan plan = plan_of({signal("a", DataType::integer8, 8)}, "lift", "arm 1");
  plan.nodes.push_back({.name = "arm-1", .id = 6_node});
  plan.nodes.push_back({.name = "transfer", .id = 7_node});
  plan.nodes.push_back({.name = std::string(80, 'x'), .id = 8_node});
  plan.nodes.push_back({.name = std::string(81, 'x'), .id = 9_node});
  for (std::uint8_t node = 1; node < 5; ++node) {
    plan.layout.signals.push_back(plan.layout.signals[0]);
    plan.layout.signals.back().node_index = node;
  }

  std::vector<std::string> channels;
  for (const TypedMessage& message : typed_messages(plan)) channels.push_back(message.channel);

  EXPECT_THAT(channels, testing::ElementsAre("LIFT_ARM_1_STATE", "LIFT_ARM_1_2_STATE",
                                             "LIFT_TRANSFER_2_STATE",
                                             "LIFT_" + std::string(52, 'X') + "_STATE",
                                             "LIFT_" + std::string(50, 'X') + "_2_STATE"))
      << "LIFT_TRANSFER_STATE is one of takt's own";
}

TEST(LcmText, IsWhatLcmGenReads) {
  const auto messages = typed_messages(demo());

  EXPECT_THAT(to_lcm(messages.at(1), demo()),
              HasSubstr("struct shoulder_command_t\n{\n    int64_t utime;               // "
                        "microseconds since 1970\n"));
  EXPECT_THAT(to_lcm(messages.at(1), demo()),
              HasSubstr("    double  target_position;     // 607A:00 INTEGER32, rad\n}\n"));
}

}  // namespace
}  // namespace takt
