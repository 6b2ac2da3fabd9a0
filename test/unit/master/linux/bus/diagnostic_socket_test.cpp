#include "master/linux/bus/diagnostic_socket.hpp"

#include <filesystem>
#include <gtest/gtest.h>
#include <poll.h>
#include <vector>

#include "master/linux/unix_bus/unix_bus.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

const Frame sync_frame = make_frame(CobId::base(0x080), {});
const Frame start_all = make_frame(CobId::base(0x000), {0x01, 0x00});

class DiagnosticSocketOnUnixBus : public testing::Test {
 protected:
  void poll(DiagnosticSocket& socket) {
    pollfd wanted{.fd = socket.fd(), .events = POLLIN, .revents = 0};
    ::poll(&wanted, 1, 10);
    socket.poll([this](const StampedFrame& frame) { heard_.push_back(frame.frame); });
  }

  const test::Folder folder_;
  const std::string path_ = folder_ / "bus";
  std::vector<Frame> heard_;
  std::unique_ptr<SentFrames> sent_ = std::make_unique<SentFrames>();
};

TEST_F(DiagnosticSocketOnUnixBus, HearsTheBusThreadAndReportsItFromAStranger) {
  auto port = UnixBusPort::open({.path = path_, .sent = sent_.get()});
  ASSERT_TRUE(port);
  auto socket = DiagnosticSocket::open("unix:" + path_, BusPlan{}, *sent_);
  ASSERT_TRUE(socket) << socket.error().message;
  auto stranger = UnixBusPort::open({.path = path_});
  ASSERT_TRUE(stranger);
  for (int i = 0; i < 1000 && heard_.size() < 100; ++i) {
    port->send({&sync_frame, 1});
    poll(*socket);
  }
  Event event;
  EXPECT_FALSE(socket->take(event));

  stranger->send({&start_all, 1});
  for (int i = 0; i < 1000 && (heard_.empty() || heard_.back() != start_all); ++i) poll(*socket);
  poll(*socket);

  ASSERT_TRUE(socket->take(event));
  EXPECT_EQ(event.kind, EventKind::foreign_nmt);
  EXPECT_FALSE(socket->take(event));
  EXPECT_EQ(socket->traffic().frames, heard_.size());
}

}  // namespace
}  // namespace takt
