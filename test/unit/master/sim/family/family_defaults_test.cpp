// The factory settings of each family: values after power-on with the EDS of share/eds.
#include <gtest/gtest.h>
#include <optional>

#include "test/unit/master/sim/family/family_device.hpp"

namespace takt::sim {
namespace {

/// Returns the value of an object; empty if there is no such object.
std::optional<std::uint64_t> value(FamilyDevice& device, ObjectKey key) {
  const Object* object = device.device().objects().find(key);
  if (object == nullptr) return std::nullopt;
  return object->value;
}

struct Default {
  ObjectKey key;
  std::uint64_t value;
};

void has(FamilyDevice& device, const std::vector<Default>& defaults) {
  for (const Default& one : defaults)
    EXPECT_EQ(value(device, one.key), one.value) << to_string(one.key);
}

/// Table 3-12 of the manual, for node 5.
TEST(FamilyDefaults, OfADrv28AreThoseOfItsTable) {
  FamilyDevice device{"astraada_drv28.eds", "astraada_drv28"};
  has(device, {{{0x1800, 2}, 255}, {{0x1801, 2}, 254}, {{0x1802, 2}, 254}, {{0x1803, 2}, 254}});
  has(device, {{{0x1800, 5}, 0}, {{0x1801, 5}, 0}, {{0x1802, 5}, 0}, {{0x1803, 5}, 0}});
  has(device, {{{0x1800, 3}, 500}, {{0x1801, 3}, 500}, {{0x1802, 3}, 500}, {{0x1803, 3}, 500}});
  has(device, {{{0x1400, 1}, 0x205}, {{0x1401, 1}, 0x305}, {{0x1402, 1}, 0x405}});
  has(device, {{{0x1800, 1}, 0x185}, {{0x1801, 1}, 0x285}, {{0x1802, 1}, 0x385}});
}

/// C00367 and C00368 are 0x80; two pairs of event-driven PDOs and two SDO servers are enabled.
TEST(FamilyDefaults, OfALenzeAreOneSyncIdentifierTwoPairsOfPdosAndTwoSdoServers) {
  FamilyDevice device{"lenze8400.eds", "lenze8400"};
  has(device, {{{0x1005, 0}, 0x80}, {{0x5E90, 0}, 0x80}, {{0x5E8F, 0}, 0x80}});
  has(device, {{{0x1800, 2}, 254}, {{0x1801, 2}, 254}, {{0x1802, 2}, 254}, {{0x1803, 2}, 254}});
  has(device, {{{0x1800, 1}, 0x185},
               {{0x1801, 1}, 0x285},
               {{0x1802, 1}, 0x8000'0385},
               {{0x1803, 1}, 0x8000'0485}});
  has(device, {{{0x1400, 2}, 254}, {{0x1401, 2}, 254}});
  has(device, {{{0x1201, 1}, 0x645}, {{0x1201, 2}, 0x5C5}});
}

/// "Digital inputs (n = 1) ... analog inputs (e.g. n = 10)".
TEST(FamilyDefaults, OfTerminalsAreEachSyncAndEachTenth) {
  FamilyDevice device{"beckhoff_io.eds", "beckhoff"};
  has(device, {{{0x1800, 2}, 1}, {{0x1801, 2}, 10}, {{0x1400, 2}, 1}, {{0x1401, 2}, 1}});
  has(device, {{{0x1A00, 1}, 0x6000'0108}, {{0x1A01, 1}, 0x6401'0110}});
}

/// "The Number of entries for a TPDO is 5"; sub 4 must not be implemented.
TEST(FamilyDefaults, OfAPlainDeviceAreFiveParametersOfATpdoWithoutTheFourth) {
  FamilyDevice device{"plain301.eds", "plain301"};
  for (const std::uint16_t index : std::vector<std::uint16_t>{0x1800, 0x1801, 0x1802}) {
    has(device, {{{index, 0}, 5}, {{index, 3}, 0}, {{index, 5}, 0}});
    EXPECT_EQ(value(device, {index, 4}), std::nullopt);
    EXPECT_EQ(value(device, {index, 6}), std::nullopt);
  }
}

TEST(FamilyAborts, OfTerminalsAreThoseOfReservedTypesAndMissingObjects) {
  FamilyDevice device{"beckhoff_io.eds", "beckhoff"};
  for (std::uint32_t type = 241; type <= 251; ++type) {
    EXPECT_EQ(device.write({0x1800, 2}, type, 1), 0x0609'0030U) << type;
    EXPECT_EQ(device.write({0x1400, 2}, type, 1), 0x0609'0030U) << type;
  }
  EXPECT_EQ(device.write({0x1400, 2}, 252, 1), 0x0609'0030U) << "of TPDOs only";
  EXPECT_EQ(device.read({0x1800, 4}), 0x0609'0011U);
  EXPECT_EQ(device.read({0x1802, 1}), 0x0602'0000U);
}

/// An error of the parameter channel does not change the value.
TEST(FamilyAborts, OfTheParameterChannelChangeNothing) {
  FamilyDevice device{"astraada_drv28.eds", "astraada_drv28"};
  device.start();
  const auto ask = [&](std::initializer_list<std::uint8_t> data) {
    device.clear();
    device.receive(make_frame(CobId::base(0x205), data));
    return device.of(0x185).at(0);
  };
  const auto is = [](std::initializer_list<std::uint8_t> data) {
    return make_frame(CobId::base(0x185), data);
  };

  EXPECT_EQ(ask({0x02, 0, 0x0A, 0x00, 0x88, 0x13, 0, 0}), is({1, 0, 0, 0, 0x88, 0x13, 0, 0}));
  EXPECT_EQ(ask({0x02, 0, 0x0A, 0x00, 0xFF, 0xFF, 0, 0}), is({3, 0, 3, 0, 0, 0, 0, 0})) << "value";
  EXPECT_EQ(ask({0x05, 0, 0x0A, 0x00, 1, 0, 0, 0}), is({3, 0, 1, 0, 0, 0, 0, 0})) << "command";
  EXPECT_EQ(ask({0x02, 0, 0x0A, 0x00, 1, 0}), is({3, 0, 6, 0, 0, 0, 0, 0})) << "frame";
  EXPECT_EQ(ask({0x01, 0, 0x0A, 0x00, 0, 0, 0, 0}), is({1, 0, 0, 0, 0x88, 0x13, 0, 0}));
}

}  // namespace
}  // namespace takt::sim
