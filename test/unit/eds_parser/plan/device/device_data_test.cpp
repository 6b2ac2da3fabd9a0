#include "eds_parser/specification/device_data.hpp"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>

#include "eds_parser/network_file/keys/read_devices.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/print/plan/print_plan.hpp"
#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using test::compile_device_file;
using test::drv28;
using test::read_entry;
using test::shipped_device_data;

using Complaints = std::vector<std::string>;

TEST(DeviceData, HasAnEntryForEachFamily) {
  std::vector<std::string> ids;
  for (const DeviceData& entry : shipped_device_data()) ids.push_back(entry.id);

  EXPECT_EQ(ids, (std::vector<std::string>{
                     "astraada_drv28", "beckhoff_box", "beckhoff_io", "delta_asda", "elmo",
                     "kostal_inveor", "lenze8400", "lenze9400", "lenze_plc_designer", "lexium32a",
                     "nxp_lpc_boot", "plain301", "schunk", "technosoft", "toshiba_vfs15"}));
}

TEST(DeviceData, ReadsAnEntry) {
  Findings findings;
  const auto entry = read_entry(
      "name: My drive\n"
      "manual: page 7\n"
      "match: {vendor_id: 0x3B, product_code: [1, 4], revision: 2}\n"
      "tpdo:\n"
      "  - {numbers: [2, 4], transmission: [[1, 240], 255], reason: because}\n"
      "inhibit_time: {unit_us: 1000, least: 50}\n"
      "event_timer: {meaning: alone}\n"
      "sync_producer: {own_tpdos_from: \"16.00.00\"}\n"
      "objects: [{index: 0x1800, sub_index: 5, access: ro, firmware_below: \"2.1\"}]\n"
      "boot: {reset: node, values_after_pdos: true, pause_after_bootup_ms: 300}\n"
      "emcy: {0x2310: too much current}\n",
      findings);

  ASSERT_TRUE(entry);
  EXPECT_TRUE(findings.empty());
  EXPECT_EQ(entry->id, "my_drive");
  ASSERT_EQ(entry->matches.size(), 1u);
  EXPECT_EQ(entry->matches[0].revision.low, 2u);
  EXPECT_EQ(entry->matches[0].revision.high, 2u);
  ASSERT_NE(entry->rule(true, 3), nullptr);
  EXPECT_EQ(entry->rule(true, 3)->types.size(), 2u);
  EXPECT_EQ(entry->rule(true, 3)->fact.pos.line, 5u);
  EXPECT_EQ(entry->rule(true, 1), nullptr);
  EXPECT_EQ(entry->rule(false, 3), nullptr);
  EXPECT_EQ(entry->inhibit.unit_us, 1000u);
  EXPECT_EQ(entry->timer.meaning, TimerMeaning::alone);
  EXPECT_EQ(entry->sync.own_tpdos_from, (Firmware{{16, 0, 0}}));
  EXPECT_EQ(entry->objects.at(0).access, Access::ro);
  EXPECT_EQ(entry->objects.at(0).below, (Firmware{{2, 1, 0}}));
  EXPECT_EQ(entry->boot.reset, ResetPolicy::node);
  EXPECT_EQ(entry->emcy.at(0).text, "too much current");
}

TEST(DeviceData, ListsAllErrorsOfAnEntryWithTheirLines) {
  Findings findings;
  const auto entry = read_entry(
      "match: {product_code: [4, 1]}\n"
      "tpdo:\n"
      "  - {transmision: [1]}\n"
      "inhibit_time: {unit_us: 0}\n"
      "sync_producer: {own_tpdos_from: new}\n"
      "objects: [{index: 0x1800}]\n",
      findings);

  EXPECT_FALSE(entry);
  Complaints lines;
  for (const Finding& finding : findings) {
    lines.push_back(std::to_string(finding.pos.line) + " " + std::string{finding.rule});
  }
  EXPECT_EQ(lines, (Complaints{"1 out-of-range", "1 missing-key", "3 unknown-key", "4 out-of-range",
                               "5 not-a-version", "6 missing-key", "1 missing-key"}));
}

TEST(DeviceData, NamesTheEntryThatWasApplied) {
  const auto net = drv28("tpdo: {2: {transmission: 1}}");

  EXPECT_EQ(net.complaints(), Complaints{});
  EXPECT_EQ(net.plan.nodes.at(0).device_data, "Astraada DRV-28");
  EXPECT_EQ(net.plan.nodes.at(0).device_data_file, "astraada_drv28.yaml");
}

TEST(DeviceData, IsChosenByNameWhereTheNetworkFileNamesIt) {
  const std::string node = "pump: {node_id: 4, dcf: x, ";
  const auto none = compile_device_file(node + "device: none}\n", "astraada_drv28.eds");
  const auto other = compile_device_file(node + "device: lenze8400}\n", "astraada_drv28.eds");
  const auto wrong = compile_device_file(node + "device: lense8400}\n", "astraada_drv28.eds");

  EXPECT_EQ(none.plan.nodes.at(0).device_data, "");
  EXPECT_EQ(other.plan.nodes.at(0).device_data, "Lenze 8400");
  EXPECT_EQ(wrong.complaints(), Complaints{"1:36 error [unknown-value]"});
  EXPECT_NE(wrong.declared("unknown-value").find("did you mean `lenze8400`"), std::string::npos);
}

TEST(DeviceData, IsNotChosenForAnotherProductOrRevision) {
  Findings findings;
  const auto entry =
      read_entry("name: x\nmatch: {vendor_id: 0xABCD, product_code: 0x29}\n", findings);
  const auto net = compile_device_file("pump: {node_id: 4, dcf: x}\n", "astraada_drv28.eds",
                                       std::span{&*entry, 1});

  EXPECT_EQ(net.plan.nodes.at(0).device_data, "");
}

TEST(DeviceData, OfAnUnknownIdentityIsChosenByNameAlone) {
  const std::string node = "fan: {node_id: 4, dcf: x, tpdo: {1: {transmission: 245}}";
  const auto unnamed = compile_device_file(node + ", vendor_id: 0}\n", "takt_drive402.eds");
  const auto named = compile_device_file(node + ", device: toshiba_vfs15}\n", "takt_drive402.eds");

  EXPECT_EQ(unnamed.plan.nodes.at(0).device_data, "");
  EXPECT_EQ(named.plan.nodes.at(0).device_data, "Toshiba VF-S15");
  EXPECT_NE(named.declared("device-data").find("types 241 to 251 have no function"),
            std::string::npos);
}

TEST(DeviceData, SaysWhatADeltaDriveDoesWithoutSync) {
  const auto net =
      compile_device_file("axis: {node_id: 4, dcf: x, device: delta_asda}\n", "takt_drive402.eds");
  EXPECT_NE(net.plan.nodes.at(0).on_sync_loss.find("alarm"), std::string::npos);
}

TEST(DeviceData, OfTheUserComesBeforeWhatWasShipped) {
  ::setenv("TAKT_DEVICES", "/one:/two", 1);
  const auto folders = device_folders();
  ::unsetenv("TAKT_DEVICES");

  ASSERT_EQ(folders.size(), 3u);
  EXPECT_EQ(folders[0], "/one");
  EXPECT_EQ(folders[1], "/two");
  EXPECT_TRUE(std::filesystem::is_regular_file(folders[2] / "lenze8400.yaml"));
}

TEST(DeviceData, IsNamedByThePlanOfEachDemo) {
  for (const auto& [demo, declared] :
       {std::pair{"lenze8400", "device data: Lenze 8400 (lenze8400.yaml)"},
        std::pair{"beckhoff", "device data: Beckhoff bus terminals (beckhoff_io.yaml)"},
        std::pair{"plain301", "device data: Device of an older CiA 301 (plain301.yaml)"},
        std::pair{"astraada_drv28", "device data: Astraada DRV-28 (astraada_drv28.yaml)"}}) {
    const auto network = load_network(TAKT_SOURCE_DIR "/share/demo/" + std::string{demo} + ".yaml");
    for (const Finding& finding : network.findings) {
      EXPECT_EQ(finding.severity, Severity::note) << to_string(finding);
    }
    std::ostringstream text;
    print_plan_text(text, network.plan, {.node = {}, .realtime = {}, .lcm = {}});
    EXPECT_NE(text.str().find(declared), std::string::npos) << text.str();
  }
}

TEST(DeviceData, OfAFolderThatCannotBeReadIsAnError) {
  Findings findings;
  load_device_data({"/no/such/folder"}, findings);

  EXPECT_TRUE(has_error(findings));
}

}  // namespace
}  // namespace takt
