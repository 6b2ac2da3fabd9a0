#include "master/sim/mechanics/travel_sensors.hpp"

#include <gtest/gtest.h>

namespace takt::sim {
namespace {

using enum TravelSwitch;

TravelParameters travel() {
  return {.switches = ZoneParameters{-500, 500}, .home = ZoneParameters{100, 120}};
}

TEST(TravelSensors, AreActiveInTheirZones) {
  TravelSensors sensors{travel(), 1000, 30};
  EXPECT_EQ(sensors.inputs(), 0U);

  sensors.look(-501, -501);
  EXPECT_EQ(sensors.inputs(), 1U);
  sensors.look(110, 110);
  EXPECT_EQ(sensors.inputs(), 4U);
  sensors.look(500, 500);
  EXPECT_EQ(sensors.inputs(), 2U);
  EXPECT_TRUE(sensors.has(positive_limit));
  EXPECT_FALSE(sensors.has(probe_1));
}

TEST(TravelSensors, SeeTheEdgesWhereTheLoadCrossesThem) {
  TravelSensors sensors{travel(), 1000, 30};

  sensors.look(90, 95);
  EXPECT_EQ(sensors.edge(home), EdgeKind::none);
  sensors.look(100, 105);
  EXPECT_EQ(sensors.edge(home), EdgeKind::rising);
  EXPECT_DOUBLE_EQ(sensors.edge_at(home), 95) << "the position of the motor";
  sensors.look(96, 99);
  EXPECT_EQ(sensors.edge(home), EdgeKind::falling);
  sensors.look(140, 140);
  EXPECT_EQ(sensors.edge(home), EdgeKind::falling) << "passed as a whole";
  sensors.look(110, 110);
  EXPECT_EQ(sensors.edge(home), EdgeKind::rising);
  EXPECT_NEAR(sensors.edge_at(home), 120, 1e-9);
  sensors.look(111, 111);
  EXPECT_EQ(sensors.edge(home), EdgeKind::none) << "an edge is seen once";
  sensors.look(99, 99);
  EXPECT_EQ(sensors.edge(home), EdgeKind::falling) << "the edge below";
  EXPECT_FALSE(sensors.active(home));
}

TEST(TravelSensors, SeeTheIndexPulseOnceInATurn) {
  TravelSensors sensors{travel(), 1000, 30};

  sensors.look(29, 29);
  EXPECT_FALSE(sensors.index());
  sensors.look(31, 31);
  EXPECT_EQ(sensors.index(), 30);
  sensors.look(40, 40);
  EXPECT_FALSE(sensors.index());
  sensors.look(-980, -980);
  EXPECT_EQ(sensors.index(), 30);
  sensors.look(1020, 1020);
  EXPECT_EQ(sensors.index(), -970) << "the first of several";
}

}  // namespace
}  // namespace takt::sim
