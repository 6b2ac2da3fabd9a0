#include "apps/logic/logic_program.hpp"

#include <array>
#include <chrono>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <optional>
#include <utility>

#include "apps/logic/logic_trace.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

signal_t signal(const char* node, std::int16_t id, const char* name, std::int32_t index,
                bool output) {
  signal_t made{};
  made.node = node;
  made.node_id = id;
  made.name = name;
  made.index = index;
  made.output = output ? 1 : 0;
  made.bits = 16;
  made.scale = 1.0;
  return made;
}

/// Reads rules from a text and runs them cycle by cycle, on a bus with an axis and an I/O module.
class Logic : public ::testing::Test {
 protected:
  Logic() {
    layout_t layout{};
    layout.schema = 2;
    layout.parts = 1;
    layout.session = 1;
    layout.period_ns = 10'000'000;
    layout.signals = {signal("io", 10, "in", 0x6000, false),
                      signal("io", 10, "level", 0x6401, false),
                      signal("shoulder", 1, "statusword", 0x6041, false),
                      signal("io", 10, "out", 0x6200, true),
                      signal("io", 10, "valve", 0x6411, true),
                      signal("shoulder", 1, "controlword", 0x6040, true)};
    layout.signals[1].unit = layout.signals[4].unit = "V";
    layout.signals[1].scale = layout.signals[4].scale = 0.001;
    layout.num_signals = layout.total_signals = 6;
    layout.inputs = 3;
    input_.take(layout);
  }
  /// Returns what is wrong with these rules.
  std::string load(const std::string& rules) {
    Findings findings;
    std::vector<Rule> read = read_rules("rules:\n" + rules, "rules.yaml", findings);
    const std::array<std::int16_t, 1> axes{1};
    if (findings.empty()) {
      program_.emplace(std::move(read), input_.signals(), axes, "rules.yaml", findings);
    }
    std::string text;
    for (const Finding& finding : findings) text += to_string(finding) + "\n";
    return text;
  }
  /// One cycle of 10 ms with these inputs. Returns the digital outputs.
  std::int64_t step(std::int64_t in, std::int64_t level = 0, std::int64_t status = 0x27,
                    bool missing = false) {
    image_t image{};
    image.schema = 2;
    image.parts = 1;
    image.session = 1;
    image.cycle = ++cycle_;
    image.values = {in, level, status, 0, 0, 0};
    image.num_values = 6;
    if (missing) {
      image.stale = {0};
      image.num_stale = 1;
    }
    EXPECT_TRUE(input_.take(image));
    program_->step(input_, 10ms);
    return program_->outputs().empty() ? 0 : program_->outputs().front().raw;
  }

  ImageInput input_;
  std::optional<LogicProgram> program_;
  std::int64_t cycle_ = 0;
};

TEST_F(Logic, SetsBitsByInputs) {
  ASSERT_EQ(load("  - {set: io.out.0, when: io.in.1 and not shoulder.fault}\n"
                 "  - {set: io.out.3, when: io.level > 2.5}\n"),
            "");
  EXPECT_EQ(step(0b00), 0b0000);
  EXPECT_EQ(step(0b10), 0b0001);
  EXPECT_EQ(step(0b10, 0, 0x08), 0b0000) << "the drive is in fault";
  EXPECT_EQ(step(0b10, 2600), 0b1001) << "2.6 V";
}

TEST_F(Logic, DelaysBothWays) {
  ASSERT_EQ(load("  - {set: io.out.0, when: io.in.0, on_delay: 30ms, off_delay: 20ms}\n"), "");
  EXPECT_EQ(step(1), 0);
  EXPECT_EQ(step(1), 0);
  EXPECT_EQ(step(0), 0) << "too short";
  for (int i = 0; i < 3; ++i) EXPECT_EQ(step(1), 0) << i;
  EXPECT_EQ(step(1), 1) << "30 ms after the edge";
  EXPECT_EQ(step(0), 1);
  EXPECT_EQ(step(0), 1);
  EXPECT_EQ(step(0), 0);
}

TEST_F(Logic, LatchesUntilItIsReset) {
  ASSERT_EQ(load("  - {latch: io.out.0, on: rising(io.in.0), off: io.in.1}\n"), "");
  EXPECT_EQ(step(0b01), 1);
  EXPECT_EQ(step(0b00), 1);
  EXPECT_EQ(step(0b11), 0) << "off wins";
  EXPECT_EQ(step(0b01), 0) << "no edge";
}

TEST_F(Logic, CountsEdges) {
  ASSERT_EQ(load("  - {count: parts, when: io.in.0, reset: io.in.1}\n"
                 "  - {set: io.out.0, when: parts >= 2}\n"),
            "");
  EXPECT_EQ(step(1), 0);
  EXPECT_EQ(step(1), 0);
  EXPECT_EQ(step(0), 0);
  EXPECT_EQ(step(1), 1);
  EXPECT_EQ(program_->value(0), 2.0);
  EXPECT_EQ(step(0b10), 0);
}

/// Rules that refer to each other see the marker of a later rule one image later.
TEST_F(Logic, RunsRulesThatReferToEachOther) {
  ASSERT_EQ(load("  - {set: io.out.0, when: not blink}\n  - {set: blink, when: io.out.0}\n"), "");
  EXPECT_EQ(step(0), 1);
  EXPECT_EQ(step(0), 0);
  EXPECT_EQ(step(0), 1);
}

TEST_F(Logic, IsOffWhereAnInputIsMissing) {
  ASSERT_EQ(load("  - {set: io.out.0, when: not io.in.0}\n"
                 "  - {latch: io.out.1, on: io.in.1, off: io.in.2}\n"),
            "");
  EXPECT_EQ(step(0b10), 0b11);
  EXPECT_EQ(step(0b10, 0, 0x27, true), 0b00);
  EXPECT_EQ(step(0b00), 0b01);
}

TEST_F(Logic, DrawsInputsAndTargets) {
  ASSERT_EQ(load("  - {set: io.out.0, when: io.in.1}\n"), "");
  LogicTrace trace;
  for (const int in : {0b00, 0b10, 0b10, 0b00}) {
    step(in);
    trace.take(static_cast<double>(cycle_) * 0.01, program_->values(input_));
  }
  const Plot plot = trace.plot("test", program_->names());
  ASSERT_EQ(plot.panels.size(), 2U);
  EXPECT_EQ(plot.panels[0].quantity, "io.in.1");
  EXPECT_EQ(plot.panels[1].quantity, "io.out.0");
  EXPECT_THAT(plot.panels[1].curves.front().values, ::testing::ElementsAre(0, 0, 1, 1, 0, 0));
  EXPECT_THAT(plot.times, ::testing::ElementsAre(0.01, 0.02, 0.02, 0.04, 0.04, 0.04));
  for (std::size_t i = 0; i < 2 * LogicTrace::most_changes; ++i) {
    trace.take(1.0, {i % 2 == 0 ? 1.0 : 0.0, 0.0});
  }
  EXPECT_EQ(trace.plot("test", {}).times.size(), 2 * LogicTrace::most_changes);
}

/// A device gets an RPDO only if each output in it has a value.
TEST_F(Logic, SetsTheOtherOutputsOfTheNodeToZero) {
  ASSERT_EQ(load("  - {set: io.out.0, when: true}\n"), "");
  step(0);
  ASSERT_EQ(program_->outputs().size(), 2U);
  EXPECT_EQ(program_->outputs()[1].signal, 4U) << "io.valve";
  EXPECT_EQ(program_->outputs()[1].raw, 0);
}

TEST_F(Logic, SetsValuesInTheUnitOfTheOutput) {
  ASSERT_EQ(load("  - {set: io.valve, when: io.in.0, value: 2.5, else: 0.5}\n"), "");
  EXPECT_EQ(step(1), 2500);
  EXPECT_EQ(step(0), 500);
}

TEST_F(Logic, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(load("  - {set: io.out.0, when: io.inn.0}\n"),
              HasSubstr("rules.yaml:2:27: error: the bus has no signal `io.inn.0`"));
  EXPECT_THAT(load("  - {set: io.oot, when: true}\n"), HasSubstr("did you mean `io.out`?"));
  EXPECT_THAT(load("  - {set: io.in.0, when: true}\n"), HasSubstr("2:11: error: `io.in.0` is an "));
  EXPECT_THAT(load("  - {set: io.out.16, when: true}\n"), HasSubstr("no output `io.out.16`"));
  EXPECT_THAT(load("  - {set: shoulder.controlword, when: true}\n"), HasSubstr("is an axis"));
  EXPECT_THAT(load("  - {set: io.out, when: true, value: 70000}\n"), HasSubstr("does not fit"));
  EXPECT_THAT(load("  - {set: io.out, when: true}\n  - {set: io.out.1, when: true}\n"),
              HasSubstr("3:11: error: other rules set all of this output"));
}

TEST_F(Logic, SaysWhatIsWrongWithTheFile) {
  EXPECT_THAT(load("  - {set: a, when: b and}\n"), HasSubstr("rules.yaml:2:"));
  EXPECT_THAT(load("  - {set: a, wen: b}\n"), HasSubstr("did you mean `when`?"));
  EXPECT_THAT(load("  - {set: a, when: b}\n  - {set: a, when: b}\n"),
              HasSubstr("3:11: error: line 2 sets `a` already"));
  EXPECT_THAT(load("  - {latch: a, on: b}\n"), HasSubstr("`off` is missing"));
  EXPECT_THAT(load("  - {when: b}\n"), HasSubstr("one of `set`, `latch` and `count` is missing"));
  EXPECT_THAT(load("  - {set: a, latch: b, when: c}\n"), HasSubstr("a rule has one of"));
  EXPECT_THAT(load("  - {set: a, when: b, on_delay: -1s}\n"), HasSubstr("a delay is a time"));
  EXPECT_THAT(load("  - {count: io.out, when: b}\n"), HasSubstr("`count` needs a marker"));
  EXPECT_THAT(load("  - 5\n"), HasSubstr("a rule is a map"));
  EXPECT_THAT(load("  []\n"), HasSubstr("there is no rule"));
}

TEST_F(Logic, RefusesHostileFiles) {
  std::string many;
  for (int i = 0; i < 1001; ++i) many += "  - {set: m" + std::to_string(i) + ", when: true}\n";
  EXPECT_THAT(load(many), HasSubstr("more than 1000 rules"));
  EXPECT_NE(load("  - " + std::string(100'000, '[')), "");
  EXPECT_NE(load("  - &a {set: b, when: *a}\n"), "");
  EXPECT_NE(load(std::string(2'000'000, ' ') + "- 1"), "");
}

}  // namespace
}  // namespace takt
