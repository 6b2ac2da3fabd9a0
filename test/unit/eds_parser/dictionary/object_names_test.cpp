#include "eds_parser/dictionary/object_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

SubObject entry(std::uint8_t sub, const std::string& name) {
  SubObject made;
  made.sub = sub;
  made.name = name;
  return made;
}

Object variable(std::uint16_t index, const std::string& name) {
  Object object;
  object.index = index;
  object.name = name;
  object.subs.push_back(entry(0, name));
  return object;
}

Object record(std::uint16_t index, const std::string& name,
              const std::vector<std::string>& entries) {
  Object object;
  object.index = index;
  object.name = name;
  object.type = ObjectType::record;
  for (const std::string& of_entry : entries) {
    object.subs.push_back(entry(static_cast<std::uint8_t>(object.subs.size()), of_entry));
  }
  return object;
}

/// A device with two axes, and with RPDOs whose entries have the same names.
ObjectNames two_axes() {
  ObjectDictionary dictionary;
  dictionary.objects = {
      record(0x1018, "Identity object", {"Highest sub-index supported", "Vendor-ID"}),
      record(0x1400, "RPDO1 communication parameter", {"Highest sub-index supported", "COB-ID"}),
      record(0x1401, "RPDO2 communication parameter", {"Highest sub-index supported", "COB-ID"}),
      variable(0x2000, "Statistics"),
      variable(0x2001, "Statistics"),
      variable(0x6041, "Statusword"),
      record(0x607D, "Software position limit", {"Number of entries", "Min position limit"}),
      variable(0x6841, "Statusword"),
      record(0x687D, "Software position limit", {"Number of entries", "Min position limit"})};
  return ObjectNames{dictionary};
}

TEST(SnakeCase, IsMadeOfAnyEdsName) {
  EXPECT_EQ(snake_case("Position actual value"), "position_actual_value");
  EXPECT_EQ(snake_case("TargetVelocity (rpm)"), "target_velocity_rpm");
  EXPECT_EQ(snake_case("  --Input 1..8 "), "input_1_8");
  EXPECT_EQ(snake_case("8-bit"), "n8_bit");
  EXPECT_EQ(snake_case("\xC3\x84\xC3\x96"), "object");
  EXPECT_EQ(snake_case(""), "object");
  EXPECT_LE(snake_case(std::string(500, 'x')).size(), 61U);
}

TEST(ObjectNames, FindAVariableHoweverItIsWritten) {
  for (const char* const word : {"statusword", "Statusword", "STATUSWORD"}) {
    EXPECT_THAT(two_axes().find(word), ElementsAre(ObjectKey{0x6041, 0})) << word;
  }
}

TEST(ObjectNames, TheSecondAxisHasNames) {
  const ObjectNames names = two_axes();
  EXPECT_THAT(names.find("statusword_2"), ElementsAre(ObjectKey{0x6841, 0}));
  EXPECT_THAT(names.find("min_position_limit_2"), ElementsAre(ObjectKey{0x687D, 1}));
  EXPECT_THAT(names.find("software_position_limit.min_position_limit_2"),
              ElementsAre(ObjectKey{0x687D, 1}));
  EXPECT_EQ(names.name_of({0x6841, 0}), "statusword_2");
}

TEST(ObjectNames, AnEntryHasAShortNameIfNoOtherEntryHasIt) {
  const ObjectNames names = two_axes();
  EXPECT_THAT(names.find("vendor_id"), ElementsAre(ObjectKey{0x1018, 1}));
  EXPECT_THAT(names.find("Identity object.Vendor-ID"), ElementsAre(ObjectKey{0x1018, 1}));
  EXPECT_THAT(names.find("cob_id"), ElementsAre(ObjectKey{0x1400, 1}, ObjectKey{0x1401, 1}));
  EXPECT_THAT(names.find("rpdo2_communication_parameter.cob_id"),
              ElementsAre(ObjectKey{0x1401, 1}));
}

TEST(ObjectNames, OtherObjectsOfOneNameStayAmbiguous) {
  EXPECT_THAT(two_axes().find("statistics"),
              ElementsAre(ObjectKey{0x2000, 0}, ObjectKey{0x2001, 0}));
}

TEST(ObjectNames, ARecordStandsForItsEntries) {
  EXPECT_THAT(two_axes().find("identity_object"),
              ElementsAre(ObjectKey{0x1018, 0}, ObjectKey{0x1018, 1}));
}

TEST(ObjectNames, AnUnknownWordHasAGuess) {
  const ObjectNames names = two_axes();
  EXPECT_THAT(names.find("statuswrd"), IsEmpty());
  EXPECT_THAT(names.similar("statuswrd"), ElementsAre("statusword"));
  EXPECT_THAT(names.similar("position"),
              ElementsAre("software_position_limit.min_position_limit",
                          "software_position_limit.min_position_limit_2",
                          "software_position_limit.number_of_entries",
                          "software_position_limit.number_of_entries_2"));
  EXPECT_THAT(names.similar("zzzzzzzz"), IsEmpty());
}

}  // namespace
}  // namespace takt
