#include <algorithm>
#include <chrono>
#include <gtest/gtest.h>
#include <optional>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/clock.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"
#include "test/support/time_limit.hpp"

namespace takt::test {
namespace {

using std::chrono::milliseconds;

/// Follows the first RPDO of an axis (controlword, target position) on the bus.
class WatchedAxis {
 public:
  WatchedAxis(FrameChannel& channel, CobId rpdo) : channel_{channel}, rpdo_{rpdo} {}

  /// Takes frames until `done` returns true, at most for `time_limit`.
  template <class Done>
  bool watch(Done done) {
    const Time until = monotonic_now() + time_limit;
    while (!done()) {
      if (monotonic_now() > until) return false;
      StampedFrame got;
      if (channel_.receive(got, milliseconds{20})) take(got.frame);
    }
    return true;
  }
  /// Takes the frames that have arrived.
  void drain() {
    StampedFrame got;
    while (channel_.receive(got, milliseconds{0})) take(got.frame);
  }
  bool moving() const noexcept { return changes_ > 50 && (controlword_ & 0x0F) == 0x0F; }
  /// True if the controlword demands a quick stop: bit 2 is 0. CiA 402.
  bool quick_stop() const noexcept { return (controlword_ & 0x06) == 0x02; }
  std::int32_t farthest() const noexcept { return farthest_; }
  void forget_farthest() noexcept { farthest_ = 0; }
  /// Number of SYNCs since the last change of the target.
  int syncs_at_rest() const noexcept { return syncs_; }

 private:
  void take(const Frame& frame) {
    if (frame.id == CobId::base(0x080)) ++syncs_;
    if (frame.id != rpdo_ || frame.length != 6) return;
    controlword_ = frame.data[0] | frame.data[1] << 8;
    std::uint32_t target = 0;
    for (std::size_t i = 6; i > 2; --i) target = target << 8 | frame.data[i - 1];
    farthest_ = std::max(farthest_, static_cast<std::int32_t>(target));
    if (target == target_) return;
    target_ = target;
    ++changes_;
    syncs_ = 0;
  }

  FrameChannel& channel_;
  CobId rpdo_;
  int controlword_ = 0;
  std::uint32_t target_ = 0;
  std::int32_t farthest_ = 0;
  int changes_ = 0;
  int syncs_ = 0;
};

/// Returns the cycle in which the newest fallback began.
std::int64_t fallback_cycle(DaemonProcess& daemon) {
  std::int64_t cycle = 0;
  for (const event_t& event : daemon.bus().events()) {
    if (event.kind == "fallback_begun") cycle = event.cycle;
  }
  return cycle;
}

TEST(StoppedApplication, ItsAxesQuickStopAfterTheTimeToLive) {
  const Folder folder;
  const std::string bus = "unix:" + (folder / "bus").string();
  const auto network = slow_network(folder.path(), [](std::string& text) {
    text = std::regex_replace(text, std::regex{"after_cycles: \\d+"}, "after_cycles: 20");
  });
  const Process devices{{TAKT, "sim", network.string(), "--bus", bus}, folder / "devices"};
  ASSERT_TRUE(devices.says("3 devices on"));
  DaemonProcess daemon{network, {"--bus", bus}};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  auto channel = FrameChannel::open(bus);
  ASSERT_TRUE(channel.has_value());
  WatchedAxis axis{*channel, CobId::base(0x201)};
  const Process move{{TAKT_MOVE, "--lcm-url", daemon.lcm_url(), "--sine", "--for", "60s"},
                     folder / "move"};
  ASSERT_TRUE(axis.watch([&] { return axis.moving(); })) << move.output();
  EXPECT_EQ(daemon.events("fallback_begun"), 0U);

  ASSERT_TRUE(move.stop());
  const Time stopped = monotonic_now();

  EXPECT_TRUE(axis.watch([&] { return axis.quick_stop(); }));
  EXPECT_TRUE(axis.watch([&] { return axis.syncs_at_rest() >= 100; })) << "nothing moves it again";
  EXPECT_TRUE(axis.quick_stop());
  EXPECT_TRUE(daemon.hear([&] {
    return daemon.events("fallback_begun", "20 cycles (on_timeout: after_cycles)") > 0;
  })) << daemon.log();
  // The limit allows for two effects: a cycle that a busy machine has skipped has no image, and the
  // newest command is one cycle old.
  EXPECT_LE(daemon.images_between(stopped, fallback_cycle(daemon)), 22U);
}

/// The application continues for seconds and dies before taktd runs again. None of its commands may
/// move an axis afterwards.
TEST(KilledApplication, ItsCommandsThatWaitedInAStoppedDaemonMoveNothing) {
  constexpr std::int64_t standing = 1000;
  const Folder folder;
  const std::string bus = "unix:" + (folder / "bus").string();
  const auto network = slow_network(folder.path(), [](std::string& text) {
    text = std::regex_replace(text, std::regex{"  limits: [^\\n]*"}, "");  // only age decides
    text = std::regex_replace(text, std::regex{"after_cycles: \\d+"}, "after_cycles: 50");
    // Devices that monitor the master would stop their axes themselves.
    text = std::regex_replace(text, std::regex{"heartbeat_producer: 100 +# ms"},
                              "heartbeat_producer: 0");
  });
  const Process devices{{TAKT, "sim", network.string(), "--bus", bus}, folder / "devices"};
  ASSERT_TRUE(devices.says("3 devices on"));
  DaemonProcess daemon{network, {"--bus", bus}};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  auto channel = FrameChannel::open(bus);
  ASSERT_TRUE(channel.has_value());
  WatchedAxis axis{*channel, CobId::base(0x201)};
  std::int64_t target = 0;
  const auto command = [&](std::int64_t cycles_more) {
    const std::int64_t word = daemon.value("shoulder", "statusword");
    const std::int64_t next = (word & 0x4F) == 0x40 ? 0x06 : (word & 0x6F) == 0x21 ? 0x07 : 0x0F;
    command_t made = daemon.command_for("application", {{"shoulder.controlword", next},
                                                        {"shoulder.modes_of_operation", 8},
                                                        {"shoulder.target_position", target}});
    made.cycle += cycles_more;
    daemon.command(made);
  };
  ASSERT_TRUE(daemon.work(
      [&] {
        if ((daemon.value("shoulder", "statusword") & 0x6F) == 0x27 && target < standing) {
          target += 20;
        }
        command(0);
        axis.drain();
      },
      [&] { return daemon.value("shoulder", "position_actual_value") >= standing - 10; }));

  daemon.signal(SIGSTOP);
  for (int i = 0; i < 150; ++i) {
    target += 20;
    command(i % 3 == 0 ? 0 : i);  // some applications count cycles, others send 0
    axis.drain();
    std::this_thread::sleep_for(milliseconds{20});
  }
  axis.forget_farthest();
  daemon.signal(SIGCONT);

  EXPECT_TRUE(axis.watch([&] { return axis.quick_stop(); }));
  const std::int64_t cycle = daemon.bus().cycle();
  EXPECT_TRUE(daemon.hear([&] { return daemon.bus().cycle() >= cycle + 200; }));
  EXPECT_TRUE(axis.watch([&] { return axis.syncs_at_rest() >= 100; }));
  EXPECT_LE(axis.farthest(), standing);
}

/// Set-points computed while the daemon is stopped would become one large step that no drive could
/// follow.
TEST(StoppedDaemon, ItsApplicationDoesNotRunAway) {
  const Folder folder;
  DaemonProcess daemon{TAKT_SOURCE_DIR "/share/demo/two_axes.yaml"};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  Process move{{TAKT_MOVE, "--lcm-url", daemon.lcm_url(), "--sine", "--for", "6s"},
               folder / "move"};
  ASSERT_TRUE(move.says("sine of")) << move.output();

  for (int i = 0; i < 8; ++i) {
    daemon.stop_for(milliseconds{150});
    const std::int64_t cycle = daemon.bus().cycle();
    ASSERT_TRUE(daemon.hear([&] { return daemon.bus().cycle() >= cycle + 175; }));
  }

  EXPECT_EQ(move.wait(), 0) << move.output();
  EXPECT_NE(move.output().find("The axes followed."), std::string::npos) << move.output();
}

TEST(StoppedDaemon, ItsApplicationHoldsAndGoesOn) {
  const Folder folder;
  DaemonProcess daemon{slow_network(folder.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  const Process move{{TAKT_MOVE, "--lcm-url", daemon.lcm_url(), "--sine", "--for", "60s"},
                     folder / "move"};
  ASSERT_TRUE(move.says("sine of")) << move.output();

  daemon.signal(SIGSTOP);
  EXPECT_TRUE(move.says("cycles: the motion holds")) << move.output();

  daemon.signal(SIGCONT);
  EXPECT_TRUE(move.says("fresh again: the motion continues")) << move.output();
}

TEST(MovingApplication, EndsOnASecondSignalWhereNoAxisAnswers) {
  const Folder folder;
  const std::string bus = "unix:" + (folder / "bus").string();
  const auto network = slow_network(folder.path());
  std::optional<Process> devices;
  devices.emplace(std::vector<std::string>{TAKT, "sim", network.string(), "--bus", bus},
                  folder / "devices");
  ASSERT_TRUE(devices->says("3 devices on"));
  DaemonProcess daemon{network, {"--bus", bus}};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  Process move{{TAKT_MOVE, "--lcm-url", daemon.lcm_url(), "--sine", "--for", "60s"},
               folder / "move"};
  ASSERT_TRUE(move.says("sine of")) << move.output();
  devices.reset();
  ASSERT_TRUE(move.says("the motion holds")) << move.output();

  move.signal(SIGINT);
  ASSERT_TRUE(move.says("disabling the axes")) << move.output();
  move.signal(SIGINT);

  EXPECT_EQ(move.wait(), 1) << move.output();
  EXPECT_NE(move.output().find("a second signal"), std::string::npos) << move.output();
}

TEST(MovingApplication, DisablesItsAxesWhenItsTerminalIsGone) {
  const Folder folder;
  DaemonProcess daemon{TAKT_SOURCE_DIR "/share/demo/two_axes.yaml"};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  Process move{{TAKT_MOVE, "--lcm-url", daemon.lcm_url(), "--sine", "--for", "60s"},
               folder / "move"};
  ASSERT_TRUE(move.says("sine of")) << move.output();

  move.signal(SIGHUP);
  move.signal(SIGHUP);

  EXPECT_EQ(move.wait(), 0) << move.output();
  EXPECT_NE(move.output().find("disabling the axes"), std::string::npos) << move.output();
}

/// The commands of the second program are refused while the first one moves the axes.
TEST(MovingApplication, NamesTheProgramThatHoldsItsAxesAndEnds) {
  const Folder folder;
  DaemonProcess daemon{TAKT_SOURCE_DIR "/share/demo/two_axes.yaml"};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  Process first{{TAKT_MOVE, "--lcm-url", daemon.lcm_url(), "--sine", "--for", "60s"},
                folder / "first"};
  ASSERT_TRUE(first.says("sine of")) << first.output();

  const Ended second = run({TAKT_MOVE, "--lcm-url", daemon.lcm_url(), "--to", "1"}, folder.path());

  EXPECT_EQ(second.exit_code, 1) << second.output;
  EXPECT_NE(second.output.find("shoulder belongs to 'takt-move "), std::string::npos)
      << second.output;
  EXPECT_NE(second.output.find("', and the commands of this program are refused"),
            std::string::npos)
      << second.output;
  EXPECT_EQ(second.output.find("moving all axes"), std::string::npos) << second.output;
  EXPECT_EQ(second.output.find("The axes followed."), std::string::npos) << second.output;

  first.signal(SIGINT);
  EXPECT_EQ(first.wait(), 0) << first.output();
}

TEST(MovingApplication, LetsTaktdRunTheMoveWhereItRunsMotions) {
  const Folder folder;
  DaemonProcess daemon{slow_network(folder.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  int rounds = 0;
  const auto hear_once = [&] { daemon.hear([&] { return rounds++ % 2 == 1; }); };
  std::optional<int> code;
  std::string output;
  do {
    Process move{{TAKT_MOVE, "--lcm-url", daemon.lcm_url(), "--to", "0.5"}, folder / "move"};
    code = move.wait(hear_once);
    output = move.output();
  } while (code != 0 && missed_cycles(output));

  EXPECT_EQ(code, 0) << output;
  EXPECT_NE(output.find(" s, by taktd"), std::string::npos) << output;
  EXPECT_NE(output.find("The axes followed."), std::string::npos) << output;
  EXPECT_NEAR(static_cast<double>(daemon.value("shoulder", "position_actual_value")), 796, 4)
      << "0.5 rad in counts";
}

TEST(MovingApplication, NamesABusWithoutAxes) {
  const Folder folder;
  DaemonProcess daemon{TAKT_SOURCE_DIR "/share/demo/beckhoff.yaml"};

  const Ended move = run({TAKT_MOVE, "--lcm-url", daemon.lcm_url()}, folder.path());

  EXPECT_EQ(move.exit_code, 2) << move.output;
  EXPECT_NE(move.output.find("no axis with profile cia402 on bus"), std::string::npos)
      << move.output;
}

TEST(MovingApplication, RefusesWhatIsNoFiniteNumber) {
  const Folder folder;
  for (const char* option : {"--to", "--amplitude", "--velocity", "--for"}) {
    const Ended move = run({TAKT_MOVE, option, "nan"}, folder.path());
    EXPECT_EQ(move.exit_code, 2) << option << ": " << move.output;
  }
  EXPECT_EQ(run({TAKT_MOVE, "--to", "1.0,inf"}, folder.path()).exit_code, 2);
}

}  // namespace
}  // namespace takt::test
