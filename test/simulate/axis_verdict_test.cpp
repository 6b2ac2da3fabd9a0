// What the ordered stop reports about a drive if only the device itself knows how it stops.
#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>

#include "test/simulate/lift.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::machine;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr const char* too_slow = "{index: 0x6085, value: 100}";

TEST(AxisVerdict, NamesAVelocityThatWasReadBySdoInTheUnitOfTheFile) {
  const test::Folder folder;
  const auto network = machine(
      folder,
      {.master = ", stop_timeout: 1000", .sdo = too_slow, .second_tpdo = "{enabled: false}"});
  const auto outcome = simulate(network, {.duration = 4300ms, .move = true});
  EXPECT_THAT(outcome.unconfirmed, ElementsAre(AllOf(StartsWith("z was disabled at "),
                                                     HasSubstr("m/s"), Not(HasSubstr("606C")))));
}

/// Sets the quick stop option code of drive z only in the device; the device file says 2.
LoadedNetwork coasting(const test::Folder& folder, std::uint8_t option) {
  LoadedNetwork network = machine(folder);
  auto& objects = network.devices.at(1).objects;
  const auto found = std::ranges::find(objects, ObjectKey{0x605A, 0}, &DeviceObject::key);
  EXPECT_NE(found, objects.end());
  found->value = {std::byte{option}, std::byte{0}};
  return network;
}

std::vector<std::string> warnings(const SimulationOutcome& outcome) {
  std::vector<std::string> texts;
  for (const ReportedEvent& event : outcome.events) {
    if (event.kind == EventKind::drive_coasts) texts.push_back(event.text);
  }
  return texts;
}

TEST(AxisVerdict, IsUnconfirmedWhereOnlyTheDeviceKnowsThatItCoasts) {
  const test::Folder folder;
  const LoadedNetwork network = coasting(folder, 0);
  EXPECT_EQ(network.plan.nodes[1].axes.at(0).quick_stop_option, 2);

  const auto outcome = simulate(network, {.duration = 4300ms, .move = true});

  EXPECT_THAT(warnings(outcome),
              ElementsAre(AllOf(StartsWith("node 2 'z': a quick stop disables the drive at once"),
                                HasSubstr("605A:00 is 0 in the device"))));
  EXPECT_EQ(outcome.stop, StopResult::unconfirmed);
  EXPECT_THAT(outcome.unconfirmed, ElementsAre(StartsWith("z was disabled ")));
}

TEST(AxisVerdict, IsConfirmedWhereTheDeviceBrakes) {
  const test::Folder folder;
  const auto outcome = simulate(coasting(folder, 6), {.duration = 4300ms, .move = true});
  EXPECT_THAT(warnings(outcome), IsEmpty());
  EXPECT_EQ(outcome.stop, StopResult::confirmed);
}

}  // namespace
}  // namespace takt
