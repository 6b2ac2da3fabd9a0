#pragma once
#include <array>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "master/core/sdo/sdo_client.hpp"
#include "test/unit/master/core/script.hpp"

namespace takt {

/// One client of node 5 and a conversation with literal frames.
class SdoClientTest : public testing::Test {
 protected:
  void upload(ObjectKey object) { client.upload(object, buffer, 500ms); }
  void download(ObjectKey object, std::vector<std::byte> value) {
    value_ = std::move(value);
    client.download(object, value_, 500ms);
  }
  void sends(const Frame& expected) {
    Outbox out;
    client.on_time(now, out);
    ASSERT_EQ(out.frames().size(), 1U);
    EXPECT_EQ(out.frames()[0], expected);
  }
  void sends_nothing() {
    Outbox out;
    client.on_time(now, out);
    EXPECT_TRUE(out.empty());
  }
  void hears(const Frame& frame) { client.on_frame(frame, now); }
  std::string text(const SdoResult& result) {
    return {reinterpret_cast<const char*>(buffer.data()), result.size};
  }

  Time now = 1s;
  std::array<std::byte, 64> buffer{};
  std::vector<std::byte> value_;
  SdoClient client{5_node};
};

}  // namespace takt
