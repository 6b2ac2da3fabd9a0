#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "apps/takt/simulate/outcome_report.hpp"
#include "apps/takt/simulate/simulation.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using enum ProgramFaultKind;

/// The longest time to live that an application gives its commands is 27 cycles of 2 ms. The way to
/// the wire takes up to four more cycles.
constexpr Time longest_lease = 62ms;

/// RPDO 1 of an axis: controlword and target position.
struct SetPoint {
  Time when{};
  unsigned controlword = 0;
  std::int32_t position = 0;
  unsigned sender() const { return static_cast<unsigned>(position) & 7U; }
  bool enables() const { return (controlword & 0x0F) == 0x0F; }
};

/// The demo; application 0 moves `shoulder` and application 1 moves `elbow`.
class FrontSimulation : public testing::Test {
 protected:
  void run(ProgramFaults programs, Time duration = 8s, sim::Faults bus = {}) {
    const auto log = folder_ / "log";
    outcome = simulate(network_, {.duration = duration,
                                  .faults = std::move(bus),
                                  .applications = 2,
                                  .programs = std::move(programs),
                                  .candump = log.string()});
    std::ifstream in{log};
    for (std::string line; std::getline(in, line);) take(line);
  }

  /// Returns true if a set-point of the axis differed from the previous one within this time.
  static bool moves(const std::vector<SetPoint>& axis, Time from, Time until) {
    for (std::size_t i = 1; i < axis.size(); ++i) {
      if (axis[i].when < from || axis[i].when >= until) continue;
      if (axis[i].position != axis[i - 1].position) return true;
    }
    return false;
  }
  /// Returns the last set-point that was sent before this time.
  static const SetPoint& before(const std::vector<SetPoint>& axis, Time when) {
    std::size_t i = 0;
    while (i + 1 < axis.size() && axis[i + 1].when < when) ++i;
    return axis[i];
  }
  static bool anybody(const std::vector<SetPoint>& axis, unsigned sender) {
    for (const SetPoint& one : axis) {
      if (one.enables() && one.sender() == sender) return true;
    }
    return false;
  }
  std::uint64_t refused(CommandRefusal reason) const {
    return outcome.front->refused[std::to_underlying(reason)];
  }

  SimulationOutcome outcome;
  std::vector<SetPoint> shoulder;
  std::vector<SetPoint> elbow;

 private:
  void take(const std::string& line) {
    const std::size_t at = line.find(" 20");
    if (at == std::string::npos || line.size() < at + 17 || line[at + 4] != '#') return;
    std::vector<SetPoint>* axis = line[at + 3] == '1'   ? &shoulder
                                  : line[at + 3] == '2' ? &elbow
                                                        : nullptr;
    if (axis == nullptr) return;
    const auto byte = [&](std::size_t i) {
      return static_cast<std::uint32_t>(std::stoul(line.substr(at + 5 + 2 * i, 2), nullptr, 16));
    };
    const std::uint32_t position = byte(2) | byte(3) << 8 | byte(4) << 16 | byte(5) << 24;
    const std::chrono::duration<double> when{std::stod(line.substr(1))};
    axis->push_back({.when = std::chrono::duration_cast<Time>(when),
                     .controlword = byte(0) | byte(1) << 8,
                     .position = static_cast<std::int32_t>(position)});
  }

  const test::Folder folder_;
  LoadedNetwork network_ = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
};

TEST_F(FrontSimulation, EachApplicationMovesItsAxes) {
  run({}, 4s);

  EXPECT_EQ(outcome.axes_moved, 2U);
  EXPECT_TRUE(moves(shoulder, 3990ms, 4s));
  EXPECT_TRUE(moves(elbow, 3990ms, 4s));
  EXPECT_TRUE(anybody(shoulder, 0));
  EXPECT_FALSE(anybody(shoulder, 1));
  EXPECT_TRUE(anybody(elbow, 1));
  EXPECT_EQ(outcome.front->starts, 1U);
  EXPECT_GT(outcome.front->images, 1900U);
  EXPECT_GT(outcome.front->commands_taken, 3000U);
  EXPECT_EQ(outcome.front->fallbacks, 0U);
  EXPECT_EQ(outcome.stop, StopResult::confirmed);
}

TEST_F(FrontSimulation, TheSameSeedGivesTheSameJson) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  SimulationOptions options{.duration = 5s,
                            .seed = 3,
                            .applications = 2,
                            .programs = {{.kind = damage_messages, .at = 1s},
                                         {.kind = forge_command, .at = 2s},
                                         {.kind = replay, .at = 3s},
                                         {.kind = kill_master, .at = 4s, .until = 4500ms}}};
  const auto json = [&] {
    std::ostringstream text;
    print_json(text, simulate(network, options));
    return text.str();
  };

  const std::string first = json();

  EXPECT_NE(first.find("\"commands_taken\""), std::string::npos);
  EXPECT_EQ(json(), first);
  options.seed = 4;
  EXPECT_NE(json(), first);
}

TEST_F(FrontSimulation, TheAxisOfAKilledApplicationTakesItsFallbackInTime) {
  run({{.kind = kill_application, .application = 0, .at = 3s}});

  EXPECT_TRUE(moves(shoulder, 2990ms, 3s));
  EXPECT_FALSE(moves(shoulder, 3s + longest_lease, 8s));
  EXPECT_FALSE(before(shoulder, 3s + longest_lease).enables());
  EXPECT_TRUE(moves(elbow, 7990ms, 8s));
  EXPECT_EQ(outcome.front->fallbacks, 2U);  // controlword, mode of operation
}

TEST_F(FrontSimulation, AnApplicationThatIsStartedAgainMovesItsAxisAgain) {
  run({{.kind = kill_application, .application = 0, .at = 3s, .until = 4s}});

  EXPECT_FALSE(moves(shoulder, 3s + longest_lease, 4s));
  EXPECT_TRUE(moves(shoulder, 7990ms, 8s));
}

TEST_F(FrontSimulation, AnApplicationThatEndsInOrderLeavesNoFallbackToWarnOf) {
  run({{.kind = end_application, .application = 0, .at = 3s}});

  EXPECT_FALSE(moves(shoulder, 3s + longest_lease, 8s));
  EXPECT_FALSE(before(shoulder, 8s).enables());
  EXPECT_EQ(outcome.front->fallbacks, 0U);
}

/// The whole taktd is stopped for 8 s, and its application dies during this time.
TEST_F(FrontSimulation, CommandsThatWaitedWhileTaktdWasStoppedMoveNothing) {
  run({{.kind = kill_application, .application = 0, .at = 3500ms}}, 14s,
      {{.kind = sim::FaultKind::stall_master, .at = 3s, .until = 11s}});

  EXPECT_TRUE(moves(shoulder, 2990ms, 3s));
  EXPECT_FALSE(moves(shoulder, 3s + longest_lease, 14s));
  EXPECT_FALSE(before(shoulder, 14s).enables());
  EXPECT_GT(refused(CommandRefusal::waited), 0U);
  EXPECT_EQ(outcome.front->gaps, 1U);
}

TEST_F(FrontSimulation, AxesTakeTheirFallbackWhileTheFrontThreadIsStalled) {
  run({{.kind = stall_front, .at = 3s, .until = 3500ms}});

  EXPECT_FALSE(moves(shoulder, 3s + longest_lease, 3500ms));
  EXPECT_FALSE(moves(elbow, 3s + longest_lease, 3500ms));
  EXPECT_FALSE(before(elbow, 3500ms).enables());
  EXPECT_GT(refused(CommandRefusal::waited), 5U);
  EXPECT_TRUE(moves(shoulder, 7990ms, 8s));
}

TEST_F(FrontSimulation, AStoppedApplicationLosesItsAxisAndFindsItsQueueFull) {
  run({{.kind = stall_application, .application = 0, .at = 3s, .until = 5s}});

  EXPECT_FALSE(moves(shoulder, 3s + longest_lease, 5s));
  EXPECT_GT(outcome.front->applications[0].lost, 500U);
  EXPECT_EQ(outcome.front->applications[1].lost, 0U);
  EXPECT_TRUE(moves(shoulder, 7990ms, 8s));
}

TEST_F(FrontSimulation, ASlowApplicationHoldsUpNobodyElse) {
  run({{.kind = slow_application, .application = 0, .at = 3s, .until = 6s, .time = 300ms}});

  EXPECT_GT(outcome.front->fallbacks, 10U);
  for (Time t = 3s; t < 8s; t += 10ms) EXPECT_TRUE(moves(elbow, t, t + 10ms)) << t / 1ms;
  EXPECT_TRUE(moves(shoulder, 7990ms, 8s));
}

TEST_F(FrontSimulation, CommandsThatWereLongOnTheirWayAreTooOld) {
  run({{.kind = slow_messages, .at = 3s, .until = 5s, .time = 300ms}});

  EXPECT_GT(refused(CommandRefusal::too_old), 100U);
  EXPECT_TRUE(moves(shoulder, 7990ms, 8s));
}

TEST_F(FrontSimulation, AReplayMovesNothing) {
  run({{.kind = kill_application, .at = 4s}, {.kind = replay, .at = 6500ms, .until = 7500ms}});

  EXPECT_FALSE(moves(shoulder, 4s + longest_lease, 8s));
  EXPECT_FALSE(moves(elbow, 4s + longest_lease, 8s));
  EXPECT_GT(refused(CommandRefusal::too_old), 100U);
  EXPECT_GT(refused(CommandRefusal::no_cycle), 100U);
}

TEST_F(FrontSimulation, AReplayAfterARestartOfTaktdMovesNothing) {
  run({{.kind = kill_application, .at = 4s},
       {.kind = kill_master, .at = 4100ms, .until = 4200ms},
       {.kind = replay, .at = 7s, .until = 7500ms}});

  EXPECT_EQ(outcome.front->starts, 2U);
  EXPECT_FALSE(moves(shoulder, 4s + longest_lease, 8s));
  EXPECT_GT(refused(CommandRefusal::session), 100U);
}

TEST_F(FrontSimulation, ApplicationsMoveTheirAxesAgainAfterARestartOfTaktd) {
  run({{.kind = kill_master, .at = 3s, .until = 4s}}, 10s);

  EXPECT_EQ(outcome.front->starts, 2U);
  EXPECT_FALSE(moves(shoulder, 3010ms, 4s));
  EXPECT_TRUE(moves(shoulder, 9990ms, 10s));
  EXPECT_TRUE(moves(elbow, 9990ms, 10s));
  EXPECT_EQ(outcome.stop, StopResult::confirmed);
}

TEST_F(FrontSimulation, ATaktdThatNeverComesAgainConfirmsNoStop) {
  run({{.kind = kill_master, .at = 3s}}, 4s);

  EXPECT_FALSE(outcome.stopped);
  EXPECT_NE(outcome.stop, StopResult::confirmed);
}

TEST_F(FrontSimulation, AStopThatAnAxisDoesNotAnswerIsNotConfirmed) {
  run({}, 4s, {{.kind = sim::FaultKind::loss, .node = 1_node, .at = 3990ms, .probability = 1.0}});

  EXPECT_TRUE(outcome.stopped);
  EXPECT_NE(outcome.stop, StopResult::confirmed);
  ASSERT_EQ(outcome.unconfirmed.size(), 1U);
  EXPECT_TRUE(outcome.unconfirmed[0].starts_with("shoulder")) << outcome.unconfirmed[0];
}

TEST_F(FrontSimulation, AStopWhileTheFrontThreadIsStalledNamesTheAxisAllTheSame) {
  run({{.kind = stall_front, .at = 3960ms}}, 4s,
      {{.kind = sim::FaultKind::loss, .node = 1_node, .at = 3950ms, .probability = 1.0}});

  EXPECT_NE(outcome.stop, StopResult::confirmed);
  ASSERT_EQ(outcome.unconfirmed.size(), 1U);
  EXPECT_TRUE(outcome.unconfirmed[0].starts_with("shoulder")) << outcome.unconfirmed[0];
  EXPECT_FALSE(outcome.mandatory_failed);
}

TEST_F(FrontSimulation, ASecondProgramOfTheSameNameMovesNothing) {
  run({{.kind = second_sender, .application = 0, .at = 3s, .until = 6s}});

  EXPECT_FALSE(anybody(shoulder, 7));
  EXPECT_GT(refused(CommandRefusal::held), 1000U);
  EXPECT_EQ(outcome.front->fallbacks, 0U);
  EXPECT_TRUE(moves(shoulder, 5990ms, 6s));
}

TEST_F(FrontSimulation, AForgedCommandNeverReachesTheBus) {
  run({{.kind = forge_command, .at = 3s, .until = 6s}});

  EXPECT_FALSE(anybody(shoulder, 6));
  EXPECT_FALSE(anybody(elbow, 6));
  EXPECT_GT(refused(CommandRefusal::no_cycle), 10U);
  EXPECT_GT(refused(CommandRefusal::future), 10U);
  EXPECT_GT(refused(CommandRefusal::session), 10U);
  EXPECT_EQ(outcome.front->fallbacks, 0U);
}

TEST_F(FrontSimulation, AForgedImageDeafensNoApplication) {
  run({{.kind = forge_image, .at = 3s, .until = 6s}});

  EXPECT_EQ(outcome.front->fallbacks, 0U);
  for (Time t = 3s; t < 8s; t += 20ms) EXPECT_TRUE(moves(shoulder, t, t + 20ms)) << t / 1ms;
}

TEST_F(FrontSimulation, DamagedMessagesStopNobody) {
  run({{.kind = damage_messages, .at = 3s, .until = 6s}});

  EXPECT_GT(outcome.front->damaged, 100U);
  EXPECT_EQ(outcome.front->fallbacks, 0U);
  for (Time t = 3s; t < 8s; t += 20ms) EXPECT_TRUE(moves(shoulder, t, t + 20ms)) << t / 1ms;
}

}  // namespace
}  // namespace takt
