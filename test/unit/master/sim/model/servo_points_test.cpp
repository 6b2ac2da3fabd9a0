#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "test/unit/master/sim/model/servo_drive.hpp"

namespace takt::sim {
namespace {

// One point each 2 ms: the period of 0x60C2 is that of SYNC.

class Points : public Drive {
 protected:
  static SampleDevice device() {
    using enum DataType;
    SampleDevice device = servo_drive(5_node);
    device.object(0x60C1, 1, integer32, Access::rw, 0)
        .object(0x60C2, 1, unsigned8, Access::rw, 2)
        .object(0x60C2, 2, integer8, Access::rw, 0xFD)
        .object(0x60C4, 1, unsigned32, Access::ro, 32)
        .object(0x60C4, 2, unsigned32, Access::rw, 8)
        .object(0x60C4, 4, unsigned16, Access::rw, 0)
        .object(0x60C4, 6, unsigned8, Access::wo, 1);
    return device;
  }
  static const MechanicsTable* mechanics() {
    static const MechanicsTable table = servo_mechanics();
    return &table;
  }
  Points() : Drive{device(), mechanics()} {
    set(0x6502, 0x3ED);
    send(0);
    enable(7);
  }

  void send(std::int64_t point) {
    now_ += 2ms;
    drive_.advance(now_);
    set(0x60C1, point, 1);
    drive_.outputs(now_);
    drive_.on_sync(now_);
  }
  /// Sends points that are `speed` counts/s apart.
  void send_many(int points, double speed) {
    for (int i = 0; i < points; ++i) send(std::llround(speed * 0.002 * ++sent_));
  }
  bool active() { return (get(0x6041) & 0x1000) != 0; }
  std::int64_t fill() { return store_.number({0x60C4, 4}); }

  int sent_ = 0;
};

TEST_F(Points, AreKeptUntilTheModeIsActive) {
  send_many(4, 20'000);
  EXPECT_EQ(fill(), 4);
  EXPECT_EQ(get(0x6064), 0);
  EXPECT_FALSE(active());

  command(0x001F);
  EXPECT_TRUE(active());
  send_many(100, 20'000);
  EXPECT_NEAR(static_cast<double>(fill()), 4, 1) << "one comes as one is used";
  EXPECT_NEAR(static_cast<double>(get(0x606C)), 20'000, 300);
}

TEST_F(Points, WithoutSyncAreTakenWhenTheyChange) {
  run(200ms);
  for (const int point : {10, 20, 20, 30}) {
    set(0x60C1, point, 1);
    drive_.outputs(now_);
  }

  EXPECT_EQ(fill(), 3);
}

TEST_F(Points, BeyondTheBufferAreLost) {
  send_many(12, 20'000);

  EXPECT_EQ(fill(), 8);
}

TEST_F(Points, LateByLessThanTheBufferDoNoHarm) {
  send_many(4, 20'000);
  command(0x001F);
  send_many(50, 20'000);
  std::int64_t slowest = 1'000'000;
  for (int i = 0; i < 3; ++i) {
    run(2ms);
    slowest = std::min(slowest, get(0x606C));
  }
  send_many(50, 20'000);

  EXPECT_GT(slowest, 19'500);
  EXPECT_TRUE(active());
}

TEST_F(Points, ThatEndInMotionStopTheAxisUntilItIsActivatedAgain) {
  send_many(4, 20'000);
  command(0x001F);
  send_many(50, 20'000);

  run(500ms);
  EXPECT_FALSE(active());
  EXPECT_EQ(get(0x606C), 0);
  const std::int64_t stopped = get(0x6064);
  send_many(4, 20'000);
  EXPECT_EQ(get(0x6064), stopped);

  command(0x000F);
  command(0x001F);
  send_many(4, 20'000);
  EXPECT_TRUE(active());
}

TEST_F(Points, EndAtRestIfTheLastOnesAreEqual) {
  send_many(4, 20'000);
  command(0x001F);
  send_many(50, 20'000);
  const std::int64_t last = std::llround(20'000 * 0.002 * sent_);
  for (int i = 0; i < 3; ++i) send(last);

  run(1s);
  EXPECT_TRUE(active());
  EXPECT_NEAR(static_cast<double>(get(0x6064)), static_cast<double>(last), 1);
}

TEST_F(Points, AreForgottenWhenTheBufferIsCleared) {
  send_many(4, 20'000);
  set(0x60C4, 0, 6);
  send_many(1, 20'000);
  EXPECT_EQ(fill(), 0);

  set(0x60C4, 1, 6);
  send_many(1, 20'000);
  EXPECT_EQ(fill(), 1);
}

TEST_F(Points, StopWithBit4) {
  send_many(4, 20'000);
  command(0x001F);
  send_many(50, 20'000);
  command(0x000F);
  EXPECT_FALSE(active());

  run(500ms);
  EXPECT_EQ(get(0x606C), 0);
}

}  // namespace
}  // namespace takt::sim
