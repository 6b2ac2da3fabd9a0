// Programs that command motions by a file, in a whole taktd in virtual time.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <utility>

#include "apps/takt/simulate/fault_file.hpp"
#include "apps/takt/simulate/outcome_report.hpp"
#include "apps/takt/simulate/simulation.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class SimulatedMotions : public testing::Test {
 protected:
  FaultFile read(const std::string& text) {
    return read_fault_file(folder_.write("motions.yaml", text), network_.plan);
  }
  SimulationOutcome run(const std::string& text, Time duration = 6s, std::uint64_t seed = 1) {
    FaultFile file = read(text);
    for (const Finding& finding : file.findings) ADD_FAILURE() << to_string(finding);
    SimulationOutcome outcome = simulate(network_, {.duration = duration,
                                                    .seed = seed,
                                                    .faults = std::move(file.faults),
                                                    .programs = std::move(file.programs),
                                                    .motions = std::move(file.motions)});
    for (const MotionOutcome& one : outcome.motions) {
      EXPECT_GE(one.end.value_or(never), one.begin.value_or(Time{}));
    }
    return outcome;
  }
  static double seconds(const std::optional<Time>& time) {
    return time ? std::chrono::duration<double>(*time).count() : -1.0;
  }

  const test::Folder folder_;
  LoadedNetwork network_ = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
};

TEST_F(SimulatedMotions, EachEndsAsCommandedWithItsLargestValues) {
  const SimulationOutcome outcome =
      run("motions:\n"
          "  - {kind: enable}\n"
          "  - {kind: move, at: 2s, to: [1, -2], velocity: [2, 4], acceleration: 20}\n"
          "  - {kind: move_by, by: 0.5, velocity: 3, acceleration: 30}\n"
          "  - {kind: disable}\n");

  ASSERT_EQ(outcome.motions.size(), 4u);
  for (const MotionOutcome& one : outcome.motions) EXPECT_EQ(one.result, "done") << one.text;
  const MotionOutcome& move = outcome.motions[1];
  EXPECT_EQ(move.kind, MotionKind::move);
  EXPECT_EQ(move.pos, (SourcePos{3, 5}));
  EXPECT_NEAR(seconds(move.begin), 2.0, 0.01);
  EXPECT_NEAR(seconds(move.end), 2.76, 0.02) << "2 rad at 4 rad/s, ramps of 0.2 s, and their jerk";
  ASSERT_EQ(move.axes.size(), 2u);
  EXPECT_EQ(move.axes[0].axis, "shoulder");
  EXPECT_EQ(move.axes[0].unit, "rad");
  EXPECT_LE(move.axes[0].velocity, 2.0 + 1e-9);
  EXPECT_NEAR(move.axes[1].velocity, 4.0, 0.01);
  EXPECT_NEAR(move.axes[1].acceleration, 20.0, 0.01);
  EXPECT_GT(move.axes[1].following_error, 0.0);
  EXPECT_LT(move.axes[1].following_error, 0.1);
  EXPECT_GE(*outcome.motions[2].begin, *move.end) << "it has no time of its own";
  EXPECT_EQ(outcome.axes_moved, 2u);
  EXPECT_EQ(outcome.stop, StopResult::confirmed);
}

TEST_F(SimulatedMotions, TheNextEntryOfAProgramEndsAMotion) {
  const SimulationOutcome outcome = run(
      "motions:\n"
      "  - {kind: enable, axes: [shoulder]}\n"
      "  - {kind: move, at: 2s, to: 50, velocity: 2, acceleration: 20}\n"
      "  - {kind: jog, at: 3s, velocity: -1, acceleration: 20}\n"
      "  - {kind: stop, at: 4s}\n"
      "  - kind: stream\n"
      "    at: 5s\n"
      "    velocity: 10\n"
      "    acceleration: 100\n"
      "    points: [{time: 2s, position: 3, velocity: 0}, {time: 4s, position: 1, velocity: 0}]\n"
      "  - {kind: stop, at: 6s}\n",
      8s);

  ASSERT_EQ(outcome.motions.size(), 6u);
  EXPECT_EQ(outcome.motions[1].result, "replaced");
  EXPECT_EQ(outcome.motions[1].text, "the entry in line 4 ended it");
  EXPECT_EQ(outcome.motions[2].result, "stopped");
  EXPECT_NEAR(seconds(outcome.motions[2].end), 4.0, 0.01);
  EXPECT_EQ(outcome.motions[3].result, "done");
  EXPECT_EQ(outcome.motions[4].result, "stopped") << outcome.motions[4].text;
  EXPECT_EQ(outcome.motions[4].text, "the entry in line 11 ended it");
  EXPECT_EQ(outcome.motions[5].result, "done");
}

TEST_F(SimulatedMotions, FaultsEndThemAndAreNamed) {
  const SimulationOutcome outcome =
      run("motions:\n"
          "  - {kind: enable, program: arm, axes: [shoulder]}\n"
          "  - {kind: move, program: arm, at: 2s, to: 50, velocity: 2, acceleration: 20}\n"
          "  - {kind: enable, program: tool, axes: [elbow]}\n"
          "  - {kind: move, program: tool, at: 1s, to: 500, velocity: 2, acceleration: 20}\n"
          "  - {kind: jog, program: tool, velocity: 1, acceleration: 10}\n"
          "  - {kind: stop, program: tool, at: 9s}\n"
          "faults:\n"
          "  - {kind: stall_front, at: 2500ms, for: 100ms}\n"
          "  - {kind: power_off, node: shoulder, at: 4s}\n");

  ASSERT_EQ(outcome.motions.size(), 6u);
  const MotionOutcome& move = outcome.motions[1];
  EXPECT_EQ(move.result, "stopped");
  EXPECT_THAT(move.text, HasSubstr("shoulder"));
  EXPECT_GT(seconds(move.end), 4.0);
  EXPECT_LT(seconds(move.end), 4.5);
  EXPECT_EQ(outcome.motions[3].result, "refused");
  EXPECT_THAT(outcome.motions[3].text, HasSubstr("range"));
  EXPECT_EQ(outcome.motions[4].result, "stopped") << "the loss of the shoulder stops the elbow";
  EXPECT_EQ(outcome.motions[5].result, "not_begun");
  EXPECT_FALSE(outcome.motions[5].begin);
}

TEST_F(SimulatedMotions, AProgramThatIsKilledLeavesItsMotionToItsTimeout) {
  const SimulationOutcome outcome =
      run("motions:\n"
          "  - {kind: enable, axes: [elbow]}\n"
          "  - {kind: gear, at: 2s, leader: shoulder, velocity: 20, acceleration: 200}\n"
          "  - {kind: move, at: 5s, to: 1}\n"
          "  - {kind: kill, at: 5s}\n"
          "  - {kind: enable, at: 6s}\n"
          "  - {kind: move, at: 7s, to: 1, velocity: 2, acceleration: 20}\n"
          "  - {kind: enable, program: leader, axes: [shoulder]}\n"
          "  - {kind: jog, program: leader, at: 3s, velocity: 2, acceleration: 20}\n",
          11s);

  ASSERT_EQ(outcome.motions.size(), 8u);
  EXPECT_EQ(outcome.motions[1].result, "killed");
  EXPECT_NEAR(outcome.motions[1].axes[0].velocity, 2.0, 0.1);
  EXPECT_EQ(outcome.motions[2].result, "not_begun");
  EXPECT_EQ(outcome.motions[3].result, "done");
  EXPECT_EQ(outcome.motions[5].result, "done") << outcome.motions[5].text;
  EXPECT_EQ(outcome.motions[7].result, "stopped");
  EXPECT_THAT(outcome.motions[7].text, HasSubstr("taktd stops")) << "it is the end of the run";
}

TEST_F(SimulatedMotions, AnEndThatTheScriptDoesNotExpectDecidesTheExitCode) {
  const std::string enable = "motions:\n  - {kind: enable, axes: [shoulder]}\n";
  const auto code = [&](const std::string& entries) {
    const SimulationOutcome outcome = run(enable + entries, 5s);
    std::ostringstream text;
    print_text(text, outcome);
    const bool told = text.str().find("NOT `") != std::string::npos;
    EXPECT_EQ(told, unexpected_ends(outcome.motions) != 0) << text.str();
    return exit_code_of(outcome);
  };
  const std::string far = "  - {kind: move, at: 2s, to: 50, velocity: 2, acceleration: 20";
  const std::string jog = "  - {kind: jog, at: 2s, velocity: 1, acceleration: 10";
  const std::string stop = "  - {kind: stop, at: 3s}\n";
  const std::string loss = "faults:\n  - {kind: power_off, node: shoulder, at: 3s, for: 100ms}\n";
  const std::string beyond = "  - {kind: move, at: 2s, to: 500";

  EXPECT_EQ(code("  - {kind: move, at: 2s, to: 1, velocity: 2, acceleration: 20}\n"), 0);
  EXPECT_EQ(code("  - {kind: move, at: 2s, to: 1, expect: stopped}\n"), 1);
  EXPECT_EQ(code(far + "}\n"), 1) << "it does not arrive";
  EXPECT_EQ(code(far + ", expect: ended}\n"), 0);
  EXPECT_EQ(code(far + "}\n" + stop), 1);
  EXPECT_EQ(code(far + ", expect: ended}\n" + stop), 0);
  EXPECT_EQ(code(far + ", expect: stopped}\n" + loss), 0);
  EXPECT_EQ(code(far + ", expect: ended}\n" + loss), 1);
  EXPECT_EQ(code(beyond + "}\n"), 1);
  EXPECT_EQ(code(beyond + ", expect: refused}\n"), 0);
  EXPECT_EQ(code(jog + "}\n"), 0) << "the end of the run is that of a jog";
  EXPECT_EQ(code(jog + "}\n" + stop), 0);
  EXPECT_EQ(code(jog + "}\n" + loss), 1);
  EXPECT_EQ(code(jog + ", expect: stopped}\n" + stop), 1) << "no fault has stopped it";
  EXPECT_EQ(code("  - {kind: stop, at: 9s}\n"), 1) << "it never begins";
}

TEST_F(SimulatedMotions, EqualSeedsGiveEqualResults) {
  const std::string text =
      "motions:\n"
      "  - {kind: enable}\n"
      "  - {kind: move, at: 1s, to: [1, -2], velocity: 2, acceleration: 20}\n"
      "  - {kind: kill, at: 1500ms}\n"
      "  - {kind: enable, at: 2s}\n"
      "faults:\n"
      "  - {kind: loss, probability: 0.001}\n"
      "  - {kind: slow_messages, at: 1s, for: 1s, time: 20ms}\n";
  const auto document = [&](std::uint64_t seed) {
    std::ostringstream out;
    print_json(out, run(text, 4s, seed));
    return out.str();
  };
  const std::string first = document(7);
  EXPECT_EQ(first, document(7));
  EXPECT_NE(first, document(8));
}

TEST_F(SimulatedMotions, ErrorsOfTheFileSayWhereAndWhatWasExpected) {
  const auto only_finding = [&](const std::string& entries) {
    const FaultFile file = read("motions:\n" + entries);
    EXPECT_EQ(file.findings.size(), 1u) << entries;
    return file.findings.empty() ? std::string{} : to_string(file.findings.front());
  };
  EXPECT_THAT(only_finding("  - {kind: mov, to: 1}\n"),
              HasSubstr("motions.yaml:2:12: error: unknown kind `mov`, did you mean `move`?"));
  EXPECT_THAT(only_finding("  - {kind: move, to: fast}\n"),
              HasSubstr(":2:22: error: `fast` is not a number, or a list of 2 numbers"));
  EXPECT_THAT(only_finding("  - {kind: move, to: [1, 2, 3]}\n"),
              HasSubstr("the value of `to` is not a number, or a list of 2 numbers"));
  EXPECT_THAT(only_finding("  - {kind: move, velocity: 1}\n"), HasSubstr("`to` is missing"));
  EXPECT_THAT(only_finding("  - {kind: move, to: 1, by: 2}\n"),
              HasSubstr(":2:25: error: `by` has no meaning for `move`"));
  EXPECT_THAT(only_finding("  - {kind: stop, at: 2}\n"),
              HasSubstr(":2:22: error: `2` is not a time like 500ms"));
  EXPECT_THAT(only_finding("  - {kind: enable, axes: [knee]}\n"),
              HasSubstr("`knee` is no axis that taktd can move: shoulder, elbow"));
  EXPECT_THAT(only_finding("  - {kind: kill}\n"), HasSubstr("`kill` needs a time"));
  EXPECT_THAT(
      only_finding("  - {kind: stop, expect: refuse}\n"),
      HasSubstr(":2:26: error: `refuse` is not an end of a motion, did you mean `refused`?"));
  EXPECT_THAT(only_finding("  - {kind: stop, at: 2s}\n  - {kind: stop, at: 1s}\n"),
              HasSubstr(":3:5: error: `at` is earlier than that of line 2"));
  EXPECT_THAT(only_finding("  - {kind: jog, velocity: 1}\n  - {kind: stop}\n"),
              HasSubstr("the `jog` before does not end by itself"));
  EXPECT_THAT(only_finding("  - {kind: stop, axes: [elbow]}\n  - {kind: stop, axes: [shoulder]}\n"),
              HasSubstr("program `program` commands the axes elbow"));
  EXPECT_THAT(only_finding("  - {kind: stream, points: [{time: 1s, position: 1}]}\n"),
              HasSubstr("a point is a map with `time`, `position` and `velocity`"));
}

class SimulatedSpeeds : public SimulatedMotions {
 protected:
  void use(const std::string& demo) {
    network_ = load_network(TAKT_SOURCE_DIR "/share/demo/" + demo + ".yaml");
  }
  static std::string largest_speed(const MotionOutcome& motion) {
    return fmt::format("{:.0f} {}", motion.axes.at(0).velocity, motion.axes.at(0).unit);
  }
};

TEST_F(SimulatedSpeeds, InvertersRunReverseAndStop) {
  const std::string entries =
      "motions:\n"
      "  - {kind: enable}\n"
      "  - {kind: jog, at: 3s, velocity: 10}\n"
      "  - {kind: jog, at: 8s, velocity: -20}\n"
      "  - {kind: stop, at: 13s}\n"
      "  - {kind: disable}\n";
  for (const auto& [demo, unit] : {std::pair{"astraada_drv28", " Hz"}, {"lenze8400", " %"}}) {
    use(demo);
    const SimulationOutcome outcome = run(entries, 20s);

    ASSERT_EQ(outcome.motions.size(), 5u) << demo;
    EXPECT_EQ(unexpected_ends(outcome.motions), 0u) << demo;
    EXPECT_EQ(outcome.motions[1].result, "replaced");
    EXPECT_EQ(outcome.motions[2].result, "stopped");
    EXPECT_EQ(largest_speed(outcome.motions[1]), std::string{"10"} + unit);
    EXPECT_EQ(largest_speed(outcome.motions[2]), std::string{"20"} + unit);
    EXPECT_GT(*outcome.motions[3].end - *outcome.motions[3].begin, 200ms) << "along the ramp";
    EXPECT_EQ(outcome.axes_moved, 1u);
    std::ostringstream text;
    print_text(text, outcome);
    EXPECT_THAT(text.str(), HasSubstr(std::string{": at most 20"} + unit + "\n"));
  }
}

TEST_F(SimulatedSpeeds, ARefusalAFaultAndAKillEndThem) {
  use("astraada_drv28");
  const SimulationOutcome outcome =
      run("motions:\n"
          "  - {kind: enable}\n"
          "  - {kind: jog, at: 3s, velocity: 51, expect: refused}\n"
          "  - {kind: jog, at: 4s, velocity: 20, expect: stopped}\n"
          "  - {kind: enable, at: 16s}\n"
          "  - {kind: jog, at: 18s, velocity: 20}\n"
          "  - {kind: kill, at: 20s}\n"
          "faults:\n"
          "  - {kind: power_off, node: pump, at: 8s, for: 2s}\n",
          24s);
  ASSERT_EQ(outcome.motions.size(), 6u);
  for (const MotionOutcome& one : outcome.motions) {
    EXPECT_TRUE(one.as_expected()) << one.pos.line << ": " << one.result << ": " << one.text;
  }
  EXPECT_THAT(outcome.motions[1].text, HasSubstr("above the limit"));
  EXPECT_EQ(outcome.motions[4].result, "killed");
  EXPECT_EQ(outcome.front->fallbacks, 1u) << "taktd stops it when its program is dead";
}

TEST_F(SimulatedSpeeds, WhatNeedsAPositionIsAnErrorOfTheFile) {
  const auto only_finding = [&](const std::string& entries) {
    const FaultFile file = read("motions:\n" + entries);
    EXPECT_EQ(file.findings.size(), 1u) << entries;
    return file.findings.empty() ? std::string{} : to_string(file.findings.front());
  };
  use("astraada_drv28");
  EXPECT_THAT(only_finding("  - {kind: move, to: 1}\n"),
              HasSubstr(":2:12: error: `move` needs a position, and `pump` is a speed axis: use "
                        "`jog` and `stop`"));
  EXPECT_THAT(only_finding("  - {kind: jog, velocity: 1, jerk: 2}\n"),
              HasSubstr("`jerk` has no meaning for `jog` of a speed axis"));
  EXPECT_THAT(only_finding("  - {kind: enable, axes: [pomp]}\n"), HasSubstr("pump"));
}

TEST_F(SimulatedMotions, TheDemoIsReadAndRuns) {
  FaultFile file =
      read_fault_file(TAKT_SOURCE_DIR "/share/demo/motions/two_axes.yaml", network_.plan);
  for (const Finding& finding : file.findings) ADD_FAILURE() << to_string(finding);
  const SimulationOutcome outcome = simulate(network_, {.duration = 20s,
                                                        .faults = std::move(file.faults),
                                                        .programs = std::move(file.programs),
                                                        .motions = std::move(file.motions)});
  std::ostringstream text;
  print_text(text, outcome);
  EXPECT_THAT(text.str(), HasSubstr("2 programs with motions; 2 axes moved"));
  EXPECT_THAT(text.str(), HasSubstr("13 of 13 ended as expected"));
  EXPECT_EQ(exit_code_of(outcome), 0);
}

}  // namespace
}  // namespace takt
