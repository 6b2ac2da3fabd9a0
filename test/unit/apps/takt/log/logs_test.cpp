#include <csignal>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

#include "apps/takt/log/csv_log.hpp"
#include "apps/takt/log/log_file.hpp"
#include "apps/takt/log/log_schemas.hpp"
#include "apps/takt/log/mcap_log.hpp"

namespace takt::logging {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class MemorySink final : public mcap::ByteSink {
 public:
  bool reserve(std::uint64_t) override { return true; }
  bool write(std::string_view more) override {
    bytes += more;
    return true;
  }
  std::string bytes;
};

LogHead demo_head() {
  LogHead head{.bus = "demo", .period = std::chrono::milliseconds{2}};
  head.signals.push_back({.node = "shoulder",
                          .name = "statusword",
                          .object = {0x6041, 0},
                          .format = {.type = DataType::unsigned16, .bits = 16}});
  head.signals.push_back({.node = "elbow",
                          .name = "position_actual_value",
                          .object = {0x6064, 0},
                          .unit = "rad",
                          .format = {.type = DataType::integer32, .bits = 32, .scale = 1e-3}});
  head.signals.push_back({.node = "shoulder",
                          .name = "torque, \"net\"",
                          .object = {0x2000, 1},
                          .format = {.type = DataType::real32, .bits = 32}});
  return head;
}

/// The rows of a test, which keep their values.
struct Row {
  std::vector<std::int64_t> raw;
  std::vector<std::uint8_t> fresh{1, 1, 1};

  LogRow at(std::int64_t cycle, std::int64_t lost = 0) const {
    return {.utime = 1'700'000'000'000'000 + cycle * 2000,
            .sync_ns = 5'000'000'000 + cycle * 2'000'000,
            .cycle = cycle,
            .lost = lost,
            .raw = raw,
            .fresh = fresh};
  }
};

constexpr std::int64_t half = 0x3F000000;  // 0.5 as REAL32
constexpr std::int64_t not_a_number = 0x7FC00000;

TEST(CsvLog, HasUnitsInTheHeadAndOneLineForEachCycle) {
  MemorySink sink;
  CsvLog log{sink, demo_head()};
  EXPECT_TRUE(log.row(Row{{0x1237, -1234, half}}.at(10)));
  EXPECT_TRUE(log.row(Row{{0x1237, 7, not_a_number}, {0, 1, 1}}.at(11)));
  EXPECT_TRUE(log.finish());
  EXPECT_EQ(sink.bytes,
            "time [s],utime [us],cycle,shoulder.statusword,elbow.position_actual_value [rad],"
            "\"shoulder.torque, \"\"net\"\"\",event\n"
            "0.000000000,1700000000020000,10,4663,-1.234,0.5,\n"
            "0.002000000,1700000000022000,11,,0.007,,\n");
}

TEST(CsvLog, AnEventIsInTheNextLine) {
  MemorySink sink;
  CsvLog log{sink, demo_head()};
  const Row row{{1, 2, half}};
  log.row(row.at(1));
  log.event({.cycle = 1, .severity = 2, .node = "elbow", .text = "EMCY 0x8130, \"life\"\nguard"});
  log.event({.cycle = 2, .text = "ready"});
  log.row(row.at(2));
  log.row(row.at(5, 2));
  log.event({.cycle = 6, .severity = 1, .text = "late"});
  log.finish();
  EXPECT_THAT(sink.bytes, HasSubstr(",2,1,0.002,0.5,\"cycle 1: error: elbow: EMCY 0x8130, "
                                    "\"\"life\"\"?guard | cycle 2: note: ready\"\n"));
  EXPECT_THAT(sink.bytes, HasSubstr(",5,1,0.002,0.5,cycle 5: warning: 2 cycles are missing before "
                                    "cycle 5\n"));
  EXPECT_TRUE(sink.bytes.ends_with(",5,,,,cycle 6: warning: late\n"));
}

TEST(CsvLog, EventsThatNoLineFollowsAreBounded) {
  MemorySink sink;
  CsvLog log{sink, demo_head()};
  for (int i = 0; i < 100'000; ++i) log.event({.cycle = i, .text = "again"});
  log.row(Row{{1, 2, half}}.at(1));
  log.finish();
  EXPECT_THAT(sink.bytes, HasSubstr("| and 99900 more\n"));
  EXPECT_LT(sink.bytes.size(), 10'000U);
}

TEST(McapLog, ARowIsAnObjectForEachNode) {
  MemorySink sink;
  McapLog log{sink, demo_head(), FrameChannelUse::none};
  EXPECT_TRUE(log.row(Row{{0x1237, -1234, half}}.at(10)));
  EXPECT_TRUE(log.row(Row{{0x1237, 7, not_a_number}, {0, 1, 1}}.at(11)));
  EXPECT_TRUE(log.finish());
  EXPECT_THAT(sink.bytes, HasSubstr(R"({"cycle":10,"elbow":{"position_actual_value":-1.234},)"
                                    R"("shoulder":{"statusword":4663,"torque, \"net\"":0.5}})"));
  EXPECT_THAT(sink.bytes,
              HasSubstr(R"({"cycle":11,"elbow":{"position_actual_value":0.007},"shoulder":{}})"));
  EXPECT_THAT(sink.bytes, HasSubstr("/demo/image"));
}

TEST(McapLog, AnEventIsALogOfFoxglove) {
  MemorySink sink;
  McapLog log{sink, demo_head(), FrameChannelUse::none};
  log.event({.utime = 1'700'000'000'000'005,
             .cycle = 3,
             .severity = 2,
             .node = "elbow",
             .kind = "emcy",
             .text = "EMCY \"0x8130\"\xFF"});
  log.finish();
  EXPECT_THAT(sink.bytes,
              HasSubstr(R"({"timestamp":{"sec":1700000000,"nsec":5000},"level":4,)"
                        R"("message":"EMCY \"0x8130\"?","name":"elbow","file":"emcy","line":3})"));
}

TEST(McapLog, TheSchemaHasTypesAndUnits) {
  const LogHead head = demo_head();
  const auto schema = image_schema(head.signals);
  EXPECT_EQ(schema["type"], "object");
  EXPECT_EQ(schema["properties"]["cycle"]["type"], "integer");
  const auto& position = schema["properties"]["elbow"]["properties"]["position_actual_value"];
  EXPECT_EQ(position["type"], "number");
  EXPECT_EQ(position["description"], "6064:00, rad");
  const auto& word = schema["properties"]["shoulder"]["properties"]["statusword"];
  EXPECT_EQ(word["type"], "integer");
  EXPECT_EQ(event_schema()["properties"]["level"]["oneOf"][4]["title"], "ERROR");
  EXPECT_EQ(event_schema()["properties"]["level"]["oneOf"][4]["const"], 4);
}

TEST(McapLog, ANodeMayBeNamedCycle) {
  LogHead head = demo_head();
  head.signals[0].node = "cycle";
  EXPECT_EQ(cycle_field(head.signals), "cycle_");
  EXPECT_EQ(cycle_field(demo_head().signals), "cycle");
}

class LogFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "takt_log_XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ / name; }
  std::string content(const std::string& name) const {
    std::ostringstream out;
    out << std::ifstream{path(name), std::ios::binary}.rdbuf();
    return out.str();
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator{folder_}, {}));
  }

  std::filesystem::path folder_;
};

TEST_F(LogFileTest, HasItsNameWhenItIsComplete) {
  auto file = LogFile::create(path("a.csv"));
  ASSERT_TRUE(file) << file.error();
  EXPECT_TRUE((*file)->reserve(1 << 20));
  EXPECT_TRUE((*file)->write("12345"));
  EXPECT_FALSE(std::filesystem::exists(path("a.csv")));
  EXPECT_TRUE((*file)->commit());
  file->reset();
  EXPECT_EQ(content("a.csv"), "12345");
  EXPECT_EQ(files(), 1U);
}

TEST_F(LogFileTest, WithoutCommitThereIsNone) {
  {
    EXPECT_TRUE((*LogFile::create(path("a.csv")))->write("12345"));
  }
  EXPECT_EQ(files(), 0U);
}

TEST_F(LogFileTest, SaysWhyItCanNotBeMade) {
  const auto missing = LogFile::create(path("none/a.csv"));
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error(), HasSubstr("none/a.csv: can't be written: No such file"));
  EXPECT_THAT(LogFile::create(folder_).error(), HasSubstr("is a directory"));
}

/// The limit of the size of files stands for a full disk.
TEST_F(LogFileTest, AFullDiskLeavesWhatWasWrittenBefore) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{.rlim_cur = 1000, .rlim_max = before.rlim_max};
  auto file = LogFile::create(path("a.csv"));
  ASSERT_TRUE(file) << file.error();
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_TRUE((*file)->write(std::string(900, 'a')));
  EXPECT_FALSE((*file)->reserve(101));
  EXPECT_TRUE((*file)->reserve(100));
  EXPECT_FALSE((*file)->write(std::string(101, 'b')));
  EXPECT_EQ((*file)->trouble(), "File too large");
  EXPECT_TRUE((*file)->write(std::string(100, 'c')));
  EXPECT_TRUE((*file)->commit());
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_EQ(content("a.csv"), std::string(900, 'a') + std::string(100, 'c'));
}

}  // namespace
}  // namespace takt::logging
