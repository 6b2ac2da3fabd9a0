#include "apps/takt/service/bus_scan.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <string>

namespace takt {
namespace {

using namespace std::chrono_literals;
using Bytes = std::array<std::uint8_t, 8>;

constexpr Bytes no_object{0x80, 0, 0, 0, 0x00, 0x00, 0x02, 0x06};

Bytes aborts(Bytes request) {
  Bytes answer = no_object;
  for (std::size_t i = 1; i < 4; ++i) answer[i] = request[i];
  return answer;
}

/// A scan in virtual time; `slave` returns the answer of a node to a request, if there is one.
struct Bus {
  std::function<std::optional<Bytes>(unsigned, const Bytes&)> slave;
  std::size_t most_at_once = 0;
  std::vector<std::uint32_t> asked;  ///< COB-IDs of requests other than aborts

  void run(BusScan& scan) {
    Time now = 1s;
    for (int steps = 0; !scan.done() && steps < 100'000; ++steps) {
      Outbox out;
      scan.on_time(now, out);
      most_at_once = std::max(most_at_once, out.frames().size());
      bool answered = false;
      for (const Frame& frame : out.frames()) {
        if (frame.data[0] == 0x80) continue;
        asked.push_back(frame.id.id());
        const auto answer = slave(frame.id.id() - 0x600, frame.data);
        if (!answer) continue;
        answered = true;
        scan.on_frame({.id = CobId::base(frame.id.id() - 0x80), .length = 8, .data = *answer}, now);
      }
      if (!answered) now = std::max(now + 1us, std::min(scan.deadline(), now + 10s));
    }
    EXPECT_TRUE(scan.done());
  }
};

TEST(BusScan, ReadsTypeIdentityAndNameOfEachNodeThatAnswers) {
  Bus bus;
  bus.slave = [](unsigned node, const Bytes& request) -> std::optional<Bytes> {
    if (node != 5) return {};
    if (request == Bytes{0x40, 0x00, 0x10, 0})
      return Bytes{0x43, 0x00, 0x10, 0, 0x92, 0x01, 0x02, 0};
    if (request == Bytes{0x40, 0x18, 0x10, 1}) return Bytes{0x43, 0x18, 0x10, 1, 0xCD, 0xAB, 0, 0};
    if (request == Bytes{0x40, 0x18, 0x10, 2}) return Bytes{0x43, 0x18, 0x10, 2, 0x02, 0x04, 0, 0};
    if (request == Bytes{0x40, 0x08, 0x10, 0})
      return Bytes{0x43, 0x08, 0x10, 0, 'a', 'x', 'i', 's'};
    return aborts(request);
  };
  BusScan scan{100ms};

  bus.run(scan);

  ASSERT_EQ(scan.nodes().size(), 1U);
  const ScannedNode& node = scan.nodes().at(5);
  EXPECT_TRUE(node.answers);
  EXPECT_EQ(node.device_type, 0x00020192U);
  EXPECT_EQ(node.identity[0], 0xABCDU);
  EXPECT_EQ(node.identity[1], 0x402U);
  EXPECT_FALSE(node.identity[2].has_value());
  EXPECT_FALSE(node.identity[3].has_value());
  EXPECT_EQ(node.name, "axis");
  EXPECT_EQ(node.state, NmtState::unknown);
}

TEST(BusScan, AsksAll127NodesOnceAndOnlySomeAtATime) {
  Bus bus;
  bus.slave = [](unsigned, const Bytes&) { return std::optional<Bytes>{}; };
  BusScan scan{100ms, 16};

  bus.run(scan);

  EXPECT_TRUE(scan.nodes().empty());
  ASSERT_EQ(bus.asked.size(), 127U);
  for (std::uint32_t i = 0; i < 127; ++i) EXPECT_EQ(bus.asked[i], 0x601 + i);
  EXPECT_LE(bus.most_at_once, 2 * 16U);  // requests, and aborts of earlier requests
}

TEST(BusScan, KeepsANodeThatOnlySendsHeartbeats) {
  Bus bus;
  bus.slave = [](unsigned, const Bytes&) { return std::optional<Bytes>{}; };
  BusScan scan{100ms};
  scan.on_frame({.id = CobId::base(0x70A), .length = 1, .data = {0x05}}, 1s);

  bus.run(scan);

  ASSERT_EQ(scan.nodes().size(), 1U);
  EXPECT_EQ(scan.nodes().at(10).state, NmtState::operational);
  EXPECT_FALSE(scan.nodes().at(10).answers);
}

TEST(BusScan, LeavesANodeThatFallsSilentWithWhatItHasReported) {
  Bus bus;
  bus.slave = [](unsigned node, const Bytes& request) -> std::optional<Bytes> {
    if (node != 127 || request[1] != 0x00) return {};
    return Bytes{0x43, 0x00, 0x10, 0, 0x91, 0x01, 0, 0};
  };
  BusScan scan{100ms};

  bus.run(scan);

  ASSERT_EQ(scan.nodes().size(), 1U);
  EXPECT_EQ(scan.nodes().at(127).device_type, 0x191U);
  EXPECT_FALSE(scan.nodes().at(127).identity[0].has_value());
}

TEST(BusScan, AbortsANameThatNeverEnds) {
  Bus bus;
  int segments = 0;
  bus.slave = [&](unsigned node, const Bytes& request) -> std::optional<Bytes> {
    if (node != 1) return {};
    if (request[0] == 0x40 && request[1] != 0x08) return aborts(request);
    if (request[0] == 0x40) return Bytes{0x40, 0x08, 0x10, 0};
    ++segments;
    return Bytes{static_cast<std::uint8_t>(request[0] & 0x10), 'x', 'x', 'x', 'x', 'x', 'x', 'x'};
  };
  BusScan scan{100ms};

  bus.run(scan);

  EXPECT_LE(segments, 11);
  EXPECT_EQ(scan.nodes().at(1).name, "");
}

TEST(BusScan, NoticesAnotherSdoClient) {
  BusScan scan{100ms};
  EXPECT_FALSE(scan.met_another_client());
  scan.on_frame({.id = CobId::base(0x605), .length = 8, .data = {0x40, 0x00, 0x10}}, 1s);
  EXPECT_TRUE(scan.met_another_client());
}

}  // namespace
}  // namespace takt
