// Limits of the sum of a target and its offset.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/limits/limited_drive.hpp"

namespace takt::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::string offsets() {
  return entry("60B1", "Velocity offset", 4, "rww", "0", true) +
         entry("6071", "Target torque", 3, "rww", "0", true) +
         entry("60B2", "Torque offset", 3, "rww", "0", true);
}

TEST(Limits, OfTargetsHoldForTheSumWithTheirOffset) {
  const Compiled net = compile(
      "master: {sync_period: 2000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n"
      "    rpdo:\n"
      "      1: {enabled: true, mapping: [{index: 0x6071}, {index: 0x60B2}]}\n"
      "      2: {enabled: true, mapping: [{index: 0x60FF}, {index: 0x60B1}]}\n"
      "    units: {velocity: {scale: 0.01, unit: rad/s}, torque: {scale: 0.001, unit: Nm}}\n"
      "    limits: {velocity: 2, torque: 0.5}\n",
      tiny_eds() + offsets());
  EXPECT_THAT(net.complaints(), IsEmpty());
  ASSERT_EQ(net.plan.limits.outputs.size(), 4U);
  std::vector<std::string> sums;
  for (const OutputLimit& row : net.plan.limits.outputs) {
    const auto object = [&](SignalIndex signal) {
      return to_string(net.plan.layout.signals[signal].object);
    };
    if (row.offset) sums.push_back(object(row.signal) + " + " + object(*row.offset));
    if (row.target) sums.push_back(object(row.signal) + " to " + object(*row.target));
  }
  EXPECT_THAT(sums, UnorderedElementsAre("6071:00 + 60B2:00", "60B2:00 to 6071:00",
                                         "60FF:00 + 60B1:00", "60B1:00 to 60FF:00"));
  EXPECT_THAT(text_of(net),
              AllOf(HasSubstr("2 rad/s  from the network file, of the sum 60FF:00 + 60B1:00\n"),
                    HasSubstr("0.5 Nm   from the network file, of the sum 6071:00 + 60B2:00\n")));
  EXPECT_THAT(json_of(net), HasSubstr(R"("sums")"));
}

TEST(Limits, OfAnOffsetInAnotherUnitThanItsTargetHoldForEachAlone) {
  const Compiled net = compile(
      "master: {sync_period: 2000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n"
      "    rpdo: {2: {enabled: true, mapping: [{index: 0x60FF}, {index: 0x60B1}]}}\n" +
          std::string{units} +
          "      objects: [{index: 0x60B1, scale: 1, unit: rpm}]\n"
          "    limits: {velocity: 2}\n",
      tiny_eds() + offsets());
  EXPECT_THAT(net.declared("limits"), HasSubstr("are in rad/s and rpm: takt can't add them"));
  for (const OutputLimit& row : net.plan.limits.outputs) EXPECT_FALSE(row.offset || row.target);
}

}  // namespace
}  // namespace takt::test
