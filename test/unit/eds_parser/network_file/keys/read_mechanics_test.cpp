#include <charconv>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/network_file/keys/key_reference.hpp"
#include "eds_parser/network_file/keys/read_network.hpp"
#include "eds_parser/network_file/keys/sections.hpp"
#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

test::Compiled read_sim(const std::string& sim) {
  test::Compiled out;
  const std::string yaml = "nodes: {arm: {node_id: 5, dcf: tiny.eds, sim: " + sim + "}}\n";
  out.spec = read_network(yaml, "net.yaml", out.findings);
  return out;
}

test::Compiled read_mechanics_of(const std::string& mechanics) {
  return read_sim("{mechanics: " + mechanics + "}");
}

/// Returns the messages of all errors.
std::vector<std::string> errors(const test::Compiled& net) {
  std::vector<std::string> out;
  for (const Finding& finding : net.findings) {
    if (finding.severity == Severity::error) out.push_back(finding.message);
  }
  return out;
}

TEST(ReadMechanics, AreNoneUnlessAskedFor) {
  EXPECT_FALSE(read_sim("{}").spec.nodes.at(0).sim.mechanics);
}

TEST(ReadMechanics, HaveDefaultsForAllTheirKeys) {
  const auto net = read_mechanics_of("{}");

  EXPECT_THAT(net.complaints(), IsEmpty());
  const auto& mechanics = net.spec.nodes.at(0).sim.mechanics;
  ASSERT_TRUE(mechanics);
  EXPECT_EQ(mechanics->motor.rated_torque, 1.27);
  EXPECT_FALSE(mechanics->load.stiffness);
}

TEST(ReadMechanics, AreReadWithAllTheirParts) {
  const auto net = read_mechanics_of(
      "{turn: 0.01, motor: {inertia: 1e-4, max_speed: 300}, load: {stiffness: 20, backlash: 0.01}, "
      "controller: {position_gain: 40}, encoder: {increments: 4096}, brake: {torque: 3}, "
      "travel: {switches: [-2, 3], index: 0.1}}");

  EXPECT_THAT(net.complaints(), IsEmpty());
  const MechanicsTable& mechanics = net.spec.nodes.at(0).sim.mechanics.value();
  EXPECT_EQ(mechanics.turn, 0.01);
  EXPECT_EQ(mechanics.motor.inertia, 1e-4);
  EXPECT_EQ(mechanics.load.stiffness, 20);
  EXPECT_EQ(mechanics.controller.position_gain, 40);
  EXPECT_EQ(mechanics.encoder.increments, 4096);
  EXPECT_EQ(mechanics.brake.torque, 3);
  EXPECT_EQ(mechanics.travel.switches.value().low, -2);
  EXPECT_EQ(mechanics.travel.switches.value().high, 3);
  EXPECT_EQ(mechanics.travel.index, 0.1);
}

TEST(ReadMechanics, RefuseWhatDoesNotFitTogether) {
  const auto complains = [](const std::string& mechanics, const char* text) {
    EXPECT_THAT(errors(read_mechanics_of(mechanics)), ElementsAre(HasSubstr(text))) << mechanics;
  };
  complains("{load: {backlash: 0.01}}", "belong to a coupling that has a `stiffness`");
  complains("{load: {stiffness: 1e9}}", "leave out `stiffness` if the coupling is rigid");
  complains("{motor: {peak_torque: 1}}", "`peak_torque` is below `rated_torque`");
  complains("{travel: {home: [2, 1]}}", "has to begin with the lower position");
  complains("{travel: {home: 2}}", "has to be two positions");
  complains("{controller: {velocity_bandwidth: 5}}", "the velocity controller is too slow");
}

TEST(ReadMechanics, BelongToADriveOnly) {
  EXPECT_THAT(errors(read_sim("{model: io401, mechanics: {}}")),
              ElementsAre(HasSubstr("belongs to the model `drive402`, not to `io401`")));
}

/// Returns the number at the beginning of a text, or 0.
double leading(std::string_view text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// The documents state a range and a default for each key. Both have to be those of the reader.

TEST(ReadMechanics, KeepToTheRangesThatTheirKeysState) {
  std::size_t checked = 0;
  for (const KeyText& part : mechanics_rows()) {
    if (part.value.parts == nullptr || part.name == "travel") continue;
    for (const KeyText& key : part.value.parts()) {
      const std::string meaning{key.meaning};
      const std::size_t to = meaning.find(" to ");
      ASSERT_NE(to, std::string::npos) << key.name;
      const std::size_t before = meaning.rfind(' ', to - 1);
      const double low = leading(meaning.substr(before == std::string::npos ? 0 : before + 1));
      const double high = leading(meaning.substr(to + 4));
      ASSERT_LT(low, high) << key.name;
      const auto findings = [&](double value) {
        const std::string text = std::to_string(value);
        return errors(read_mechanics_of("{" + std::string{part.name} + ": {" +
                                        std::string{key.name} + ": " + text + "}}"));
      };
      EXPECT_THAT(findings(high * 1.01 + 1e-5), ElementsAre(HasSubstr("has to be from")))
          << key.name;
      EXPECT_THAT(findings(low - 1), ElementsAre(HasSubstr("has to be from"))) << key.name;
      ++checked;
    }
  }
  EXPECT_EQ(checked, 26U);
}

}  // namespace
}  // namespace takt
