#pragma once
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "master/linux/file_descriptor.hpp"
#include "test/support/time_limit.hpp"

namespace takt {

/// Runs a command of the shell. If the command fails, the test fails.
inline void run(const std::string& command) {
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// A plain CAN_RAW socket that stands for the rest of the bus. It uses no code under test.
class Peer {
 public:
  explicit Peer(const char* interface)
      : socket_{::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)} {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex(interface));
    EXPECT_EQ(bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0)
        << interface << ": " << std::strerror(errno);
    const timeval limit{.tv_sec = test::time_limit.count(), .tv_usec = 0};
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  }

  void send(canid_t id, std::initializer_list<std::uint8_t> bytes) {
    can_frame frame{};
    frame.can_id = id;
    frame.can_dlc = static_cast<std::uint8_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), frame.data);
    EXPECT_EQ(::send(socket_.get(), &frame, sizeof frame, 0), static_cast<ssize_t>(sizeof frame))
        << std::strerror(errno);
  }

  void send_fd(canid_t id) {
    const int on = 1;
    setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
    canfd_frame frame{};
    frame.can_id = id;
    frame.len = 64;
    EXPECT_EQ(::send(socket_.get(), &frame, sizeof frame, 0), static_cast<ssize_t>(sizeof frame))
        << std::strerror(errno);
  }

  can_frame receive() {
    can_frame frame{};
    EXPECT_EQ(recv(socket_.get(), &frame, sizeof frame, 0), static_cast<ssize_t>(sizeof frame));
    return frame;
  }

 private:
  FileDescriptor socket_;
};

}  // namespace takt
