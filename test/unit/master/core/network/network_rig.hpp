#pragma once
#include <deque>
#include <gtest/gtest.h>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "master/core/network/network.hpp"
#include "test/unit/master/core/network/fake_node.hpp"

namespace takt {

/// Builds boot plans with one line per step.
struct Steps {
  BootPlan plan;

  Steps& add(BootStep step) {
    plan.steps.push_back(std::move(step));
    return *this;
  }
  Steps& nmt(NmtCommand command) { return add({.action = BootAction::nmt, .command = command}); }
  Steps& wait(BootAction action, char letter, Time timeout) {
    return add({.action = action, .letter = letter, .timeout = timeout});
  }
  Steps& object(BootAction action, char letter, ObjectKey key, std::vector<std::byte> value = {},
                std::string purpose = {}) {
    return add({.action = action,
                .letter = letter,
                .object = key,
                .value = std::move(value),
                .timeout = 100ms,
                .purpose = std::move(purpose)});
  }
  Steps& skip(std::uint16_t target) {
    return add({.action = BootAction::skip_if_same, .target = target});
  }
};

/// A master and fake nodes in virtual time.
class NetworkRig {
 public:
  NodePlan& add(std::uint8_t id, BootPlan boot, std::string name = "shoulder") {
    devices.emplace_back(id);
    plan.nodes.push_back({.name = std::move(name),
                          .id = *NodeId::from(id),
                          .description_file = "drive.eds",
                          .product_name = "Drive",
                          .boot_plan = std::move(boot),
                          .sdo_timeout = 100ms,
                          .reboot_delay = 1s});
    return plan.nodes.back();
  }
  void start(NetworkOptions options = {}) {
    network = std::make_unique<Network>(plan, options);
    network->start(now);
  }
  FakeNode& device(std::size_t index = 0) { return devices[index]; }
  const NodeStatus& status(std::size_t index = 0) const { return network->nodes()[index]; }

  /// Runs until `span` from now has passed; time jumps from deadline to deadline.
  void run(Time span) {
    const Time until = now + span;
    for (;;) {
      step();
      Time next = network->deadline();
      if (next <= now) next = now + 1ms;  // the next cycle brings new budget
      for (const auto& device : devices) next = std::min(next, device.deadline());
      if (next > until) break;
      now = std::max(now, next);
      deliver();
    }
    now = until;
  }
  void step() {
    Outbox out;
    network->on_time(now, out);
    most_frames = std::max(most_frames, out.frames().size());
    for (const Frame& frame : out.frames()) {
      sent.push_back(frame);
      log.push_back(frame);
      if (loses()) continue;
      for (auto& device : devices) device.on_frame(frame, now);
    }
    collect();
  }
  void deliver() {
    for (auto& device : devices) {
      for (const Frame& frame : device.take(now)) {
        if (!loses()) hear(frame);
      }
    }
  }
  void hear(const Frame& frame) {
    Outbox out;
    log.push_back(frame);
    network->on_frame(frame, now, out);
    EXPECT_TRUE(out.empty());
    collect();
  }
  /// Loses one frame in `frames` on average, in both directions; the choice depends on the seed.
  void lose_one_in(unsigned frames, unsigned seed) {
    lose_one_in_ = frames;
    random_.seed(seed);
  }
  bool loses() {
    const bool gone = lose_one_in_ != 0 && random_() % lose_one_in_ == 0;
    lost += gone;
    return gone;
  }
  void collect() {
    for (Event event; network->take(event);) events.push_back(event);
    for (Reply reply; network->take(reply);) replies.push_back(reply);
  }
  int count(EventKind kind) const {
    return static_cast<int>(std::ranges::count(events, kind, &Event::kind));
  }
  const Event* find(EventKind kind) const {
    const auto found = std::ranges::find(events, kind, &Event::kind);
    return found == events.end() ? nullptr : &*found;
  }

  BusPlan plan{.name = "lift"};
  std::deque<FakeNode> devices;
  std::unique_ptr<Network> network;
  Time now = 10s;
  std::vector<Frame> sent;  // frames of the master
  std::vector<Frame> log;   // all frames in order
  std::vector<Event> events;
  std::vector<Reply> replies;
  std::size_t most_frames = 0;
  int lost = 0;

 private:
  unsigned lose_one_in_ = 0;
  std::mt19937 random_;
};

}  // namespace takt
