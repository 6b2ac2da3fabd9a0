#include <gtest/gtest.h>
#include <ios>

#include "master/sim/device/device.hpp"
#include "master/wire/bytes.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

/// Writes by SDO to the PDO objects of a device.
class PdoRules : public testing::Test {
 protected:
  PdoRules()
      : device_{communicating(5_node)
                    .pdo(0x1400, 0x205, 255, {0x20100020, 0x20120010})
                    .pdo(0x1800, 0x4000'0185, 1, {0x20110020})
                    .pdo(0x1801, 0x8000'0285, 1, {})
                    .build(),
                Random{1}} {
    device_.power_on(0ns);
    device_.on_time(50ms);
    device_.out().clear();
  }

  /// Returns the abort code of an expedited write of `size` bytes; 0 means success.
  std::uint32_t write(std::uint16_t index, std::uint8_t sub, std::uint32_t value, unsigned size) {
    Frame request =
        make_frame(CobId::base(0x605), {static_cast<std::uint8_t>(0x23 | (4 - size) << 2),
                                        static_cast<std::uint8_t>(index & 0xFF),
                                        static_cast<std::uint8_t>(index >> 8), sub, 0, 0, 0, 0});
    for (unsigned i = 0; i < 4; ++i)
      request.data[4 + i] = static_cast<std::uint8_t>(value >> (8 * i));
    device_.on_frame(request, now_ += 1ms);
    const auto answer = device_.out().pending().back().frame.data;
    device_.out().clear();
    if (answer[0] == 0x60) return 0;
    EXPECT_EQ(answer[0], 0x80);
    return load_le<std::uint32_t>(std::span{answer}.subspan(4));
  }
  void disable(std::uint16_t communication, std::uint32_t cob) {
    ASSERT_EQ(write(communication, 1, cob | 0x8000'0000, 4), 0u);
  }

  Device device_;
  Time now_ = 50ms;
};

TEST_F(PdoRules, TakesTheProcedureOfTheStandard) {
  EXPECT_EQ(write(0x1800, 1, 0x8000'0185, 4), 0u);
  EXPECT_EQ(write(0x1A00, 0, 0, 1), 0u);
  EXPECT_EQ(write(0x1A00, 1, 0x2012'0010, 4), 0u);
  EXPECT_EQ(write(0x1A00, 2, 0x2011'0020, 4), 0u);
  EXPECT_EQ(write(0x1A00, 0, 2, 1), 0u);
  EXPECT_EQ(write(0x1800, 2, 1, 1), 0u);
  EXPECT_EQ(write(0x1800, 1, 0x4000'0185, 4), 0u);
}

TEST_F(PdoRules, ATpdoThatIsEnabledInOperationalIsSentAtTheNextSync) {
  device_.on_frame(make_frame(CobId::base(0), {1, 5}), now_ += 1ms);
  device_.out().clear();
  const Frame sync{.id = CobId::base(0x080)};
  device_.on_frame(sync, now_ += 1ms);
  EXPECT_EQ(device_.out().pending().size(), 1u);
  device_.out().clear();

  ASSERT_EQ(write(0x1A01, 1, 0x2011'0020, 4), 0u);
  ASSERT_EQ(write(0x1A01, 0, 1, 1), 0u);
  ASSERT_EQ(write(0x1801, 1, 0x4000'0285, 4), 0u);
  device_.on_frame(sync, now_ += 1ms);
  ASSERT_EQ(device_.out().pending().size(), 2u);
  EXPECT_EQ(device_.out().pending()[1].frame.id, CobId::base(0x285));
  device_.out().clear();

  disable(0x1800, 0x185);
  device_.on_frame(sync, now_ += 1ms);
  EXPECT_EQ(device_.out().pending().size(), 1u);
}

TEST_F(PdoRules, RefuseTheWrongOrder) {
  EXPECT_EQ(write(0x1800, 1, 0x4000'0186, 4), 0x0609'0030u) << "another id while valid";
  EXPECT_EQ(write(0x1A00, 0, 0, 1), 0x0601'0000u) << "mapping while valid";
  EXPECT_EQ(write(0x1A00, 1, 0x2012'0010, 4), 0x0601'0000u);
  disable(0x1800, 0x185);
  EXPECT_EQ(write(0x1A00, 1, 0x2012'0010, 4), 0x0601'0000u) << "entry while sub 0 is not 0";
}

TEST_F(PdoRules, RefuseEntriesThatCanNotBe) {
  disable(0x1800, 0x185);
  ASSERT_EQ(write(0x1A00, 0, 0, 1), 0u);

  EXPECT_EQ(write(0x1A00, 1, 0x3000'0020, 4), 0x0602'0000u) << "no such object";
  EXPECT_EQ(write(0x1A00, 1, 0x2010'0520, 4), 0x0609'0011u) << "no such sub-object";
  EXPECT_EQ(write(0x1A00, 1, 0x2000'0010, 4), 0x0604'0041u) << "not mappable";
  EXPECT_EQ(write(0x1A00, 1, 0x2012'0020, 4), 0x0604'0041u) << "longer than the object";
  EXPECT_EQ(write(0x1A00, 1, 0x2010'0010, 4), 0x0607'0010u) << "shorter than the object";
  EXPECT_EQ(write(0x1A00, 1, 0x0005'0008, 4), 0x0602'0000u) << "a dummy in a TPDO";
}

/// In files of vendors the default mapping may have an entry that the rest of the file forbids.
TEST(PdoRulesOfVendors, ADeviceTakesBackTheMappingThatItCameWith) {
  Device device{communicating(5_node).pdo(0x1400, 0x205, 255, {0x2010'0010}).build(), Random{1}};
  device.power_on(0ns);
  device.on_time(50ms);
  Time now = 50ms;
  const auto write = [&](std::initializer_list<std::uint8_t> bytes) {
    device.out().clear();
    device.on_frame(make_frame(CobId::base(0x605), bytes), now += 1ms);
    return device.out().pending().back().frame.data[0];
  };

  EXPECT_EQ(write({0x23, 0x00, 0x14, 1, 0x05, 0x02, 0x00, 0x80}), 0x60);
  EXPECT_EQ(write({0x2F, 0x00, 0x16, 0, 0, 0, 0, 0}), 0x60);
  EXPECT_EQ(write({0x23, 0x00, 0x16, 1, 0x10, 0x00, 0x11, 0x20}), 0x80)
      << "another that is too short";
  EXPECT_EQ(write({0x23, 0x00, 0x16, 1, 0x10, 0x00, 0x10, 0x20}), 0x60);
  EXPECT_EQ(write({0x2F, 0x00, 0x16, 0, 1, 0, 0, 0}), 0x60);
  EXPECT_EQ(write({0x23, 0x00, 0x14, 1, 0x05, 0x02, 0x00, 0x00}), 0x60);
}

TEST_F(PdoRules, RefuseAReadOnlyObjectInAnRpdo) {
  disable(0x1400, 0x205);
  ASSERT_EQ(write(0x1600, 0, 0, 1), 0u);

  EXPECT_EQ(write(0x1600, 1, 0x2013'0010, 4), 0x0604'0041u);
}

TEST_F(PdoRules, RefuseMoreThan64Bits) {
  disable(0x1800, 0x185);
  ASSERT_EQ(write(0x1A00, 0, 0, 1), 0u);
  ASSERT_EQ(write(0x1A00, 1, 0x2014'0040, 4), 0u);
  ASSERT_EQ(write(0x1A00, 2, 0x2012'0010, 4), 0u);

  EXPECT_EQ(write(0x1A00, 0, 2, 1), 0x0604'0042u);
  EXPECT_EQ(write(0x1A00, 0, 1, 1), 0u);
}

TEST_F(PdoRules, RefuseMoreEntriesThanThereAre) {
  disable(0x1800, 0x185);
  ASSERT_EQ(write(0x1A00, 0, 0, 1), 0u);

  EXPECT_EQ(write(0x1A00, 0, 9, 1), 0x0602'0000u) << "sub 2 is empty";
  EXPECT_EQ(write(0x1A00, 0, 65, 1), 0x0609'0030u);
}

TEST_F(PdoRules, RefuseReservedTypes) {
  for (const std::uint32_t type : {241u, 250u, 253u}) {
    EXPECT_EQ(write(0x1400, 2, type, 1), 0x0609'0030u) << type;
  }
  EXPECT_EQ(write(0x1800, 2, 251, 1), 0x0609'0030u);
  EXPECT_EQ(write(0x1800, 2, 253, 1), 0u);
  EXPECT_EQ(write(0x1400, 2, 240, 1), 0u);
  EXPECT_EQ(write(0x1400, 2, 254, 1), 0u);
}

TEST_F(PdoRules, RefuseRestrictedIdentifiers) {
  disable(0x1800, 0x185);

  for (const std::uint32_t id :
       {0x000u, 0x07Fu, 0x101u, 0x180u, 0x581u, 0x601u, 0x6E0u, 0x701u, 0x7FFu}) {
    EXPECT_EQ(write(0x1800, 1, id, 4), 0x0609'0030u) << std::hex << id;
  }
  EXPECT_EQ(write(0x1800, 1, 0x800, 4), 0x0609'0030u) << "12 bits without bit 29";
  EXPECT_EQ(write(0x1800, 1, 0x181, 4), 0u);
}

TEST_F(PdoRules, KeepInhibitTimeAndSyncStartWhileValid) {
  EXPECT_EQ(write(0x1800, 3, 10, 2), 0x0609'0030u);
  EXPECT_EQ(write(0x1800, 6, 1, 1), 0x0609'0030u);
  EXPECT_EQ(write(0x1800, 5, 10, 2), 0u);
  disable(0x1800, 0x185);
  EXPECT_EQ(write(0x1800, 3, 10, 2), 0u);
  EXPECT_EQ(write(0x1800, 6, 241, 1), 0x0609'0030u);
  EXPECT_EQ(write(0x1800, 6, 240, 1), 0u);
}

TEST_F(PdoRules, DoNotEnableAPdoWithoutMapping) {
  EXPECT_EQ(write(0x1801, 1, 0x285, 4), 0x0609'0030u);
}

TEST_F(PdoRules, KeepTheCounterOverflowWhileThereIsAPeriod) {
  EXPECT_EQ(write(0x1019, 0, 1, 1), 0x0609'0030u);
  EXPECT_EQ(write(0x1019, 0, 241, 1), 0x0609'0030u);
  ASSERT_EQ(write(0x1006, 0, 2000, 4), 0u);
  EXPECT_EQ(write(0x1019, 0, 10, 1), 0x0800'0022u);
  ASSERT_EQ(write(0x1006, 0, 0, 4), 0u);
  EXPECT_EQ(write(0x1019, 0, 10, 1), 0u);
}

TEST_F(PdoRules, RefuseTheSameNodeTwiceIn1016) {
  EXPECT_EQ(write(0x1016, 1, 0x007F'0064, 4), 0u);
  EXPECT_EQ(write(0x1016, 2, 0x007F'0032, 4), 0x0604'0043u);
}

TEST_F(PdoRules, RefuseANewEmcyIdentifierWhileValid) {
  EXPECT_EQ(write(0x1014, 0, 0x86, 4), 0x0609'0030u);
  EXPECT_EQ(write(0x1014, 0, 0x8000'0085, 4), 0u);
  EXPECT_EQ(write(0x1014, 0, 0x86, 4), 0u);
}

TEST_F(PdoRules, TakeANewEmcyIdentifierWhereTheLimitsForbidBit31) {
  device_.objects().find({0x1014, 0})->high = 0x1FFF'FFFF;

  EXPECT_EQ(write(0x1014, 0, 0x8000'0085, 4), 0x0609'0031u);
  EXPECT_EQ(write(0x1014, 0, 0x86, 4), 0u);
}

TEST_F(PdoRules, RefuseEveryMappingWriteOfAFixedMapping) {
  device_.faults().fixed_mapping = true;
  disable(0x1800, 0x185);

  EXPECT_EQ(write(0x1A00, 0, 0, 1), 0x0601'0002u);
}

}  // namespace
}  // namespace takt::sim
