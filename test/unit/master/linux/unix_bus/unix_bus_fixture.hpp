#pragma once
#include <array>
#include <chrono>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "master/linux/unix_bus/unix_bus.hpp"
#include "test/support/folder.hpp"
#include "test/support/time_limit.hpp"

namespace takt::test {

inline constexpr Time limit = time_limit;  // for another thread; never reached

inline const Frame sync_frame = make_frame(CobId::base(0x080), {0x01});
inline const Frame tpdo = make_frame(CobId::base(0x185), {1, 2, 3, 4, 5, 6, 7, 8});

class UnixBus : public testing::Test {
 protected:
  UnixBusPort port() {
    auto opened = UnixBusPort::open({.path = path_, .sync_cob_id = CobId::base(0x080)});
    EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
    return std::move(*opened);
  }

  const Folder folder_;
  const std::string path_ = folder_ / "bus";
};

/// Receives until `wanted` frames are there.
inline std::vector<StampedFrame> receive_all(UnixBusPort& port, std::size_t wanted) {
  std::vector<StampedFrame> all;
  const Time until = port.now() + limit;
  while (all.size() < wanted && port.now() < until) {
    std::array<StampedFrame, 300> some;
    port.wait_frame(until);
    const std::size_t count = port.receive(some);
    all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return all;
}

template <class Condition>
bool soon(UnixBusPort& port, Condition condition) {
  const Time until = port.now() + limit;
  std::array<StampedFrame, 8> some;
  bool met = condition();  // called only as often as needed, because it may send
  while (!met && port.now() < until) {
    port.wait_frame(port.now() + std::chrono::milliseconds{5});
    port.receive(some);
    met = condition();
  }
  return met;
}

/// Waits until all members are connected: each has received a frame of the other.
inline void make_acquainted(UnixBusPort& a, UnixBusPort& b) {
  const Time until = a.now() + limit;
  std::array<StampedFrame, 8> some;
  bool a_heard = false;
  bool b_heard = false;
  while (!(a_heard && b_heard) && a.now() < until) {
    a.send({&tpdo, 1});
    b.send({&tpdo, 1});
    b.wait_frame(b.now() + std::chrono::milliseconds{5});
    a_heard |= a.receive(some) > 0;
    b_heard |= b.receive(some) > 0;
  }
  ASSERT_TRUE(a_heard && b_heard);
  // Discard the frames in transit; a marker frame of each member ends them.
  const Frame marker = make_frame(CobId::base(0x7FF), {});
  a.send({&marker, 1});
  b.send({&marker, 1});
  const auto drain = [&](UnixBusPort& port) {
    for (;;) {
      const auto got = receive_all(port, 1);
      if (got.empty() || got.back().frame.id == marker.id) return;
    }
  };
  drain(a);
  drain(b);
}

}  // namespace takt::test
