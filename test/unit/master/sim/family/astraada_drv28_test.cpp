// The expected times follow the manual of the card, section 3.5: triggering modes and default
// settings.
#include <gtest/gtest.h>

#include "test/unit/master/sim/family/family_device.hpp"

namespace takt::sim {
namespace {

using Times = std::vector<int>;

FamilyDevice drv28() { return {"astraada_drv28.eds", "astraada_drv28"}; }

constexpr std::uint32_t refused = 0x06090030;

Frame request(std::initializer_list<std::uint8_t> data) {
  return make_frame(CobId::base(0x205), data);
}

TEST(AstraadaDrv28, Type254SendsAChangeOnceInTheDisabledTimeOf500Ms) {
  FamilyDevice device = drv28();
  device.start();

  device.at(10);
  device.words(0x305, {0, 0, 1, 0});
  device.at(100);
  device.words(0x305, {0, 0, 2, 0});
  device.at(200);
  device.words(0x305, {0, 0, 3, 0});
  device.at(2000);

  EXPECT_EQ(device.times(0x285), (Times{10, 510}));
  EXPECT_EQ(device.of(0x285)[1].data[4], 3) << "the newest value";
}

TEST(AstraadaDrv28, Type254DoesNotSendWithoutAChange) {
  FamilyDevice device = drv28();
  device.start();

  device.at(10);
  device.words(0x305, {0, 0, 0, 0});
  device.at(3000);

  EXPECT_EQ(device.times(0x285), Times{});
}

TEST(AstraadaDrv28, CountsTheDisabledTimeInMilliseconds) {
  FamilyDevice device = drv28();
  EXPECT_EQ(device.write({0x1801, 1}, 0x80000285, 4), 0u);
  EXPECT_EQ(device.write({0x1801, 3}, 100, 2), 0u);
  EXPECT_EQ(device.write({0x1801, 1}, 0x00000285, 4), 0u);
  device.start();

  for (int ms = 10; ms <= 40; ms += 10) {
    device.at(ms);
    device.words(0x305, {0, 0, static_cast<std::uint16_t>(ms), 0});
  }
  device.at(1000);

  EXPECT_EQ(device.times(0x285), (Times{10, 110}));
}

TEST(AstraadaDrv28, TakesAShorterDisabledTimeAs50Ms) {
  for (const std::uint32_t disabled : {0u, 20u, 49u}) {
    FamilyDevice device = drv28();
    device.write({0x1801, 1}, 0x80000285, 4);
    device.write({0x1801, 3}, disabled, 2);
    device.write({0x1801, 1}, 0x00000285, 4);
    device.start();

    device.at(10);
    device.words(0x305, {0, 0, 1, 0});
    device.at(11);
    device.words(0x305, {0, 0, 2, 0});
    device.at(500);

    EXPECT_EQ(device.times(0x285), (Times{10, 60})) << disabled;
  }
}

TEST(AstraadaDrv28, SendsByItsEventTimerAloneWhereItHasOne) {
  for (const std::uint32_t type : {254u, 255u}) {
    FamilyDevice device = drv28();
    device.write({0x1801, 2}, type, 1);
    device.write({0x1801, 5}, 200, 2);
    device.start();

    device.at(50);
    device.words(0x305, {0, 0, 1, 0});
    device.at(650);

    EXPECT_EQ(device.times(0x285), (Times{200, 400, 600})) << type;
  }
}

TEST(AstraadaDrv28, Type255AnswersTheRpdoOfItsNumber) {
  FamilyDevice device = drv28();
  device.write({0x1801, 2}, 255, 1);
  device.start();

  device.at(10);
  device.words(0x305, {0, 0, 7, 0});
  device.at(20);
  device.words(0x305, {0, 0, 7, 0});
  device.at(30);
  device.words(0x405, {1, 2, 3, 4});
  device.at(2000);

  EXPECT_EQ(device.times(0x285), (Times{10, 20})) << "changed or not, and RPDO3 is none of its";
  EXPECT_EQ(device.of(0x285)[0].data[4], 7);
  EXPECT_EQ(device.times(0x385), (Times{30})) << "TPDO3 has 254: the change";
}

TEST(AstraadaDrv28, TypeNFollowsEachNthSync) {
  FamilyDevice device = drv28();
  device.write({0x1801, 2}, 3, 1);
  device.start();

  for (int ms = 10; ms <= 70; ms += 10) {
    device.at(ms);
    device.sync();
  }

  EXPECT_EQ(device.times(0x285), (Times{30, 60}));
}

TEST(AstraadaDrv28, IsNotPolledByRtr) {
  FamilyDevice device = drv28();
  device.start();

  device.at(10);
  for (const std::uint32_t id : {0x185u, 0x285u, 0x385u}) device.request(id);

  for (const std::uint32_t id : {0x185u, 0x285u, 0x385u}) EXPECT_EQ(device.times(id), Times{});
}

TEST(AstraadaDrv28, RefusesTheTypesThatItsTableLacks) {
  FamilyDevice device = drv28();

  for (std::uint32_t type = 0; type <= 255; ++type) {
    const bool known = (type >= 1 && type <= 240) || type >= 254;
    EXPECT_EQ(device.write({0x1802, 2}, type, 1), known ? 0 : refused) << type;
  }
}

TEST(AstraadaDrv28, LeavesItsParameterChannelAsItIs) {
  FamilyDevice device = drv28();

  EXPECT_EQ(device.write({0x1800, 2}, 254, 1), refused);
  EXPECT_EQ(device.write({0x1800, 2}, 1, 1), refused);
  EXPECT_EQ(device.write({0x1800, 2}, 255, 1), 0u);
  EXPECT_EQ(device.write({0x1800, 5}, 100, 2), refused);
  EXPECT_EQ(device.write({0x1800, 5}, 0, 2), 0u);
  EXPECT_EQ(device.write({0x1A01, 0}, 0, 1), 0x06010002u) << "the mapping is fixed";
}

TEST(AstraadaDrv28, AnswersParameterRequests) {
  FamilyDevice device = drv28();
  device.start();

  device.at(10);
  device.receive(request({0x02, 0x00, 0x0D, 0x0F, 0x01, 0x00, 0x00, 0x00}));  // P15.13 := 1
  device.receive(request({0x01, 0x00, 0x0D, 0x0F, 0x00, 0x00, 0x00, 0x00}));
  device.receive(request({0x00, 0x00, 0x0D, 0x0F, 0x00, 0x00, 0x00, 0x00}));

  const auto id = CobId::base(0x185);
  EXPECT_EQ(device.times(0x185), (Times{10, 10, 10}));
  EXPECT_EQ(device.of(0x185)[0], make_frame(id, {0x01, 0, 0, 0, 0x01, 0, 0, 0}));
  EXPECT_EQ(device.of(0x185)[1], make_frame(id, {0x01, 0, 0, 0, 0x01, 0, 0, 0}));
  EXPECT_EQ(device.of(0x185)[2], make_frame(id, {0x00, 0, 0, 0, 0x00, 0, 0, 0}));
}

TEST(AstraadaDrv28, ReportsByErrorCodeWhyARequestFails) {
  struct Case {
    std::initializer_list<std::uint8_t> request;
    std::uint8_t error;
  };
  const Case cases[] = {
      {{0x04, 0, 0x0D, 0x0F, 1, 0, 0, 0}, 1},        // write to EEPROM: reserved
      {{0x01, 0, 0xFF, 0x0F, 0, 0, 0, 0}, 2},        // P15.255
      {{0x02, 0, 0x0A, 0x00, 0xFF, 0xFF, 0, 0}, 3},  // P00.10 := 655.35 Hz
      {{0x02, 0, 0x02, 0x05, 1, 0, 0, 0}, 4},        // terminal 2 like terminal 1
      {{0x01, 0, 0x0D, 0x0F, 0, 0}, 6},              // six bytes
      {{0x02, 0, 0x00, 0x11, 1, 0, 0, 0}, 7},        // P17.00 is read-only
  };
  FamilyDevice device = drv28();
  device.start();

  for (const Case& one : cases) {
    device.clear();
    device.receive(request(one.request));
    ASSERT_EQ(device.of(0x185).size(), 1u);
    EXPECT_EQ(device.of(0x185)[0],
              make_frame(CobId::base(0x185), {0x03, 0, one.error, 0, 0, 0, 0, 0}));
  }
}

TEST(AstraadaDrv28, ProtectsParametersByPasswordAndWhileItRuns) {
  FamilyDevice device = drv28();
  device.start();
  const auto answer = [&](std::initializer_list<std::uint8_t> data) {
    device.clear();
    device.receive(request(data));
    return device.of(0x185).at(0).data[2];
  };

  EXPECT_EQ(answer({0x02, 0, 0x03, 0x00, 0x10, 0x27, 0, 0}), 0) << "P00.03 := 100 Hz, stopped";
  device.words(0x305, {1, 5000, 0, 0});  // forward, 50 Hz
  device.at(100);
  EXPECT_EQ(answer({0x02, 0, 0x03, 0x00, 0x88, 0x13, 0, 0}), 8);
  EXPECT_EQ(answer({0x02, 0, 0x00, 0x07, 0x34, 0x12, 0, 0}), 0) << "P07.00: a password";
  EXPECT_EQ(answer({0x02, 0, 0x0D, 0x0F, 1, 0, 0, 0}), 9);
  EXPECT_EQ(answer({0x02, 0, 0x00, 0x07, 0x35, 0x12, 0, 0}), 5);
  EXPECT_EQ(answer({0x02, 0, 0x00, 0x07, 0x34, 0x12, 0, 0}), 0);
  EXPECT_EQ(answer({0x02, 0, 0x0D, 0x0F, 1, 0, 0, 0}), 0);
}

TEST(AstraadaDrv28, RunsUpToItsSetFrequency) {
  FamilyDevice device = drv28();
  device.write({0x1801, 2}, 1, 1);
  device.start();
  device.words(0x305, {2, 1000, 0, 0});  // reverse, 10.00 Hz; 25 Hz a second

  device.at(1000);
  device.sync();

  EXPECT_EQ(device.of(0x285)[0], make_frame(CobId::base(0x285), {0x02, 0, 0xE8, 0x03, 0, 0, 0, 0}));
}

TEST(AstraadaDrv28, StopsTurnsAndResetsAFaultByItsCommands) {
  constexpr ObjectKey state{0x2001, 1};
  constexpr ObjectKey frequency{0x2001, 2};
  FamilyDevice device = drv28();
  device.start();
  EXPECT_EQ(device.word(state), 3);
  device.words(0x305, {1, 1000, 0, 0});
  device.at(1000);
  EXPECT_EQ(device.word(state), 1);
  device.words(0x305, {5, 1000, 0, 0});
  device.at(1200);
  EXPECT_EQ(device.word(frequency), 500) << "along the ramp of 25 Hz a second";
  device.words(0x305, {2, 1000, 0, 0});
  device.at(1500);
  EXPECT_EQ(device.word(state), 2);
  EXPECT_EQ(device.word(frequency), 250) << "without a sign";

  device.fail(0x2310);
  EXPECT_EQ(device.word(state), 4);
  EXPECT_EQ(device.word(frequency), 0);
  device.words(0x305, {1, 1000, 0, 0});
  EXPECT_EQ(device.word(state), 4);
  device.words(0x305, {7, 0, 0, 0});
  EXPECT_EQ(device.word(state), 3);
}

}  // namespace
}  // namespace takt::sim
