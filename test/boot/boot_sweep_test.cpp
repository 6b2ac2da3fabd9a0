#include <ios>
#include <set>

#include "test/boot/plant.hpp"

// Every step of a boot fails in every way. Each report must name the object, the cause and a
// remedy.

namespace takt {
namespace {

using namespace test;
using enum sim::FaultKind;

const std::string everything =
    "tpdo: {1: {transmission: 10, event_timer: 50, mapping: [{index: 0x2010}, {index: 0x2012}]}}, "
    "sdo: [{index: 0x2000, value: 5}], error_behavior: {1: 2}, store_configuration: 1, "
    "configuration_date: auto, emcy_cob_id: 0x0C5, revision_number: 0x00010002";

const std::string update =
    "software_version: 0x00010001, software_file: program.bin, restore_configuration: 1, "
    "serial_number: 77";

bool talks_by_sdo(BootAction action) {
  switch (action) {
    case BootAction::probe:
    case BootAction::expect:
    case BootAction::compare:
    case BootAction::disable_pdo:
    case BootAction::write:
    case BootAction::enable_pdo:
    case BootAction::verify:
    case BootAction::write_if_differs:
    case BootAction::write_if_changed:
    case BootAction::await_value:
    case BootAction::download_program:
      return true;
    default:
      return false;
  }
}

/// Returns the objects of the SDO steps that must succeed.
std::set<ObjectKey> objects_of(const LoadedNetwork& network) {
  std::set<ObjectKey> objects;
  for (const BootStep& step : network.plan.nodes[0].boot_plan.steps) {
    if (talks_by_sdo(step.action) && !step.optional) objects.insert(step.object);
  }
  return objects;
}

std::string report(sim::FaultKind kind, ObjectKey object, std::uint32_t abort_code = 0,
                   const std::string& keys = everything) {
  sim::Fault fault{.kind = kind, .node = 5_node};
  fault.object = object;
  fault.abort_code = abort_code;
  Plant plant{valve(keys), {fault}};
  plant.run(object.index == 0x1F51 ? 300s : 15s);  // the flash memory gets three times one minute
  return plant.text_of(EventKind::boot_failed);
}

TEST(BootSweep, CoversMostOfWhatABootTouches) {
  EXPECT_GE(objects_of(valve(everything)).size(), 15u);
}

TEST(BootSweep, ARefusalAtAnyStepIsReportedWithObjectAbortAndRemedy) {
  for (const ObjectKey object : objects_of(valve(everything))) {
    const std::string text = report(refuse_object, object, 0x0800'0000);
    EXPECT_NE(text.find(to_string(object)), std::string::npos) << to_string(object) << "\n" << text;
    EXPECT_NE(text.find("abort 0800 0000: general error"), std::string::npos) << text;
    EXPECT_EQ(text.find(" differs"), std::string::npos) << text;
    EXPECT_NE(text.find("\n  try       "), std::string::npos) << text;
  }
}

TEST(BootSweep, SilenceAtAnyStepIsReportedWithObjectAndRemedy) {
  for (const ObjectKey object : objects_of(valve(everything))) {
    const std::string text = report(mute_sdo, object);
    EXPECT_NE(text.find(to_string(object)), std::string::npos) << to_string(object) << "\n" << text;
    EXPECT_NE(text.find("\n  received  nothing"), std::string::npos) << text;
    EXPECT_NE(text.find("\n  try       "), std::string::npos) << text;
  }
}

/// Returns the advice in a report, which starts at "try".
std::string advice(const std::string& text) {
  const auto at = text.find("\n  try       ");
  return at == std::string::npos ? "" : text.substr(at);
}

TEST(BootSweep, SilenceIsNeverTakenForADifference) {
  std::set<std::uint16_t> silent;
  for (const std::string& keys : {everything, update}) {
    for (const ObjectKey object : objects_of(valve(keys))) {
      const std::string text = report(mute_sdo, object, 0, keys);
      silent.insert(object.index);
      EXPECT_NE(text.find(to_string(object)), std::string::npos) << to_string(object) << "\n"
                                                                 << text;
      EXPECT_NE(text.find("nothing within"), std::string::npos) << text;
      EXPECT_EQ(text.find(" differs"), std::string::npos) << text;
      EXPECT_NE(advice(text), "") << text;
      for (const std::string blame : {"other than the configured", "another serial number",
                                      "other software", "its version differs", "another value",
                                      "another firmware", "did not accept", "does not report"}) {
        EXPECT_EQ(advice(text).find(blame), std::string::npos) << text;
      }
    }
  }
  for (const int index : {0x1011, 0x1018, 0x1F50, 0x1F51, 0x1F56}) {
    EXPECT_TRUE(silent.contains(static_cast<std::uint16_t>(index))) << std::hex << index;
  }
}

TEST(BootSweep, ARefusedWriteAtAnyStepIsReportedUnlessNothingHasToBeWritten) {
  int reported = 0;
  for (const ObjectKey object : objects_of(valve(everything))) {
    const std::string text = report(refuse_write, object, 0x0800'0021);
    if (text.empty()) continue;  // the boot only reads this object
    ++reported;
    EXPECT_NE(text.find(to_string(object)), std::string::npos) << to_string(object) << "\n" << text;
    EXPECT_NE(text.find("abort 0800 0021"), std::string::npos) << text;
    EXPECT_NE(text.find("\n  try       "), std::string::npos) << text;
  }
  EXPECT_GE(reported, 8);
}

TEST(BootSweep, AResetAtAnyMomentOfTheBootEndsInAReadyNode) {
  for (Time at = 40ms; at < 160ms; at += 1ms) {
    Plant plant{valve(everything), {{.kind = reset, .node = 5_node, .at = at}}};

    plant.run(5s);

    EXPECT_EQ(plant.node().boot, BootState::ready) << at.count() / 1'000'000 << " ms";
  }
}

TEST(BootSweep, APowerCutAtAnyMomentOfTheBootEndsInAReadyNode) {
  for (Time at = 40ms; at < 160ms; at += 4ms) {
    Plant plant{valve(everything),
                {{.kind = power_off, .node = 5_node, .at = at, .until = at + 2s}}};

    plant.run(12s);

    EXPECT_EQ(plant.node().boot, BootState::ready) << at.count() / 1'000'000 << " ms";
  }
}

}  // namespace
}  // namespace takt
