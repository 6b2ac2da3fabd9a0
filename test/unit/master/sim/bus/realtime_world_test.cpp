#include "master/sim/bus/realtime_world.hpp"

#include <condition_variable>
#include <deque>
#include <gtest/gtest.h>
#include <mutex>

#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

/// Two queues between the test and the devices.
class QueueChannel final : public FrameChannel {
 public:
  bool send(const Frame& frame) noexcept override {
    const std::lock_guard lock{mutex_};
    from_devices_.push_back(frame);
    changed_.notify_all();
    return true;
  }
  ChannelRead receive(Frame& frame, Time timeout) noexcept override {
    std::unique_lock lock{mutex_};
    changed_.wait_for(lock, timeout, [this] { return !to_devices_.empty() || closed_; });
    if (closed_) return ChannelRead::closed;
    if (to_devices_.empty()) return ChannelRead::nothing;
    frame = to_devices_.front();
    to_devices_.pop_front();
    return ChannelRead::frame;
  }

  void put(const Frame& frame) {
    const std::lock_guard lock{mutex_};
    to_devices_.push_back(frame);
    changed_.notify_all();
  }
  /// Waits without a time limit for the next frame of a device.
  Frame take() {
    std::unique_lock lock{mutex_};
    changed_.wait(lock, [this] { return !from_devices_.empty(); });
    const Frame frame = from_devices_.front();
    from_devices_.pop_front();
    return frame;
  }
  void close() {
    const std::lock_guard lock{mutex_};
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Frame> to_devices_;
  std::deque<Frame> from_devices_;
  bool closed_ = false;
};

TEST(RealtimeWorld, CarriesFramesBothWays) {
  const DeviceTable tables[] = {communicating(5_node).build()};
  QueueChannel channel;
  RealtimeWorld world{tables, {}, channel};
  world.start();

  EXPECT_EQ(channel.take(), make_frame(CobId::base(0x705), {0x00}));
  channel.put(make_frame(CobId::base(0x605), {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}));
  EXPECT_EQ(channel.take(),
            make_frame(CobId::base(0x585), {0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0, 0}));

  world.stop();
  EXPECT_FALSE(world.failed());
}

TEST(RealtimeWorld, EndsWhenItsChannelIsClosed) {
  const DeviceTable tables[] = {communicating(5_node).build()};
  QueueChannel channel;
  RealtimeWorld world{tables, {}, channel};
  world.start();
  channel.close();

  while (!world.failed()) std::this_thread::yield();
  SUCCEED();
}

TEST(RealtimeWorld, StopsWithoutHavingBeenStarted) {
  QueueChannel channel;
  RealtimeWorld world{{}, {}, channel};
  world.stop();
  EXPECT_FALSE(world.failed());
}

}  // namespace
}  // namespace takt::sim
