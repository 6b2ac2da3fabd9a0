// The plan refuses what a device family can't do and gives the reason from the manual.
#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/print/plan/print_plan.hpp"
#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::compile_device_file;
using testing::HasSubstr;

test::Compiled plan_of(const std::string& eds, const std::string& keys) {
  return compile_device_file(
      "master: {sync_period: 10000}\nx: {node_id: 4, dcf: x, " + keys + "}\n", eds + ".eds");
}

struct Refusal {
  const char* eds;
  const char* keys;
  const char* says;
  const char* reason;
};

const Refusal refusals[] = {
    {"astraada_drv28", "tpdo: {2: {transmission: 0}}", "can't have transmission type 0",
     "synchronous types 1 to 240, 254 (on change) and 255 (answers the RPDO)"},
    {"astraada_drv28", "tpdo: {3: {transmission: 252}}", "can't have transmission type 252",
     "none on remote request"},
    {"astraada_drv28", "tpdo: {4: {transmission: 253}}", "can't have transmission type 253",
     "none on remote request"},
    {"astraada_drv28", "tpdo: {1: {transmission: 1}}", "can't have transmission type 1",
     "PDO1 reads and writes parameters"},
    {"astraada_drv28", "tpdo: {1: {transmission: 254}}", "can't have transmission type 254",
     "it answers each RPDO1, takes no other type than 255"},
    {"astraada_drv28", "tpdo: {1: {transmission: 255, event_timer: 100}}",
     "can't have an event timer (100 ms)", "must not be sent by its event timer"},
    {"astraada_drv28", "rpdo: {1: {transmission: 1}}", "can't have transmission type 1",
     "a request acts when it comes"},
    {"astraada_drv28", "tpdo: {3: {inhibit_time: 490}}", "takes no less than 50 ms",
     "the card raises what is shorter than 50 ms to 50 ms"},
    {"astraada_drv28", "tpdo: {3: {inhibit_time: 1005}}", "counts 1802:03 in 1 ms",
     "sub-index 3 is the disabled time, in ms"},
    {"astraada_drv28", "tpdo: {4: {transmission: 254, poll_ms: 100}}", "can't be polled",
     "none on remote request"},
    {"lenze8400", "rpdo: {1: {transmission: 252}}", "can't have transmission type 252",
     "an RPDO can't be polled"},
    {"lenze8400",
     "firmware: \"15.99\", tpdo: {1: {transmission: 0}}, sdo: [{index: 0x1005, value: 0x40000080}]",
     "firmware 15.99.00 does not send the TPDO in this case", "from version 16.00.00 on"},
    {"lenze8400",
     "firmware: \"16\", tpdo: {1: {transmission: 240}}, sdo: [{index: 0x1005, value: 0x40000080}, "
     "{index: 0x5E8F, value: 0x81}]",
     "produces the SYNC on 0x081, but receives it on 0x080",
     "only where its SYNC Tx and Rx identifiers are the same"},
};

TEST(FamilyRules, RefuseWithTheReasonOfTheManual) {
  for (const Refusal& refusal : refusals) {
    const test::Compiled net = plan_of(refusal.eds, refusal.keys);
    const std::string declared = net.declared("device-data");

    EXPECT_TRUE(has_error(net.findings)) << refusal.keys;
    EXPECT_THAT(declared, HasSubstr(refusal.says)) << refusal.keys;
    EXPECT_THAT(declared, HasSubstr(refusal.reason)) << refusal.keys;
    EXPECT_THAT(declared, HasSubstr(std::string{refusal.eds} + ".yaml:")) << refusal.keys;
  }
}

TEST(FamilyRules, ReportWhichTypesAreReserved) {
  for (const char* eds : {"lenze8400", "beckhoff_io", "plain301", "astraada_drv28"}) {
    for (int type = 241; type <= 251; ++type) {
      const std::string keys = "tpdo: {2: {transmission: " + std::to_string(type) + "}}";
      const test::Compiled net = plan_of(eds, keys);
      EXPECT_TRUE(has_error(net.findings)) << eds << " " << type;
      EXPECT_THAT(net.declared("device-data"),
                  HasSubstr("can't have transmission type " + std::to_string(type)))
          << eds;
    }
  }
}

TEST(FamilyRules, TakeEachTypeThatAManualHas) {
  for (const char* eds : {"lenze8400", "beckhoff_io", "plain301", "astraada_drv28"}) {
    for (const int type : {0, 1, 2, 240, 252, 253, 254, 255}) {
      const bool lacking =
          std::string_view{eds} == "astraada_drv28" && (type == 0 || type == 252 || type == 253);
      const test::Compiled net =
          plan_of(eds, "tpdo: {2: {transmission: " + std::to_string(type) + "}}");
      EXPECT_EQ(has_error(net.findings), lacking) << eds << " " << type;
    }
  }
}

TEST(FamilyRules, AskForTheFirmwareOfALenzeThatMakesTheSync) {
  const std::string producer =
      "tpdo: {1: {transmission: 1}}, sdo: [{index: 0x1005, value: 0x40000080}]";
  EXPECT_EQ(plan_of("lenze8400", producer).declared("device-data"), "") << "the EDS tells: 16.00";
  const test::Compiled newer = plan_of("lenze8400", producer + ", firmware: \"17.3\"");
  EXPECT_FALSE(has_error(newer.findings));
}

/// The default in the manual is "Disabled time (ms) 500".
TEST(FamilyRules, ReadTheDisabledTimeOfADrv28InMillisecondsWhereTheFileIsSilent) {
  const test::Compiled net = plan_of("astraada_drv28", "tpdo: {3: {transmission: 254}}");

  const auto& rows = net.plan.pdos.tpdos;
  const auto row = std::ranges::find(rows, 3, &PdoRow::number);
  ASSERT_NE(row, rows.end());
  EXPECT_EQ(row->inhibit, 500ms);
}

TEST(FamilyRules, KnowWhatTerminalsDoWithoutSync) {
  const test::Compiled net = plan_of("beckhoff_io", "tpdo: {1: {transmission: 1}}");
  EXPECT_EQ(net.plan.nodes.at(0).on_sync_loss, "the outputs react as their device profile says");
}

std::string printed_plan(const std::string& demo) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/" + demo + ".yaml");
  std::ostringstream text;
  print_plan_text(text, network.plan, {.node = {}, .realtime = {}, .lcm = {}});
  return text.str();
}

TEST(FamilyRules, AreInThePlanOfEachDemo) {
  const std::string lenze = printed_plan("lenze8400");
  EXPECT_THAT(lenze, HasSubstr("TPDO1..4: types 0..240, 252, 253, 254, 255"));
  EXPECT_THAT(
      lenze,
      HasSubstr("event timers send in addition to changes; a change does not restart the timer"));
  EXPECT_THAT(lenze, HasSubstr("firmware 16.00.00"));

  const std::string terminals = printed_plan("beckhoff");
  EXPECT_THAT(terminals, HasSubstr("TPDOs: types 0..240, 252, 253, 254, 255"));

  EXPECT_THAT(printed_plan("plain301"), HasSubstr("TPDOs: types 0..240, 252, 253, 254, 255"));

  const std::string pump = printed_plan("astraada_drv28");
  EXPECT_THAT(pump, HasSubstr("TPDO1: types 255, no event timer, no remote requests, the parameter "
                              "channel"));
  EXPECT_THAT(pump, HasSubstr("TPDO2..4: types 1..240, 254, 255, no remote requests"));
  EXPECT_THAT(pump, HasSubstr("inhibit times in steps of 1 ms, at least 50 ms, 500 ms by default"));
  EXPECT_THAT(pump, HasSubstr("with an event timer, a change sends no PDO"));
}

}  // namespace
}  // namespace takt
