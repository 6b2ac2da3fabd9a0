// The expected times follow the 8400 HighLine reference manual, 11.8.3: transmission type.
#include <gtest/gtest.h>

#include "test/unit/master/sim/family/family_device.hpp"

namespace takt::sim {
namespace {

using Times = std::vector<int>;

FamilyDevice lenze(const std::string& firmware = "") {
  return {"lenze8400.eds", "lenze8400", {.firmware = firmware}};
}

TEST(Lenze8400, Type0IsSentAfterSyncAndOnlyAfterAnEvent) {
  FamilyDevice device = lenze();
  device.write({0x1800, 2}, 0, 1);
  device.start();
  device.at(5);
  device.sync();  // the drive sends its state once
  device.clear();

  device.at(10);
  device.sync();
  device.at(12);
  device.words(0x205, {0, 0, 1, 0});
  device.at(20);
  device.sync();
  device.at(30);
  device.sync();
  device.at(31);
  device.words(0x205, {0, 0, 2, 0});
  device.at(32);
  device.words(0x205, {0, 0, 1, 0});  // back again; a bit has still changed
  device.at(40);
  device.sync();

  EXPECT_EQ(device.times(0x185), (Times{20, 40}));
}

TEST(Lenze8400, AnElapsedCycleTimeIsAnEventOfType0) {
  FamilyDevice device = lenze();
  device.write({0x1800, 2}, 0, 1);
  device.write({0x1800, 5}, 25, 2);
  device.start();

  for (int ms = 10; ms <= 100; ms += 10) {
    device.at(ms);
    device.sync();
  }

  EXPECT_EQ(device.times(0x185), (Times{10, 30, 50, 80, 100}));  // expiry at 25, 50, 75, 100
}

TEST(Lenze8400, Types254And255MeanTheSameAndTheCycleComesOnTop) {
  for (const std::uint32_t type : {254u, 255u}) {
    FamilyDevice device = lenze();
    device.write({0x1800, 2}, type, 1);
    device.write({0x1800, 5}, 50, 2);
    device.start();

    device.at(20);
    device.words(0x205, {0, 0, 1, 0});
    device.at(120);

    EXPECT_EQ(device.times(0x185), (Times{0, 20, 50, 100})) << type;
  }
}

TEST(Lenze8400, TypeNIsSentWithEachNthSync) {
  FamilyDevice device = lenze();
  device.write({0x1800, 2}, 1, 1);
  device.write({0x1801, 2}, 4, 1);
  device.start();

  for (int ms = 10; ms <= 80; ms += 10) {
    device.at(ms);
    device.sync();
  }

  EXPECT_EQ(device.times(0x185), (Times{10, 20, 30, 40, 50, 60, 70, 80}));
  EXPECT_EQ(device.times(0x285), (Times{40, 80}));
}

TEST(Lenze8400, IsPolledByRtr) {
  FamilyDevice device = lenze();
  EXPECT_EQ(device.write({0x1800, 2}, 252, 1), 0u);
  EXPECT_EQ(device.write({0x1801, 2}, 253, 1), 0u);
  device.start();

  device.at(5);
  device.request(0x185);  // nothing was sampled yet
  device.request(0x285);
  device.at(10);
  device.sync();
  device.at(12);
  device.words(0x205, {0, 0, 9, 0});
  device.at(15);
  device.request(0x185);

  EXPECT_EQ(device.times(0x285), (Times{5}));
  EXPECT_EQ(device.times(0x185), (Times{15}));
  EXPECT_EQ(device.of(0x185)[0].data[4], 0) << "the sample of the SYNC";
}

TEST(Lenze8400, RefusesReservedTypesAnd29BitIdentifiers) {
  FamilyDevice device = lenze();

  for (std::uint32_t type = 241; type <= 251; ++type) {
    EXPECT_EQ(device.write({0x1800, 2}, type, 1), 0x06090030u) << type;
    EXPECT_EQ(device.write({0x1400, 2}, type, 1), 0x06090030u) << type;
  }
  EXPECT_EQ(device.write({0x1800, 1}, 0xA0012345, 4), 0x06090030u);
  EXPECT_EQ(device.read({0x1800, 4}), 0x06090011u);
}

/// A drive with a TPDO of type 1 that produces SYNC every 20 ms.
FamilyDevice producer(const std::string& firmware) {
  FamilyDevice device = lenze(firmware);
  device.write({0x1800, 2}, 1, 1);
  EXPECT_EQ(device.write({0x1006, 0}, 20'000, 4), 0u);
  EXPECT_EQ(device.write({0x1005, 0}, 0x40000080, 4), 0u);
  return device;
}

TEST(Lenze8400, ObeysTheSyncThatItMakesFromFirmware16On) {
  FamilyDevice device = producer("16.00.00");
  device.start();
  device.at(100);

  EXPECT_EQ(device.times(0x080).size(), 5u);
  EXPECT_EQ(device.times(0x185), device.times(0x080));
}

TEST(Lenze8400, DoesNotObeyItsOwnSyncBeforeFirmware16) {
  FamilyDevice device = producer("15.02");
  device.start();
  device.at(100);

  EXPECT_EQ(device.times(0x080).size(), 5u);
  EXPECT_EQ(device.times(0x185), Times{});
}

/// Returns the low byte that the drive echoes at 100 ms after an RPDO1 of type 1 at 30 ms.
std::uint8_t echoed_by(FamilyDevice device) {
  device.write({0x1400, 2}, 1, 1);
  device.start();
  device.at(30);
  device.words(0x205, {0, 0, 7, 0});
  device.at(100);
  return static_cast<std::uint8_t>(device.device().objects().find({0x5C9B, 3})->value);
}

TEST(Lenze8400, TakesOverRpdosAtTheSyncThatItMakesFromFirmware16On) {
  EXPECT_EQ(echoed_by(producer("16.00.00")), 7);
  EXPECT_EQ(echoed_by(producer("15.02")), 0);
}

TEST(Lenze8400, DoesNotObeyItsOwnSyncOnAnotherIdentifier) {
  FamilyDevice device = producer("16.00.00");
  EXPECT_EQ(device.write({0x5E8F, 0}, 0x090, 2), 0u);  // C00368
  device.start();
  device.at(100);

  EXPECT_EQ(device.times(0x090).size(), 5u);
  EXPECT_EQ(device.times(0x185), Times{});
  device.sync();
  EXPECT_EQ(device.times(0x185), (Times{100})) << "one from elsewhere";
}

/// Section 11.9.1: identifier = basic identifier + node address, 0x640 to the device, 0x5C0 from
/// it.
TEST(Lenze8400, AnswersOnItsSecondParameterChannelToo) {
  FamilyDevice device = lenze();
  device.start();

  device.receive(make_frame(CobId::base(0x645), {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}));
  device.at(5);

  ASSERT_EQ(device.of(0x5C5).size(), 1u);
  EXPECT_EQ(device.of(0x5C5)[0],
            make_frame(CobId::base(0x5C5), {0x43, 0x18, 0x10, 0x01, 0x3B, 0, 0, 0}));
  EXPECT_TRUE(device.of(0x585).empty());
}

/// The manual on 0x1201: disable the channel with bit 31 first, then write another identifier; bits
/// 11 to 29 are 0.
TEST(Lenze8400, MovesItsSecondChannelOnlyWhileThatIsOff) {
  FamilyDevice device = lenze();

  EXPECT_EQ(device.write({0x1201, 1}, 0x6A5, 4), 0x0609'0030U);
  EXPECT_EQ(device.write({0x1201, 1}, 0xA000'0645, 4), 0x0609'0030U) << "29 bits";
  EXPECT_EQ(device.write({0x1201, 1}, 0x8000'1645, 4), 0x0609'0030U);
  EXPECT_EQ(device.write({0x1201, 1}, 0x8000'0645, 4), 0U);
  EXPECT_EQ(device.write({0x1201, 2}, 0x6C5, 4), 0U) << "the server is off";
  EXPECT_EQ(device.write({0x1201, 1}, 0x6A5, 4), 0U);

  device.start();
  device.receive(make_frame(CobId::base(0x645), {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}));
  device.receive(make_frame(CobId::base(0x6A5), {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}));
  device.at(5);
  EXPECT_TRUE(device.of(0x5C5).empty());
  EXPECT_EQ(device.of(0x6C5).size(), 1u);
}

constexpr ObjectKey status{0x5C9B, 1};
constexpr ObjectKey speed{0x5C9B, 2};

/// Returns the device state in the status word: 3 ready to switch on, 4 switched on, 5 operation, 8
/// fault.
int state_of(FamilyDevice& device) { return device.word(status) >> 8 & 0x0F; }

TEST(Lenze8400, FollowsItsControlWordAndItsRamp) {
  FamilyDevice device = lenze();
  device.start();
  EXPECT_EQ(state_of(device), 3);
  device.words(0x205, {0x0001, 8192, 0, 0});
  EXPECT_EQ(state_of(device), 4);
  EXPECT_EQ(device.word(speed), 0);

  device.words(0x205, {0x0009, 8192, 0, 0});
  EXPECT_EQ(state_of(device), 5);
  device.at(250);
  EXPECT_EQ(device.word(speed), 4096) << "one second to 16384";
  EXPECT_EQ(device.word(status) & 0x0050, 0);
  device.at(600);
  EXPECT_EQ(device.word(speed), 8192);
  EXPECT_EQ(device.word(status) & 0x0050, 0x0010) << "at its speed";

  device.words(0x205, {0x0109, 8192, 0, 0});  // halt
  device.at(1200);
  EXPECT_EQ(device.word(speed), 0);
  EXPECT_EQ(state_of(device), 5);
  EXPECT_EQ(device.word(status) & 0x0040, 0x0040) << "it stands";

  device.words(0x205, {0x0009, 0xE000, 0, 0});  // -8192
  device.at(1450);
  EXPECT_EQ(device.word(speed), -4096);
  device.words(0x205, {0x000D, 0xE000, 0, 0});  // quick stop
  device.at(2000);
  EXPECT_EQ(device.word(speed), 0);
}

TEST(Lenze8400, ResetsAFaultByTheEdgeOfBit7) {
  FamilyDevice device = lenze();
  device.start();
  device.words(0x205, {0x0089, 8192, 0, 0});
  device.at(500);
  device.fail(0x1000);
  EXPECT_EQ(state_of(device), 8);
  device.at(600);
  device.words(0x205, {0x0089, 8192, 0, 0});
  EXPECT_EQ(state_of(device), 8) << "bit 7 was there before";
  device.words(0x205, {0x0000, 0, 0, 0});
  device.words(0x205, {0x0080, 0, 0, 0});
  EXPECT_EQ(state_of(device), 3);
}

}  // namespace
}  // namespace takt::sim
