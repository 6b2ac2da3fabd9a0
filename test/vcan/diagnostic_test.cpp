#include <chrono>
#include <thread>

#include "master/linux/bus/diagnostic_socket.hpp"
#include "master/linux/can/can_link.hpp"
#include "master/linux/can/socket_can.hpp"
#include "master/linux/clock.hpp"
#include "test/support/time_limit.hpp"
#include "test/vcan/vcan_fixture.hpp"

namespace takt {
namespace {

const Frame sync_frame = make_frame(CobId::base(0x080), {});
const Frame tpdo = make_frame(CobId::base(0x185), {1, 2});

class DiagnosticOnVcan : public testing::Test {
 protected:
  DiagnosticOnVcan()
      : port_{*SocketCanPort::open("vcan0", plan_, {}, sent_.get())},
        socket_{*DiagnosticSocket::open("vcan0", plan_, *sent_)} {}

  /// Collects events until this many frames were received since the beginning of the test, error
  /// frames included. The kernel may deliver the frames later than they were sent.
  std::vector<Event> events(std::size_t frames) {
    const Time limit = monotonic_now() + test::time_limit;
    while (true) {
      socket_.poll([this](const StampedFrame& frame) { heard_.push_back(frame.frame); });
      if (heard_.size() + socket_.traffic().error_frames >= frames) break;
      if (monotonic_now() > limit) break;
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    std::vector<Event> all;
    for (Event event; socket_.take(event);) all.push_back(event);
    return all;
  }

  BusPlan plan_;
  std::unique_ptr<SentFrames> sent_ = std::make_unique<SentFrames>();
  SocketCanPort port_;
  DiagnosticSocket socket_;
  std::vector<Frame> heard_;
};

TEST_F(DiagnosticOnVcan, HearsTheBusThreadAndTheOthersAndAccusesNobody) {
  Peer peer{"vcan0"};
  for (std::size_t i = 0; i < 50; ++i) {
    port_.send({&sync_frame, 1});
    peer.send(0x185, {1, 2});
    EXPECT_TRUE(events(2 * i + 2).empty());
  }

  ASSERT_EQ(heard_.size(), 100U);
  EXPECT_EQ(heard_[0], sync_frame);
  EXPECT_EQ(heard_[1], tpdo);
  EXPECT_EQ(socket_.traffic().frames, 100U);
  EXPECT_EQ(socket_.traffic().bits, 50U * (47 + 1) + 50U * (63 + 1));
}

TEST_F(DiagnosticOnVcan, ReportsAnotherProgramThatSendsSyncOrNmt) {
  Peer other{"vcan0"};
  port_.send({&sync_frame, 1});
  EXPECT_TRUE(events(1).empty());

  other.send(0x080, {});
  other.send(0x000, {0x81, 0x00});

  const auto reported = events(3);
  ASSERT_EQ(reported.size(), 2U);
  EXPECT_EQ(reported[0].kind, EventKind::foreign_nmt);
  EXPECT_EQ(reported[0].bytes[0], 0x81);
  EXPECT_EQ(reported[1].kind, EventKind::foreign_sync);
}

TEST_F(DiagnosticOnVcan, CountsErrorFramesOfAllClasses) {
  Peer controller{"vcan0"};

  controller.send(CAN_ERR_FLAG | 0x008, {0, 0, 0x04, 0x0A, 0, 0, 0, 0});  // stuff error

  EXPECT_TRUE(events(1).empty());
  EXPECT_EQ(socket_.traffic().error_frames, 1U);
  EXPECT_EQ(socket_.traffic().frames, 0U);
}

TEST(CanLinkOnVcan, ReadsAVirtualInterface) {
  run("ip link set vcan0 txqueuelen 17");

  const auto link = read_can_link("vcan0");

  ASSERT_TRUE(link) << link.error().message;
  EXPECT_TRUE(link->is_can);
  EXPECT_TRUE(link->up);
  EXPECT_EQ(link->kind, "vcan");
  EXPECT_EQ(link->tx_queue_length, 17U);
  EXPECT_FALSE(link->bitrate);
  EXPECT_FALSE(link->state);
}

}  // namespace
}  // namespace takt
