#pragma once
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "master/rt/bus_loop.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"
#include "test/unit/master/rt/fake_port.hpp"

namespace takt {

using namespace std::chrono_literals;
using test::FakeNetwork;
using test::FakePort;

/// The bus loop on a scripted port with two axes and a cycle of 2 ms. The axes answer 300 and 400
/// us after SYNC.
class Loop {
 public:
  explicit Loop(BusPlan bus_plan = test::axes(), BusLoopOptions options = {})
      : plan{std::move(bus_plan)}, exchange{std::make_unique<Exchange>(plan)} {
    for (unsigned i = 0; i < plan.nodes.size(); ++i) {
      port.answers.push_back({make_frame(CobId::base(0x181 + i), {0x37, 0x02, 1, 0, 0, 0}),
                              Time{300us} + i * Time{100us}});
    }
    loop = std::make_unique<BusLoop<FakePort, DirectLink, FakeNetwork>>(plan, port, *exchange,
                                                                        options);
    network = FakeNetwork::newest;
    start = port.now();
    loop->start();
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      port.calls.clear();
      loop->cycle();
      most_calls = std::max(most_calls, port.calls.size());
    }
  }
  void command_all(std::int64_t controlword, std::int64_t target, std::uint32_t ttl = 0) {
    const std::size_t axes = plan.nodes.size();
    for (std::size_t i = 0; i < axes; ++i) {
      exchange->set_points.set(i, controlword, ttl);
      exchange->set_points.set(axes + i, target, ttl);
    }
    exchange->set_points.publish(port.now());
  }
  std::vector<EventKind> reported() {
    std::vector<EventKind> all;
    for (Event event; exchange->events.pop(event);) all.push_back(event.kind);
    return all;
  }
  bool newest(ImageView& image) { return exchange->images.take_newest(image); }
  BusStatus status() {
    StatusSnapshot snapshot;
    exchange->status.read(snapshot);
    return snapshot.bus;
  }

  BusPlan plan;
  FakePort port;
  std::unique_ptr<Exchange> exchange;
  std::unique_ptr<BusLoop<FakePort, DirectLink, FakeNetwork>> loop;
  FakeNetwork* network = nullptr;
  Time start{};
  std::size_t most_calls = 0;
};

}  // namespace takt
