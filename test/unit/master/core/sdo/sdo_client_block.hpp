#pragma once
#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <vector>

#include "master/core/sdo/sdo_client.hpp"
#include "test/unit/master/core/script.hpp"

namespace takt {

inline Frame segment(std::uint8_t first, std::initializer_list<std::uint8_t> data) {
  Frame frame = rx({first});
  std::ranges::copy(data, frame.data.begin() + 1);
  return frame;
}

/// Block transfers of a complete client, which chooses block transfer by itself.
class SdoClientBlock : public testing::Test {
 protected:
  void download(std::size_t size) {
    value_.assign(size, std::byte{0x55});
    client.download({0x1F50, 1}, value_, 500ms);
  }
  void sends(const Frame& expected) {
    Outbox out;
    client.on_time(now, out);
    ASSERT_EQ(out.frames().size(), 1U);
    EXPECT_EQ(out.frames()[0], expected);
    answer = out.answers()[0];
  }
  void sends_some(int frames) {
    Outbox out;
    for (int i = 0; i < frames; ++i) client.on_time(now, out);
    ASSERT_EQ(out.frames().size(), static_cast<std::size_t>(frames));
  }
  void sends_nothing() {
    Outbox out;
    client.on_time(now, out);
    EXPECT_TRUE(out.empty());
  }
  void hears(const Frame& frame) { client.on_frame(frame, now); }

  Time now = 1s;
  Answer answer = Answer::by_server;
  std::array<std::byte, 256> buffer{};
  std::vector<std::byte> value_;
  SdoClient client{5_node};
};

}  // namespace takt
