#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <unistd.h>
#include <vector>

#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/print/plan/plan_fingerprint.hpp"
#include "master/black_box/recording_file.hpp"
#include "master/black_box/replay.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/rt/journal/recorded_link.hpp"
#include "master/rt/journal/recorded_port.hpp"
#include "master/sim/bus/sim_port.hpp"
#include "test/support/folder.hpp"

namespace takt::test {

/// A network on the simulated bus, with a journal.
class RecordedRun {
 public:
  explicit RecordedRun(const std::string& demo, sim::Faults faults = {},
                       std::size_t bytes = 8 << 20)
      : network{load_network(TAKT_SOURCE_DIR "/share/demo/" + demo)},
        journal{bytes},
        world{network.devices,
              {.seed = 7, .bitrate = network.plan.bitrate, .faults = std::move(faults)}},
        sim_port_{world,
                  {.sync = network.plan.cycle.sync_cob_id,
                   .wake_jitter = std::chrono::microseconds{40},
                   .spin_jitter = std::chrono::microseconds{5}}},
        port_{sim_port_, &journal},
        exchange{std::make_unique<Exchange>(network.plan)},
        loop_{network.plan, port_, RecordedLink{*exchange, &journal}} {
    loop_.start();
  }

  void run_until(Time end) {
    while (world.now() < end) cycle();
  }
  void stop() {
    loop_.request_stop();
    while (!loop_.done()) cycle();
  }
  std::vector<Event> events;
  std::function<void()> each_cycle = [] {};

  /// Writes the present content of the journal; the recording continues.
  std::filesystem::path write(const std::filesystem::path& stem, const std::string& follows = {}) {
    journal.want();
    cycle();
    const Tape* const tape = journal.wanted();
    write_tape(stem, *tape, follows);
    journal.give_back();
    return stem;
  }
  void write_tape(const std::filesystem::path& stem, const Tape& tape,
                  const std::string& follows = {}) {
    const RecordingHead head{.bus = network.plan.name,
                             .network = TAKT_SOURCE_DIR "/share/demo/two_axes.yaml",
                             .fingerprint = plan_fingerprint(network.plan),
                             .reason = "a test",
                             .follows = follows};
    EXPECT_TRUE(write_recording(stem, network.plan, head, tape.read()).has_value());
  }
  void cycle() {
    each_cycle();
    loop_.cycle();
    ImageView image;
    exchange->images.take_newest(image);
    for (Event event; exchange->events.pop(event);) events.push_back(event);
    for (Reply reply; exchange->replies.pop(reply);) replies.push_back(reply);
  }
  std::vector<Reply> replies;

  LoadedNetwork network;
  Journal journal;
  sim::World world;

 private:
  sim::SimPort sim_port_;
  RecordedPort<sim::SimPort> port_;

 public:
  std::unique_ptr<Exchange> exchange;

 private:
  BusLoop<RecordedPort<sim::SimPort>, RecordedLink> loop_;
};

inline ReplayOutcome replay_file(const BusPlan& plan, const std::filesystem::path& file) {
  const auto recording = read_recording(file);
  if (!recording) return {.difference = recording.error()};
  return replay(plan, *recording, [](const Decision&) {});
}

}  // namespace takt::test
