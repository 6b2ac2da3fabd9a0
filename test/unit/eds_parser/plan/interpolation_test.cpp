// What the plan says about interpolated position mode, whose points go through a buffer of the
// drive.
#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <utility>

#include "eds_parser/network_file/load_network.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Interpolation : public testing::Test {
 protected:
  /// Returns the messages for a drive whose RPDO1 has points, with this transmission and these
  /// `sdo:` entries.
  std::string reported(const std::string& transmission, const std::string& sdo = "") {
    const std::string text =
        "bus: {name: lift}\nmaster: {sync_period: 2000}\nnodes:\n  a:\n    dcf: " TAKT_SOURCE_DIR
        "/share/eds/takt_servo402.eds\n    node_id: 1\n    sdo: [{index: 0x6060, value: 7}" +
        sdo +
        "]\n    tpdo: {1: {transmission: 1, mapping: [0x6041, 0x6064]}, 2: {enabled: "
        "false}, 3: {enabled: false}, 4: {enabled: false}}\n    rpdo: {1: {transmission: " +
        transmission +
        ", mapping: [0x6040, 0x60C1:1]}, 2: {enabled: false}, 3: {enabled: false}, "
        "4: {enabled: false}}\n";
    LoadedNetwork network = load_network(folder_.write("net.yaml", text));
    std::string messages;
    for (const Finding& finding : network.findings) messages += to_string(finding) + "\n";
    plan_ = std::move(network.plan);
    return messages;
  }
  const BootStep* step(ObjectKey object) const {
    const auto& steps = plan_.nodes.at(0).boot_plan.steps;
    const auto found = std::ranges::find(steps, object, &BootStep::object);
    return found == steps.end() ? nullptr : &*found;
  }

  const test::Folder folder_;
  BusPlan plan_;
};

TEST_F(Interpolation, APointWithEachSyncNeedsNoAdviceAndTheBootOpensTheBuffer) {
  EXPECT_THAT(reported("1"), Not(HasSubstr("[interpolation-buffer]")));
  ASSERT_NE(step({0x60C4, 6}), nullptr);
  EXPECT_EQ(step({0x60C4, 6})->action, BootAction::write);
}

TEST_F(Interpolation, ABufferThatTheNetworkFileOpensIsWrittenOnce) {
  EXPECT_THAT(reported("1", ", {index: 0x60C4, sub_index: 6, value: 1}"),
              Not(HasSubstr("[interpolation-buffer]")));
  const auto& steps = plan_.nodes.at(0).boot_plan.steps;
  EXPECT_EQ(std::ranges::count(steps, ObjectKey{0x60C4, 6}, &BootStep::object), 1);
}

TEST_F(Interpolation, PointsThatComeTooSeldomEmptyTheBuffer) {
  EXPECT_THAT(
      reported("4"),
      AllOf(HasSubstr("RPDO1 of node `a` carries points of interpolated position mode (60C1:01) "
                      "every 8 ms, but the drive takes one every 2 ms (0x60C2): its buffer runs "
                      "empty, and the axis stops in every period. Write `transmission: 1`"),
            HasSubstr("[interpolation-buffer]")));
  EXPECT_THAT(reported("1", ", {index: 0x60C2, sub_index: 1, value: 1}"),
              HasSubstr("every 2 ms, but the drive takes one every 1 ms (0x60C2): its buffer runs "
                        "empty, and the axis stops in every period. Remove the entry of 0x60C2"));
}

/// The buffer has 16 points (0x60C4:02). In 16 ms it gets 8 points, of which the drive takes 4.
TEST_F(Interpolation, PointsThatComeTooOftenFillTheBuffer) {
  EXPECT_THAT(reported("1", ", {index: 0x60C2, sub_index: 1, value: 4}"),
              HasSubstr("every 2 ms, but the drive takes one only every 4 ms (0x60C2): its buffer "
                        "of 16 points (0x60C4) is full after 64 ms, and further points are lost"));
}

TEST_F(Interpolation, PointsWithoutSyncAreLate) {
  EXPECT_THAT(reported("255"),
              HasSubstr("but is not sent with each SYNC (transmission 255): the buffer of the "
                        "drive runs empty when a point is late, and the axis stops"));
}

TEST_F(Interpolation, ThePointFollowsTheActualPositionBeforeTheFirstCommand) {
  reported("1");
  const auto point = plan_.layout.find(0, {0x60C1, 1}, true);
  ASSERT_TRUE(point);
  EXPECT_EQ(plan_.layout.signals[*point].seeded_from, plan_.layout.find(0, {0x6064, 0}, false));
}

}  // namespace
}  // namespace takt
