#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "master/rt/beat/beat.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/frame_sender.hpp"
#include "master/rt/intake.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/slack.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"
#include "test/unit/master/rt/fake_port.hpp"

namespace takt {

using namespace std::chrono_literals;
using test::FakeNetwork;
using test::FakePort;

/// The parts of a bus loop, each to be called by the test. Two axes, a cycle of 2 ms: receive
/// window 1200 us, outputs 1600 us after SYNC. The first SYNC is due at 10.002 s.
struct Parts {
  explicit Parts(BusPlan bus_plan = test::axes()) : plan{std::move(bus_plan)} { beat.start(10s); }

  /// Waits for the next beat. The frames that have come are taken.
  void await() {
    beat.await(port, bus.services, [&] { intake.drain(); });
  }
  void arrive(Time when, Frame frame) { port.inbox.push_back({.frame = frame, .when = when}); }
  std::vector<EventKind> reported() {
    std::vector<EventKind> all;
    for (Event event; bus.events.pop(event);) all.push_back(event.kind);
    return all;
  }

  BusPlan plan;
  FakePort port;
  std::unique_ptr<Exchange> exchange = std::make_unique<Exchange>(plan);
  std::unique_ptr<BusMachines<FakeNetwork>> machines =
      std::make_unique<BusMachines<FakeNetwork>>(plan, false);
  BusMachines<FakeNetwork>& bus = *machines;
  Beat beat{plan, bus.events, bus.status, exchange->timing};
  FrameSender<FakePort> sender{port, beat, bus.events, bus.status};
  Intake<FakePort, FakeNetwork> intake{port, beat, bus, exchange->timing};
  Slack<FakePort, FakeNetwork> slack{port, beat, sender, intake, bus};
};

}  // namespace takt
