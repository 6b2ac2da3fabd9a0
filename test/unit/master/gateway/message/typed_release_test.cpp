#include <cstddef>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "eds_parser/lcm/typed_message.hpp"
#include "master/gateway/bridge.hpp"
#include "test/unit/master/gateway/rig_clocks.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

class TwoChannels final : public Transport {
 public:
  bool publish(const std::string&, std::span<const std::byte> data) override {
    if (const auto image = decode<image_t>(data)) cycle = image->cycle;
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler& handler) override {
    for (const auto& [channel, bytes] : std::exchange(waiting, {})) handler(channel, bytes);
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  std::int64_t cycle = 0;
  std::vector<std::pair<std::string, std::vector<std::byte>>> waiting;
};

/// A message in the encoding of LCM: big endian, texts with their length and a final 0.
class Encoded {
 public:
  void put(std::uint64_t value, int bytes) {
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
      bytes_.push_back(static_cast<std::byte>(value >> shift));
    }
  }
  void put(const std::string& text) {
    put(text.size() + 1, 4);
    for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
    bytes_.push_back(std::byte{0});
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

int bytes_of(LcmPrimitive type) {
  switch (type) {
    case LcmPrimitive::boolean:
    case LcmPrimitive::int8:
      return 1;
    case LcmPrimitive::int16:
      return 2;
    case LcmPrimitive::int32:
    case LcmPrimitive::float32:
      return 4;
    case LcmPrimitive::int64:
    case LcmPrimitive::float64:
    case LcmPrimitive::string:
      return 8;
  }
  return 0;
}

class TypedRelease : public testing::Test {
 protected:
  enum class Release : std::uint8_t { no, yes };

  TypedRelease() {
    EXPECT_TRUE(rig.boot());
    for (int i = 0; i < 5; ++i) cycle();
    for (TypedMessage& message : typed_messages(rig.master->plan())) {
      if (message.command) types.push_back(std::move(message));
    }
  }

  void cycle() {
    rig.master->cycle();
    bridge.serve();
  }
  void send(std::size_t node, Release release) {
    Encoded message;
    message.put(types.at(node).fingerprint(), 8);
    message.put(0, 8);  // utime
    message.put(7, 8);  // session
    message.put(1, 8);  // instance
    message.put("app");
    message.put(static_cast<std::uint64_t>(lcm.cycle), 8);
    message.put(0, 4);  // time to live
    message.put(release == Release::yes ? 1 : 0, 1);
    for (const TypedField& field : types.at(node).fields) {
      if (field.signal) message.put(0, bytes_of(field.type));
    }
    lcm.waiting.emplace_back(types.at(node).channel, message.bytes());
  }

  test::Rig rig{test::axes({.nodes = 2, .period = 4ms, .fallback_cycles = 50})};
  test::RigClocks clocks{rig};
  TwoChannels lcm;
  std::vector<TypedMessage> types;
  std::vector<std::string> reported;
  Bridge bridge{*rig.master,
                lcm,
                clocks,
                {.session = 7, .interface = {}, .realtime = {}},
                [this](const Notice& notice) {
                  if (notice.kind == "outputs_released") reported.push_back(notice.text);
                }};
};

TEST_F(TypedRelease, ReachesTheNodeOfItsChannelOnly) {
  send(0, Release::no);
  send(1, Release::no);
  cycle();
  ASSERT_EQ(bridge.commands_taken(), 2U);

  send(1, Release::yes);
  cycle();

  EXPECT_EQ(reported, std::vector<std::string>{"'app' has released the outputs of axis2"});
  send(0, Release::yes);
  cycle();
  ASSERT_EQ(reported.size(), 2U) << "the first node was held until now";
  EXPECT_EQ(reported[1], "'app' has released the outputs of axis1");
}

}  // namespace
}  // namespace takt
