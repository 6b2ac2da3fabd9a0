#include "eds_parser/plan/device/device_compiler.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <stdexcept>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using test::compile;

std::uint64_t value_of(const DeviceTable& device, ObjectKey key) {
  const auto found = std::ranges::find(device.objects, key, &DeviceObject::key);
  if (found == device.objects.end()) throw std::runtime_error{"no object"};
  std::uint64_t value = 0;
  for (std::size_t i = found->value.size(); i-- > 0;) {
    value = (value << 8) | std::to_integer<std::uint64_t>(found->value[i]);
  }
  return value;
}

std::string with(std::string eds, const std::string& section, const std::string& line) {
  return eds.insert(eds.find(section) + section.size(), line);
}

TEST(DeviceCompiler, StartsWithDefaultsOfItsNode) {
  const auto net = compile("arm: {node_id: 5, dcf: x, sim: {model: plain, quirks: [late_bootup]}}");

  const DeviceTable& device = net.devices.at(0);
  EXPECT_EQ(value_of(device, {0x1000, 0}), 0x00020192U);
  EXPECT_EQ(value_of(device, {0x1800, 1}), 0x40000185U);
  EXPECT_EQ(value_of(device, {0x60C2, 2}), 0xFDU);
  EXPECT_EQ(device.dummy_usage, 0x20);
  EXPECT_EQ(device.model, "plain");
  EXPECT_EQ(device.quirks, std::vector<std::string>{"late_bootup"});
  EXPECT_TRUE(std::ranges::is_sorted(device.objects, {}, &DeviceObject::key));
}

double turn_of(const std::string& rest) {
  const auto net = compile("arm: {node_id: 5, dcf: x, " + rest + "}\n");
  return net.devices.at(0).mechanics.value().turn;
}

TEST(DeviceCompiler, ATurnOfTheMotorHasTheCountsOfItsUnits) {
  const std::string position = "units: {position: {scale: 0.001, unit: ";

  EXPECT_NEAR(turn_of("sim: {mechanics: {}}, " + position + "rad}}"), 6283.185, 1e-3);
  EXPECT_DOUBLE_EQ(turn_of("sim: {mechanics: {}}, " + position + "deg}}"), 360'000);
  EXPECT_DOUBLE_EQ(turn_of("sim: {mechanics: {turn: 0.01}}, " + position + "m}}"), 10);
  EXPECT_EQ(turn_of("sim: {mechanics: {}}, " + position + "m}}"), 65536) << "nothing is known";
  EXPECT_EQ(turn_of("sim: {mechanics: {turn: 4000}}"), 4000) << "counts";
}

TEST(DeviceCompiler, PlacesOnTheWayAreConvertedToCounts) {
  const auto net = compile(
      "arm: {node_id: 5, dcf: x, units: {position: {scale: 0.001, sign: -1, offset: 1, unit: m}}, "
      "sim: {mechanics: {travel: {home: [0, 2], index: 0.5}}}}\n");

  const TravelParameters& travel = net.devices.at(0).mechanics.value().travel;
  EXPECT_DOUBLE_EQ(travel.home.value().low, -1000);
  EXPECT_DOUBLE_EQ(travel.home.value().high, 1000);
  EXPECT_DOUBLE_EQ(travel.index.value(), 500);
}

TEST(DeviceCompiler, MechanicsAreForDrivesOnly) {
  std::string module = test::tiny_eds();
  module.replace(module.find("0x00020192"), 10, "0x00020191");

  const auto net = compile("arm: {node_id: 5, dcf: x, sim: {mechanics: {}}}\n", module);
  EXPECT_FALSE(net.devices.at(0).mechanics);
}

TEST(DeviceCompiler, WhatTheFileSaysOfAnObjectIsWithinItsLimits) {
  const std::string dcf =
      with(test::tiny_eds(), "[6081]\n", "HighLimit=2000\nParameterValue=7000\n");

  const auto net = compile("arm: {node_id: 5, dcf: x}\n", dcf, "tiny.dcf");

  const auto& objects = net.devices.at(0).objects;
  EXPECT_EQ(std::ranges::find(objects, ObjectKey{0x6081, 0}, &DeviceObject::key)->high_limit, 7000);
}

TEST(DeviceCompiler, ValuesOfADcfAreForTheMasterToWriteButIdentitiesAreTheDevices) {
  std::string dcf = with(test::tiny_eds(), "[6081]\n", "ParameterValue=777\n");
  dcf = with(dcf, "[1018sub1]\n", "ParameterValue=0x1234\n");

  const auto net = compile("arm: {node_id: 5, dcf: x}\n", dcf, "tiny.dcf");

  EXPECT_EQ(value_of(net.devices.at(0), {0x6081, 0}), 1000U);
  EXPECT_EQ(value_of(net.devices.at(0), {0x1018, 1}), 0x1234U);
}

TEST(DeviceCompiler, APdoOfUnknownCobIdIsOff) {
  const std::string eds = test::tiny_objects() + test::pdo(true, 1, "", 255, {"0x60410010"});

  const auto net = compile("arm: {node_id: 5, dcf: x}\n", eds);

  EXPECT_EQ(value_of(net.devices.at(0), {0x1800, 1}), 0x80000000U);
}

}  // namespace
}  // namespace takt
