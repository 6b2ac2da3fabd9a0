#include "apps/takt/smooth/pdo_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "apps/takt/smooth/make_record.hpp"
#include "apps/takt/smooth/trace.hpp"

namespace takt::smooth {
namespace {

using testing::HasSubstr;

std::string trouble(const std::string& pdo) {
  PdoMap map;
  const auto added = add_pdo(map, pdo);
  return added ? "" : added.error();
}

Trace read(const std::string& text) {
  std::istringstream in{text};
  return read_trace(in, "trace.log", "");
}

TEST(PdoMap, TakesAPdoOfTheCommandLine) {
  PdoMap map;

  ASSERT_TRUE(add_pdo(map, "0x305=6040,607A,2000:01/16"));

  const MapPdo& pdo = map.pdos.at(CobId::base(0x305));
  EXPECT_EQ(pdo.node, 5);
  EXPECT_TRUE(pdo.is_rpdo);
  ASSERT_EQ(pdo.fields.size(), 3U);
  EXPECT_EQ(pdo.fields[1].offset, 16U);
  EXPECT_EQ(pdo.fields[2].offset, 48U);
  EXPECT_EQ(pdo.fields[2].bits, 16U);
}

TEST(PdoMap, SaysWhatIsWrongWithAPdo) {
  EXPECT_THAT(trouble("0x205"), HasSubstr("0x205=6040,607A"));
  EXPECT_THAT(trouble("0x805=6040"), HasSubstr("COB-ID"));
  EXPECT_THAT(trouble("0x205=604g"), HasSubstr("'604g' is no object"));
  EXPECT_THAT(trouble("0x205=2000"), HasSubstr("needs its width"));
  EXPECT_THAT(trouble("0x205=607A,607A,6040"), HasSubstr("at most 64"));
  EXPECT_THAT(trouble("0x205="), HasSubstr("is no object"));
}

TEST(PdoMap, LearnsPdosAndSettingsFromTheBoot) {
  const Trace trace = read(
      "(1.000) can0 705#00\n"
      "(1.001) can0 605#2F00160000000000\n(1.002) can0 585#6000160000000000\n"
      "(1.003) can0 605#2300160120007A60\n(1.004) can0 585#6000160100000000\n"
      "(1.005) can0 605#2F00160001000000\n(1.006) can0 585#6000160000000000\n"
      "(1.007) can0 605#2F001402FF000000\n(1.008) can0 585#6000140200000000\n"
      "(1.009) can0 605#2FC2600119000000\n(1.010) can0 585#60C2600100000000\n"
      "(1.011) can0 605#2FC26002FC000000\n(1.012) can0 585#60C2600200000000\n"
      "(1.013) can0 000#0105\n"
      "(1.014) can0 605#2F60600008000000\n(1.015) can0 585#6060600000000000\n"
      "(1.016) can0 205#FEFFFFFF\n");
  PdoMap map;

  add_learned(map, trace.bus, {});
  const BusRecord record = make_record(trace, map);

  ASSERT_EQ(record.axes.size(), 1U);
  const AxisRecord& axis = record.axes[0];
  EXPECT_EQ(axis.name, "node 5");
  EXPECT_EQ(axis.settings.transmission, 255U);
  EXPECT_EQ(axis.settings.interpolation, std::chrono::microseconds{2500});
  EXPECT_EQ(axis.settings.mode, 8);
  EXPECT_TRUE(axis.settings.boot_seen);
  ASSERT_EQ(axis.set_points.size(), 1U);
  EXPECT_EQ(axis.set_points[0].value, -2);
}

TEST(PdoMap, FindsTheAxesOfADriveWithSeveral) {
  PdoMap map;
  ASSERT_TRUE(add_pdo(map, "0x203=607A,687A"));

  const auto axes = axes_of(map);

  ASSERT_EQ(axes.size(), 2U);
  EXPECT_EQ(axes[1].axis, 1U);
  EXPECT_EQ(axes[1].name, "node 3 axis 2");
}

TEST(MakeRecord, ChoosesTheSetPointOfTheModeThatIsUsed) {
  PdoMap map;
  ASSERT_TRUE(add_pdo(map, "0x203=607A,60FF"));
  ASSERT_TRUE(add_pdo(map, "0x183=6041,6061"));
  const Trace trace =
      read("(1.000) can0 183#370609\n(1.001) can0 203#0100000002000000\n(1.002) can0 183#370609\n");

  const BusRecord record = make_record(trace, map);

  ASSERT_EQ(record.axes.size(), 1U);
  EXPECT_TRUE(record.axes[0].by_velocity);
  ASSERT_EQ(record.axes[0].set_points.size(), 1U);
  EXPECT_EQ(record.axes[0].set_points[0].value, 2);
}

TEST(Trace, KeepsTheOrderOfFramesWithOneTimeStamp) {
  const Trace trace = read("(1.000) can0 080#\n(1.000) can0 205#0F00\n(0.999) can0 080#\n");

  ASSERT_EQ(trace.frames.size(), 3U);
  EXPECT_LT(trace.frames[0].when, trace.frames[1].when);
  EXPECT_LT(trace.frames[1].when, trace.frames[2].when);
}

TEST(Trace, KnowsTheResolutionOfItsTimeStamps) {
  EXPECT_EQ(read("(1.000) can0 080#\n(1.002) can0 080#\n").resolution,
            std::chrono::milliseconds{1});
  EXPECT_EQ(read("(1.0) can0 080#\n(1.00213) can0 080#\n").resolution,
            std::chrono::microseconds{10});
  EXPECT_FALSE(read("can0 080#\n").with_times);
}

TEST(Trace, LeavesOutOtherInterfaces) {
  EXPECT_EQ(read("(1.0) can0 080#\n(1.1) can1 080#\n(1.2) can0 081#00\n").frames.size(), 2U);
}

}  // namespace
}  // namespace takt::smooth
