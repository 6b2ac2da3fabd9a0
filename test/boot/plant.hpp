#pragma once
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <unistd.h>
#include <vector>

#include "eds_parser/network_file/load_network.hpp"
#include "master/explain/boot_report.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/sim/bus/sim_port.hpp"
#include "master/sim/bus/world.hpp"
#include "master/sim/device/device.hpp"
#include "test/support/folder.hpp"

namespace takt::test {

using namespace std::chrono_literals;

/// Compiles a network file given as text. The device files come from test/boot/data.
inline LoadedNetwork network_of(const std::string& yaml) {
  const Folder folder;
  LoadedNetwork network = load_network(folder.write(
      "network.yaml", "options: {dcf_path: " TAKT_SOURCE_DIR "/test/boot/data}\n" + yaml));
  for (const Finding& finding : network.findings) {
    if (finding.severity == Severity::error) ADD_FAILURE() << finding.message;
  }
  return network;
}

/// A network with one valve, node 5. The arguments add keys to the node and to the master, and
/// other nodes.
inline LoadedNetwork valve(const std::string& keys = "", const std::string& master = "",
                           const std::string& others = "") {
  const auto more = [](const std::string& text) { return text.empty() ? "" : ", " + text; };
  return network_of("bus: {name: plant, interface: can0}\nmaster: {sync_period: 10000" +
                    more(master) + "}\nnodes:\n  valve: {node_id: 5, dcf: valve.eds" + more(keys) +
                    "}\n" + others);
}

/// A complete master and its simulated devices in virtual time.
class Plant {
 public:
  explicit Plant(LoadedNetwork network, sim::Faults faults = {})
      : network_{std::move(network)},
        world{network_.devices, {.bitrate = network_.plan.bitrate, .faults = std::move(faults)}},
        port_{world, {.sync = network_.plan.cycle.sync_cob_id}},
        exchange_{std::make_unique<Exchange>(network_.plan)},
        loop_{std::make_unique<BusLoop<sim::SimPort>>(network_.plan, port_, *exchange_)} {
    world.observe(&wire);
  }

  /// Runs only the devices. The master is not there yet and receives none of their frames.
  void run_without_master(Time span) {
    world.advance_to(world.now() + span);
    std::array<StampedFrame, 64> unheard;
    while (port_.receive(unheard) != 0) {
    }
  }
  void run(Time span) {
    if (!begun_) loop_->start();
    begun_ = true;
    const Time until = world.now() + span;
    while (world.now() < until && !loop_->done()) {
      loop_->cycle();
      ImageView image;
      exchange_->images.take_newest(image);
      for (Event event; exchange_->events.pop(event);) events.push_back(event);
      for (Reply reply; exchange_->replies.pop(reply);) replies.push_back(reply);
    }
  }

  /// Requests the ordered stop and runs to its end.
  StopResult stop() {
    loop_->request_stop();
    for (int i = 0; i < 10'000 && !loop_->done(); ++i) run(plan().cycle.period);
    EXPECT_TRUE(loop_->done());
    StatusSnapshot snapshot;
    exchange_->status.read(snapshot);
    return snapshot.bus.stop_result;
  }

  /// Requests an NMT command as an application does.
  void nmt(NmtCommand command, std::uint8_t node) {
    Request request;
    request.kind = RequestKind::nmt;
    request.node = node;
    request.command = command;
    exchange_->requests.push(request);
  }
  void ask(const Request& request) { exchange_->requests.push(request); }
  /// Commands a set-point as an application does, from now on.
  void command(std::uint8_t node, std::uint16_t index, std::int64_t value) {
    const ImageLayout& layout = network_.plan.layout;
    for (std::size_t i = layout.inputs; i < layout.signals.size(); ++i) {
      const Signal& signal = layout.signals[i];
      if (signal.node.value() != node || signal.object.index != index) continue;
      exchange_->set_points.set(i - layout.inputs, value, 100'000);
    }
    exchange_->set_points.publish(world.now());
  }
  const BusPlan& plan() const { return network_.plan; }
  NodeStatus node(std::size_t index = 0) {
    StatusSnapshot snapshot;
    exchange_->status.read(snapshot);
    return snapshot.nodes[index];
  }
  sim::Device& device(std::uint8_t id) { return *world.device(*NodeId::from(id)); }

  long count(EventKind kind) const { return std::ranges::count(events, kind, &Event::kind); }
  /// Returns the text of the first event of a kind; empty if there was none.
  std::string text_of(EventKind kind) const {
    const auto found = std::ranges::find(events, kind, &Event::kind);
    return found == events.end() ? std::string{} : describe(network_.plan, *found);
  }
  /// Number of frames on the wire with this identifier: remote frames if `rtr`, else data frames.
  long frames(std::uint32_t id, bool rtr = false) const {
    return std::ranges::count_if(
        wire.frames, [=](const Frame& frame) { return frame.id.id() == id && frame.rtr == rtr; });
  }

  struct Wire final : sim::BusObserver {
    void on_wire(const sim::WireFrame& seen) noexcept override {
      if (seen.result == sim::WireResult::sent) frames.push_back(seen.frame);
    }
    std::vector<Frame> frames;
  };

 private:
  LoadedNetwork network_;

 public:
  Wire wire;
  sim::World world;
  std::vector<Event> events;
  std::vector<Reply> replies;

 private:
  sim::SimPort port_;
  std::unique_ptr<Exchange> exchange_;
  std::unique_ptr<BusLoop<sim::SimPort>> loop_;
  bool begun_ = false;
};

}  // namespace takt::test
