#include "eds_parser/device_data.hpp"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>

#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/network_file/read_devices.hpp"
#include "eds_parser/print/plan.hpp"
#include "test/unit/plan/tiny_network.hpp"

namespace takt {
namespace {

const std::vector<DeviceData>& shipped() {
  static const std::vector<DeviceData> entries = [] {
    Findings findings;
    auto all = load_device_data({TAKT_SOURCE_DIR "/share/devices"}, findings);
    for (const Finding& finding : findings) ADD_FAILURE() << to_string(finding);
    return all;
  }();
  return entries;
}

/// A network of one node whose device file is `eds` of share/eds.
test::Compiled compile_device_file(const std::string& yaml, const std::string& eds,
                                   std::span<const DeviceData> entries = shipped()) {
  test::Compiled out;
  out.spec = read_network(yaml, "net.yaml", out.findings);
  std::vector<EdsFile> files;
  files.reserve(out.spec.nodes.size());
  std::vector<const ObjectDictionary*> dictionaries;
  for (const NodeSpec& node : out.spec.nodes) {
    files.push_back(read_eds_file(TAKT_SOURCE_DIR "/share/eds/" + eds, NodeId::from(*node.id)));
    dictionaries.push_back(&files.back().dictionary);
  }
  CompiledNetwork compiled = compile_network(out.spec, dictionaries, out.findings, entries);
  out.plan = std::move(compiled.plan);
  out.devices = std::move(compiled.devices);
  return out;
}

test::Compiled drv28(const std::string& rest) {
  return compile_device_file(
      "master: {sync_period: 10000}\npump: {node_id: 4, dcf: x, " + rest + "}\n",
      "astraada_drv28.eds");
}
test::Compiled lenze(const std::string& rest) {
  return compile_device_file("drive: {node_id: 3, dcf: x, " + rest + "}\n", "lenze8400.eds");
}

using Complaints = std::vector<std::string>;

std::optional<DeviceData> read(const std::string& text, Findings& findings) {
  return read_device_data(text, "my_drive.yaml", findings);
}

TEST(DeviceData, HasAnEntryForEachFamily) {
  std::vector<std::string> ids;
  for (const DeviceData& entry : shipped()) ids.push_back(entry.id);

  EXPECT_EQ(ids, (std::vector<std::string>{"astraada_drv28", "beckhoff_io", "delta_asda", "elmo",
                                           "kostal_inveor", "lenze8400", "plain301", "schunk",
                                           "technosoft", "toshiba_vfs15"}));
}

TEST(DeviceData, ReadsAnEntry) {
  Findings findings;
  const auto entry = read(
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
  EXPECT_EQ(entry->revision.low, 2u);
  EXPECT_EQ(entry->revision.high, 2u);
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
  const auto entry = read(
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
  EXPECT_NE(wrong.said("unknown-value").find("did you mean `lenze8400`"), std::string::npos);
}

TEST(DeviceData, IsNotChosenForAnotherProductOrRevision) {
  Findings findings;
  const auto entry = read("name: x\nmatch: {vendor_id: 0xABCD, product_code: 0x29}\n", findings);
  const auto net = compile_device_file("pump: {node_id: 4, dcf: x}\n", "astraada_drv28.eds",
                                       std::span{&*entry, 1});

  EXPECT_EQ(net.plan.nodes.at(0).device_data, "");
}

TEST(DeviceData, RefusesTransmissionTypesThatADrv28Lacks) {
  for (const char* type : {"0", "252", "253"}) {
    const auto net = drv28(std::string{"tpdo: {2: {transmission: "} + type + "}}");

    EXPECT_FALSE(net.complaints().empty()) << type;
  }
  const std::string said = drv28("tpdo: {2: {transmission: 0}}").said("device-data");
  EXPECT_NE(said.find("TPDO2 of node `pump` can't have transmission type 0 on Astraada DRV-28, "
                      "only 1..240, 254, 255"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("astraada_drv28.yaml:"), std::string::npos);
}

TEST(DeviceData, RefusesAnotherTypeOrATimerForTheParameterChannelOfADrv28) {
  EXPECT_EQ(drv28("tpdo: {1: {transmission: 254}}").complaints(),
            Complaints{"2:53 error [device-data]"});
  EXPECT_EQ(drv28("tpdo: {1: {transmission: 255, event_timer: 100}}").complaints(),
            Complaints{"2:71 error [device-data]"});
  EXPECT_EQ(drv28("tpdo: {1: {transmission: 255, event_timer: 0}}").complaints(), Complaints{});
}

TEST(DeviceData, CountsInhibitTimesOfADrv28InMilliseconds) {
  const auto net = drv28("tpdo: {3: {transmission: 254, inhibit_time: 1000}}");

  EXPECT_EQ(net.complaints(), Complaints{});
  const auto& rows = net.plan.pdos.tpdos;
  const auto row = std::ranges::find(rows, 3, &PdoRow::number);
  ASSERT_NE(row, rows.end());
  EXPECT_EQ(row->inhibit, std::chrono::milliseconds{100});
  const auto& steps = net.plan.nodes.at(0).boot_plan.steps;
  const auto written = std::ranges::find_if(steps, [](const BootStep& step) {
    return step.object == ObjectKey{0x1802, 3} && step.action == BootAction::write_if_differs;
  });
  ASSERT_NE(written, steps.end());
  EXPECT_EQ(written->value, (std::vector{std::byte{100}, std::byte{0}}));
}

TEST(DeviceData, RefusesInhibitTimesOfADrv28BelowItsLeastOrBetweenMilliseconds) {
  EXPECT_EQ(drv28("tpdo: {3: {inhibit_time: 490}}").said("device-data").substr(0, 48),
            "the inhibit time of TPDO3 of node `pump` is 49 m");
  EXPECT_EQ(drv28("tpdo: {3: {inhibit_time: 500}}").complaints(), Complaints{});
  EXPECT_EQ(drv28("tpdo: {3: {inhibit_time: 1005}}").complaints(),
            Complaints{"2:53 error [device-data]"});
  EXPECT_EQ(drv28("tpdo: {3: {inhibit_time: 0}}").complaints(),
            Complaints{"2:53 error [device-data]"});
  EXPECT_EQ(drv28("sdo: [{index: 0x1802, sub_index: 3, value: 20}]").complaints(),
            Complaints{"2:34 error [device-data]"});
}

TEST(DeviceData, RefusesReservedTypesOfALenze) {
  EXPECT_TRUE(has_error(lenze("tpdo: {1: {transmission: 245}}").findings));
}

TEST(DeviceData, RefusesTypesThatAreWrittenBySdo) {
  const std::string sdo = "sdo: [{index: 0x1801, sub_index: 2, value: ";
  for (const char* type : {"0", "245", "252", "253"}) {
    const std::string said = drv28(sdo + type + "}]").said("device-data");
    EXPECT_NE(said.find("can't have transmission type " + std::string{type}), std::string::npos);
    EXPECT_NE(drv28(sdo + type + "}], tpdo: {2: {enabled: false}}").said("device-data"), "");
  }
  EXPECT_EQ(drv28(sdo + "254}]").said("device-data"), "");
  const std::string reserved = lenze(sdo + "245}]").said("device-data");
  EXPECT_NE(reserved.find("types 241 to 251 are reserved"), std::string::npos);
  EXPECT_FALSE(has_error(lenze(sdo + "252}]").findings));
}

TEST(DeviceData, RefusesALenzeBeforeFirmware16AsProducerOfItsOwnSync) {
  const std::string producer =
      "tpdo: {1: {transmission: 1}}, sdo: [{index: 0x1005, value: 0x40000080}], ";

  const auto old = lenze(producer + "firmware: \"15.02\"");
  EXPECT_NE(old.said("device-data").find("firmware 15.02.00 does not send it then"),
            std::string::npos);
  EXPECT_TRUE(has_error(old.findings));
  EXPECT_TRUE(has_error(lenze(producer + "sim: {model: lenze8400, firmware: \"15.99\"}").findings));
  EXPECT_TRUE(has_error(lenze(producer + "revision_number: 0x000F0002").findings));
  EXPECT_FALSE(has_error(lenze(producer + "firmware: \"16\"").findings));
  EXPECT_FALSE(has_error(lenze(producer + "revision_number: 0x00100000").findings));
}

TEST(DeviceData, RefusesALenzeThatSendsItsSyncOnAnotherIdentifierThanItReceives) {
  const auto producer = [](const std::string& code, const std::string& type = "1") {
    return lenze("firmware: \"16\", tpdo: {1: {transmission: " + type +
                 "}}, sdo: [{index: 0x1005, value: 0x40000080}, {index: 0x5E8F, value: " + code +
                 "}]");
  };
  const std::string said = producer("0x81").said("device-data");
  EXPECT_NE(said.find("this node makes the SYNC on 0x081, but receives it on 0x080"),
            std::string::npos)
      << said;
  EXPECT_EQ(producer("0x80").said("device-data"), "");
  EXPECT_EQ(producer("0x81", "254").said("device-data"), "") << "needs no SYNC";
}

TEST(DeviceData, RefusesToPollADrv28) {
  for (const char* poll : {"poll_ms: 100", "poll_syncs: 5"}) {
    const auto net = drv28(std::string{"tpdo: {2: {transmission: 254, "} + poll + "}}");
    EXPECT_NE(net.said("device-data").find("Astraada DRV-28 answers no remote request"),
              std::string::npos);
  }
  EXPECT_EQ(lenze("tpdo: {1: {transmission: 253, poll_ms: 100}}").said("device-data"), "");
}

TEST(DeviceData, LeavesOutObjectsThatAnOlderFirmwareLacks) {
  const auto newer = lenze("firmware: \"15.00\"");
  const auto older = lenze("firmware: \"14.01\"");

  const auto has_pdo4 = [](const test::Compiled& net) {
    return std::ranges::any_of(net.devices.at(0).objects, [](const DeviceObject& object) {
      return object.key.index == 0x1803;
    });
  };
  EXPECT_TRUE(has_pdo4(newer));
  EXPECT_FALSE(has_pdo4(older));
  EXPECT_TRUE(has_error(lenze("firmware: \"14.01\", tpdo: {4: {transmission: 1}}").findings));
}

TEST(DeviceData, GivesTheSimulatedDeviceItsFirmwareAndRevision) {
  const auto net = lenze("sim: {model: lenze8400, firmware: \"15.02\"}");

  EXPECT_EQ(net.devices.at(0).firmware, "15.02.00");
  const auto& objects = net.devices.at(0).objects;
  const auto revision = std::ranges::find(objects, ObjectKey{0x1018, 3}, &DeviceObject::key);
  ASSERT_NE(revision, objects.end());
  EXPECT_EQ(revision->value,
            (std::vector{std::byte{2}, std::byte{0}, std::byte{15}, std::byte{0}}));
}

TEST(DeviceData, TweaksTheBoot) {
  Findings findings;
  const auto entry = read(
      "name: Slow\nmatch: {vendor_id: 0xABCD}\n"
      "boot: {reset: node, values_after_pdos: true, pause_after_bootup_ms: 300, "
      "pause_before_start_ms: 20}\n",
      findings);
  ASSERT_TRUE(entry);
  const auto net =
      compile_device_file("pump: {node_id: 4, dcf: x, sdo: [{index: 0x100D, value: 3}]}\n",
                          "astraada_drv28.eds", std::span{&*entry, 1});

  const auto& steps = net.plan.nodes.at(0).boot_plan.steps;
  EXPECT_EQ(steps.at(0).command, NmtCommand::reset_node);
  EXPECT_EQ(steps.at(2).action, BootAction::pause);
  EXPECT_EQ(steps.at(2).timeout, std::chrono::milliseconds{300});
  const auto position = [&](auto wanted) { return std::ranges::find_if(steps, wanted); };
  const auto value = position([](const BootStep& s) { return s.object.index == 0x100D; });
  const auto pdo = position([](const BootStep& s) { return s.object.index == 0x1803; });
  const auto start = position([](const BootStep& s) {
    return s.action == BootAction::nmt && s.command == NmtCommand::start;
  });
  EXPECT_LT(pdo, value);
  ASSERT_NE(start, steps.end());
  EXPECT_EQ((start - 1)->timeout, std::chrono::milliseconds{20});
}

TEST(DeviceData, WarnsOfAResetOfTheWholeElmoDrive) {
  const std::string node = "arm: {node_id: 4, dcf: x, vendor_id: 0x9A, reset: ";
  const auto whole = compile_device_file(node + "node}\n", "takt_drive402.eds");
  const auto only_communication =
      compile_device_file(node + "communication}\n", "takt_drive402.eds");

  EXPECT_EQ(whole.plan.nodes.at(0).device_data, "Elmo drives");
  EXPECT_NE(whole.said("device-data").find("pulls the CAN lines down"), std::string::npos);
  EXPECT_EQ(whole.plan.nodes.at(0).boot_plan.steps.at(0).command, NmtCommand::reset_node);
  EXPECT_EQ(only_communication.said("device-data"), "");
}

TEST(DeviceData, KnowsTheBufferStateOfATechnosoftDriveAndItsInhibitTime) {
  const auto net =
      compile_device_file("arm: {node_id: 4, dcf: x, vendor_id: 0x1A3}\n", "takt_drive402.eds");

  const auto& plan = net.plan.nodes.at(0);
  EXPECT_EQ(plan.device_data, "Technosoft iPOS");
  ASSERT_EQ(plan.emcy_texts.size(), 1U);
  EXPECT_EQ(plan.emcy_texts[0].code, 0xFF01);
  EXPECT_NE(std::ranges::find(plan.device_notes, "inhibit times of 30 ms by default"),
            plan.device_notes.end());
}

TEST(DeviceData, OfAnUnknownIdentityIsChosenByNameAlone) {
  const std::string node = "fan: {node_id: 4, dcf: x, tpdo: {1: {transmission: 245}}";
  const auto unnamed = compile_device_file(node + ", vendor_id: 0}\n", "takt_drive402.eds");
  const auto named = compile_device_file(node + ", device: toshiba_vfs15}\n", "takt_drive402.eds");

  EXPECT_EQ(unnamed.plan.nodes.at(0).device_data, "");
  EXPECT_EQ(named.plan.nodes.at(0).device_data, "Toshiba VF-S15");
  EXPECT_NE(named.said("device-data").find("types 241 to 251 have no function"), std::string::npos);
}

TEST(DeviceData, WarnsOfAResetThatASchunkModuleDoesNotTake) {
  const std::string node = "arm: {node_id: 4, dcf: x, device: schunk, reset: ";
  const auto communication = compile_device_file(node + "communication}\n", "takt_drive402.eds");
  EXPECT_NE(communication.said("device-data").find("whole application"), std::string::npos);
  EXPECT_EQ(compile_device_file(node + "node}\n", "takt_drive402.eds").said("device-data"), "");
}

TEST(DeviceData, KnowsFromWhichFirmwareAKostalInverterConsumesHeartbeats) {
  const auto consumes = [](const std::string& firmware) {
    const auto net = compile_device_file(
        "pump: {node_id: 4, dcf: x, vendor_id: 0x337, firmware: \"" + firmware + "\"}\n",
        "takt_drive402.eds");
    EXPECT_EQ(net.plan.nodes.at(0).device_data, "Kostal INVEOR");
    return std::ranges::any_of(net.devices.at(0).objects, [](const DeviceObject& object) {
      return object.key.index == 0x1016;
    });
  };
  EXPECT_TRUE(consumes("03.85"));
  EXPECT_FALSE(consumes("03.84"));
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
  for (const auto& [demo, said] :
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
    EXPECT_NE(text.str().find(said), std::string::npos) << text.str();
  }
}

TEST(DeviceData, OfAFolderThatCannotBeReadIsAnError) {
  Findings findings;
  load_device_data({"/no/such/folder"}, findings);

  EXPECT_TRUE(has_error(findings));
}

}  // namespace
}  // namespace takt
