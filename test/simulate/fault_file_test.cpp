#include "apps/takt/simulate/fault_file.hpp"

#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <set>

#include "apps/command_line/duration.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

class FaultFileTest : public testing::Test {
 protected:
  FaultFile read(const std::string& text, std::size_t applications = 0) {
    plan_.nodes.push_back({.name = "elbow", .id = 2_node});
    return read_fault_file(folder_.write("faults.yaml", text), plan_, applications);
  }

  const test::Folder folder_;
  BusPlan plan_;
};

TEST_F(FaultFileTest, ReadsEveryKey) {
  const FaultFile file = read(
      "faults:\n"
      "  - {kind: power_off, node: elbow, at: 2s, for: 500ms}\n"
      "  - {kind: override_value, node: 2, object: 1018:01, value: 0x43}\n"
      "  - {kind: babble, cob_id: 0x7F, data: 01FF, time: 100us, at: 1s, until: 2s}\n"
      "  - {kind: refuse_object, object: 0x1A00:0, abort_code: 0x06010002}\n"
      "  - {kind: drift, ppm: -200}\n"
      "  - {kind: error_frames, probability: 0.25}\n"
      "  - {kind: device_error, emcy_code: 0x3210}\n");

  for (const Finding& finding : file.findings) ADD_FAILURE() << to_string(finding);
  ASSERT_EQ(file.faults.size(), 7u);
  EXPECT_EQ(file.faults[0].kind, sim::FaultKind::power_off);
  EXPECT_EQ(file.faults[0].node, 2_node);
  EXPECT_EQ(file.faults[0].at, 2s);
  EXPECT_EQ(file.faults[0].until, 2500ms);
  EXPECT_EQ(file.faults[1].object, (ObjectKey{0x1018, 1}));
  EXPECT_EQ(file.faults[1].value[0], std::byte{0x43});
  EXPECT_EQ(file.faults[2].cob_id, CobId::base(0x7F));
  EXPECT_EQ(file.faults[2].value, (std::vector{std::byte{0x01}, std::byte{0xFF}}));
  EXPECT_EQ(file.faults[2].until, 2s);
  EXPECT_EQ(file.faults[3].object, (ObjectKey{0x1A00, 0}));
  EXPECT_EQ(file.faults[3].abort_code, 0x0601'0002u);
  EXPECT_EQ(file.faults[4].ppm, -200);
  EXPECT_EQ(file.faults[5].probability, 0.25);
  EXPECT_EQ(file.faults[6].emcy_code, 0x3210);
}

TEST_F(FaultFileTest, ListsAllErrorsWithTheirLines) {
  const FaultFile file = read(
      "faults:\n"
      "  - {kind: power_of, node: knee}\n"
      "  - {node: 2, at: 2}\n"
      "  - {kind: loss, probability: 1.5, objekt: 1018}\n"
      "  - {kind: babble, data: 0x1}\n");

  ASSERT_EQ(file.findings.size(), 7u);
  EXPECT_EQ(file.findings[0].pos.line, 2u);
  EXPECT_TRUE(file.findings[0].message.contains("power_off")) << file.findings[0].message;
  EXPECT_EQ(file.findings[1].pos.line, 2u);
  EXPECT_EQ(file.findings[2].pos.line, 3u);
  EXPECT_EQ(file.findings[4].pos.line, 4u);
  EXPECT_TRUE(file.findings[5].message.contains("object")) << file.findings[5].message;
  EXPECT_EQ(file.findings[6].pos.line, 5u);
}

TEST_F(FaultFileTest, ReadsWhatHappensToPrograms) {
  const FaultFile file = read(
      "faults:\n"
      "  - {kind: kill_application, application: 2, at: 2s, for: 500ms}\n"
      "  - {kind: replay, at: 3s, until: 4s, time: 50ms}\n"
      "  - {at: 1s, kind: stall_front}\n"
      "  - {kind: power_off, at: 1s, for: 1s}\n",
      2);

  for (const Finding& finding : file.findings) ADD_FAILURE() << to_string(finding);
  ASSERT_EQ(file.programs.size(), 3u);
  EXPECT_EQ(file.programs[0].kind, ProgramFaultKind::kill_application);
  EXPECT_EQ(file.programs[0].application, 1u);
  EXPECT_EQ(file.programs[0].until, 2500ms);
  EXPECT_EQ(file.programs[1].time, 50ms);
  EXPECT_EQ(file.programs[1].until, 4s);
  EXPECT_EQ(file.programs[2].at, 1s);
  EXPECT_EQ(file.programs[2].until, never);
  ASSERT_EQ(file.faults.size(), 1u);
  EXPECT_EQ(file.faults[0].until, 2s);
}

TEST_F(FaultFileTest, RefusesWhatCanNotHappenToPrograms) {
  for (const char* text : {"kind: kill_application, application: 0", "kind: replay, time: 0us",
                           "kind: kill_application, application: 3", "kind: replay, time: 2h",
                           "kind: stall_front, application: 1", "kind: stall_front, node: elbow",
                           "kind: stall_front, at: soon", "kind: kill_aplication"}) {
    const FaultFile file = read("faults:\n  - {" + std::string{text} + "}\n", 2);
    ASSERT_EQ(file.findings.size(), 1u) << text;
    EXPECT_EQ(file.findings[0].pos.line, 2u);
  }
  const FaultFile alone = read("faults:\n  - {kind: stall_front, at: 1s}\n");
  ASSERT_EQ(alone.findings.size(), 1u);
  EXPECT_TRUE(alone.findings[0].message.contains("--applications")) << alone.findings[0].message;
}

/// Returns the YAML block of a text file.
std::string yaml_block(const std::string& path) {
  std::ifstream in{path};
  std::string block;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("```")) {
      inside = line == "```yaml";
    } else if (inside) {
      block += line + "\n";
    }
  }
  return block;
}

TEST_F(FaultFileTest, ReadsEveryLineOfItsDescriptionWhichHasEveryKind) {
  const std::string block = yaml_block(TAKT_SOURCE_DIR "/share/doc/faults.md");
  const FaultFile file = read(block, 2);

  for (const Finding& finding : file.findings) ADD_FAILURE() << to_string(finding);
  std::set<std::string_view> reported;
  for (const sim::Fault& fault : file.faults) reported.insert(sim::name(fault.kind));
  std::size_t kinds = 0;
  for (unsigned kind = 0; sim::name(static_cast<sim::FaultKind>(kind)) != "unknown"; ++kind) {
    EXPECT_TRUE(reported.contains(sim::name(static_cast<sim::FaultKind>(kind))))
        << sim::name(static_cast<sim::FaultKind>(kind)) << " is not described";
    ++kinds;
  }
  EXPECT_EQ(kinds, 31u);
  EXPECT_EQ(reported.size(), kinds);
  std::set<std::string_view> programs;
  for (const ProgramFault& fault : file.programs) programs.insert(name(fault.kind));
  for (const std::string_view kind : program_fault_names()) {
    EXPECT_TRUE(programs.contains(kind)) << kind << " is not described";
  }
  EXPECT_EQ(file.faults.size() + file.programs.size(),
            static_cast<std::size_t>(std::ranges::count(block, '{')))
      << "one on each line";
}

TEST_F(FaultFileTest, SurvivesWhatIsNoFaultFile) {
  for (const char* text :
       {"", "[]", "faults: 3", "faults: [[1]]", "a: [", "faults: [{kind: [1]}]", "\xFF\xFE\x00"}) {
    EXPECT_TRUE(has_error(read(text).findings)) << text;
  }
  for (const char* path : {"/nonexistent/faults.yaml", "/tmp"}) {
    EXPECT_TRUE(has_error(read_fault_file(path, plan_).findings)) << path;
  }
}

TEST(Duration, IsOfSecondsWithoutAUnit) {
  EXPECT_EQ(parse_duration("10s"), 10s);
  EXPECT_EQ(parse_duration("1.5ms"), 1500us);
  EXPECT_EQ(parse_duration("2min"), 120s);
  EXPECT_EQ(parse_duration("2m"), 120s);
  EXPECT_EQ(parse_duration("1h"), 3600s);
  EXPECT_EQ(parse_duration("10"), 10s);
  EXPECT_EQ(parse_duration("0.25"), 250ms);
  for (const char* text : {"", "ms", "s", "-1s", "10 s", "10s ", "1e99h", "nans", "infs"}) {
    EXPECT_EQ(parse_duration(text), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace takt
