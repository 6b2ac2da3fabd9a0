// Objects of devices by SDO, and outputs of I/O nodes, by the library of applications with a whole
// master, its gateway and simulated devices in virtual time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <takt/motion.hpp>

#include "test/motions/link_in_virtual_time.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::LinkInVirtualTime;
using test::MotionBus;
using testing::AllOf;
using testing::HasSubstr;
using Kind = Obstacle::Kind;

template <class Result>
Obstacle obstacle_of(const Result& result) {
  return result ? Obstacle{.text = "none"} : result.error();
}

class AxesObjects : public ::testing::Test {
 protected:
  AxesObjects() {
    bus_.run(1000);  // until all nodes have booted
    bus_.clocks.offset = std::chrono::system_clock::now().time_since_epoch() - bus_.world.now();
  }
  static constexpr std::chrono::milliseconds timeout = 10s;

  Axes open() {
    auto axes = Axes::open(std::make_unique<LinkInVirtualTime>(bus_),
                           {.bus = "demo", .longest = 100s, .timeout = timeout});
    EXPECT_TRUE(axes) << axes.error().text;
    return std::move(*axes);
  }
  std::int64_t io_value(std::uint16_t index) {
    return bus_.world.device(*NodeId::from(10))->objects().number({index, 1});
  }

  test::ClockAhead clock_;
  MotionBus bus_;
};

TEST_F(AxesObjects, AreReadAndWrittenBySdo) {
  Axes axes = open();
  ASSERT_TRUE(axes.write_number<std::uint32_t>("elbow", 0x6081, 0, 54'321));
  EXPECT_EQ(axes.read_number<std::uint32_t>("elbow", 0x6081), 54'321U);
  const auto bytes = axes.read("elbow", 0x6081);
  ASSERT_TRUE(bytes) << bytes.error().text;
  EXPECT_THAT(*bytes, testing::ElementsAre(0x31, 0xD4, 0, 0));
  const Done offset = axes.write_number<std::int32_t>("elbow", 0x607C, 0, -3);
  ASSERT_TRUE(offset) << offset.error().text;
  EXPECT_EQ(axes.read_number<std::int32_t>("elbow", 0x607C), -3);
}

TEST_F(AxesObjects, TellInWordsWhyATransferFails) {
  Axes axes = open();
  const Obstacle missing = obstacle_of(axes.read("io", 0x5FFF, 2));
  EXPECT_EQ(missing.kind, Kind::blocked);
  EXPECT_THAT(missing.text, AllOf(HasSubstr("io 0x5FFF:02: the device refused the access"),
                                  HasSubstr("0x06020000")));
  EXPECT_THAT(obstacle_of(axes.read_number<std::uint8_t>("elbow", 0x6081)).text,
              HasSubstr("elbow 0x6081:00 has 4 bytes, not 1"));
  const Obstacle unknown = obstacle_of(axes.read("knee", 0x6081));
  EXPECT_EQ(unknown.kind, Kind::wrong_use);
  EXPECT_THAT(unknown.text, HasSubstr("no node 'knee'; the nodes are: elbow, io, shoulder"));
}

TEST_F(AxesObjects, AreTransferredWhileAMotionGoesOn) {
  Axes axes = open();
  ASSERT_TRUE(axes.enable());
  ASSERT_TRUE(axes.jog(Eigen::Vector2d{0.5, 0.5}));
  EXPECT_TRUE(axes.read("shoulder", 0x1008));
  EXPECT_TRUE(axes.moving());
}

TEST_F(AxesObjects, OutputsAreHeldWhileTheProgramIsAlive) {
  Axes axes = open();
  const Done done = axes.set("io.0x6200:1", 0x5A);
  ASSERT_TRUE(done) << done.error().text;
  ASSERT_TRUE(axes.set("io.outputs_9_to_16", 0));
  ASSERT_TRUE(axes.set("io.analogue_output_1", 1200));
  ASSERT_TRUE(axes.set("io.analogue_output_2", 0));
  ASSERT_TRUE(axes.run(50ms));
  EXPECT_EQ(io_value(0x6200), 0x5A);
  EXPECT_EQ(io_value(0x6411), 1200);
  EXPECT_EQ(axes.signal("io.0x6200:1"), 0x5A);
  EXPECT_EQ(axes.signal("shoulder.0x6064"), axes.positions()(0));
}

TEST_F(AxesObjects, OutputsAreGivenUpAfterASilence) {
  Axes axes = open();
  ASSERT_TRUE(axes.set("io.0x6200:1", 0x5A));
  clock_.ahead = timeout + 100ms;
  const Obstacle lost = obstacle_of(axes.run(10ms));
  EXPECT_EQ(lost.kind, Kind::stopped);
  EXPECT_THAT(lost.text, HasSubstr("its set-points were discarded"));
  EXPECT_TRUE(axes.run(10ms)) << "it is told once";
}

TEST_F(AxesObjects, OutputsThatCantBeSetAreRefusedInWords) {
  Axes axes = open();
  const auto text = [&](const std::string& name, double value) {
    return obstacle_of(axes.set(name, value)).text;
  };
  EXPECT_THAT(text("io.0x6200:1", 256), HasSubstr("io.0x6200:1 can't be 256"));
  EXPECT_THAT(text("io.0x6200:1", std::nan("")), HasSubstr("can't be nan"));
  EXPECT_THAT(text("io.lamp", 1),
              AllOf(HasSubstr("no output 'io.lamp'"), HasSubstr("this node has: ")));
  EXPECT_THAT(text("lamp", 1), HasSubstr("no node 'lamp'"));
  EXPECT_THAT(text("shoulder.0x607A", 1), HasSubstr("commands an axis"));
  EXPECT_THAT(text("io.0x6411:1", -5), HasSubstr("io"));
  EXPECT_EQ(io_value(0x6411), 0);
  EXPECT_THAT(obstacle_of(axes.signal("io.0x6000:9")).text, HasSubstr("no value 'io.0x6000:9'"));
}

}  // namespace
}  // namespace takt
