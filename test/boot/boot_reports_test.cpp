#include <cstdlib>
#include <map>
#include <set>

#include "test/boot/plant.hpp"

namespace takt {
namespace {

using namespace test;
using enum sim::FaultKind;

/// One way in which a boot fails. Its report is in data/boot_reports.txt.
struct Case {
  std::string name;
  std::string keys{};  ///< keys of the node in the network file
  sim::Faults faults{};
  Time span = 5s;
  Time devices_first{};      ///< time for which the devices run before the master
  std::string others{};      ///< further nodes of the network file
  std::uint32_t serial = 0;  ///< serial number of the device, if it differs from the network file
};

sim::Fault fault(sim::FaultKind kind, Time at = {}, Time until = never) {
  return {.kind = kind, .node = 5_node, .at = at, .until = until};
}
sim::Fault on(sim::FaultKind kind, ObjectKey object, std::uint32_t abort_code = 0) {
  sim::Fault out = fault(kind);
  out.object = object;
  out.abort_code = abort_code;
  return out;
}
sim::Fault reads_as(ObjectKey object, std::uint32_t value) {
  sim::Fault out = on(override_value, object);
  for (unsigned i = 0; i < 4; ++i) out.value.push_back(std::byte(value >> (8 * i) & 0xFF));
  return out;
}
sim::Fault storm(Time period) {
  sim::Fault out = fault(bootup_storm);
  out.time = period;
  return out;
}
sim::Fault late(Time by) {
  sim::Fault out = fault(late_bootup);
  out.time = by;
  return out;
}

const std::string mapping = "tpdo: {1: {mapping: [{index: 0x2010}, {index: 0x2012}]}}";
const std::string setting = "sdo: [{index: 0x2000, value: 5}]";
const std::string label = "sdo: [{index: 0x2002, value: '" + std::string(800, 'x') + "'}]";
const std::string guarded = "heartbeat_producer: 0, heartbeat_consumer: false, guard_time: 100";
const std::string channel = "sdo_channel: {request: 0x645, answer: 0x5C5}";
const std::string program = "software_version: 0x00010001, software_file: program.bin";

std::vector<Case> cases() {
  std::vector<Case> all{
      // identity of the device
      {"another device type", "", {reads_as({0x1000, 0}, 0x0001'0191)}},
      {"another vendor", "", {reads_as({0x1018, 1}, 0x0000'015A)}},
      {"another product", "", {reads_as({0x1018, 2}, 0x0000'0701)}},
      {"another revision", "revision_number: 0x00010002", {reads_as({0x1018, 3}, 0x0002'0000)}},
      {"another serial number", "serial_number: 77", {reads_as({0x1018, 4}, 78)}},
      {"identity can't be read", "", {on(refuse_object, {0x1018, 1}, 0x0602'0000)}},
      // silent devices
      {"no power", "", {fault(power_off)}, 8s, {}, "  pump: {node_id: 6, dcf: valve.eds}\n"},
      {"SDO server mute", "", {fault(mute_sdo)}},
      {"boot-up message missing and mute", "", {fault(no_bootup), fault(mute_sdo)}, 8s},
      {"boot-up much too late", "", {late(20s)}, 8s},
      {"no SDO server on the channel of the network file", channel},
      {"neither boot-up message nor that SDO server", channel, {fault(no_bootup)}, 8s},
      {"without id and silent to LSS",
       "lss: true, sim: {quirks: [no_node_id]}",
       {fault(lss_silent)},
       8s},
      {"without id and with another serial number",
       "lss: true, serial_number: 78, sim: {quirks: [no_node_id]}",
       {},
       8s,
       {},
       "",
       77},
      {"mute at the identity", "", {on(mute_sdo, {0x1018, 1})}},
      {"mute at the heartbeat", "", {on(mute_sdo, {0x1017, 0})}},
      {"mute at a value", setting, {on(mute_sdo, {0x2000, 0})}},
      {"mute at a COB-ID", mapping, {on(mute_sdo, {0x1800, 1})}},
      {"mute at a mapping count", mapping, {on(mute_sdo, {0x1A00, 0})}},
      {"mute at a mapping entry", mapping, {on(mute_sdo, {0x1A00, 2})}},
      {"power fails in the middle of the boot", label, {fault(power_off, 100ms)}},
      {"time-out in the middle of a block transfer", label, {fault(mute_sdo, 100ms)}},
      {"time-out in the middle of a segmented transfer",
       label + ", sdo_block: never",
       {fault(mute_sdo, 100ms)}},
      {"restarts again and again", label, {storm(25ms)}},
      // error control
      {"heartbeat missing", "", {fault(no_heartbeat)}},
      {"guarding missing", guarded, {fault(no_guarding)}},
      {"heartbeat can't be switched on", "", {on(refuse_write, {0x1017, 0}, 0x0601'0002)}},
      {"does not watch the master", "", {on(refuse_write, {0x1016, 1}, 0x0604'0043)}},
      {"error behaviour refused",
       "error_behavior: {1: 2}",
       {on(refuse_write, {0x1029, 1}, 0x0609'0030)}},
      {"SYNC refused", "", {on(refuse_write, {0x1006, 0}, 0x0609'0031)}},
      {"EMCY identifier refused",
       "emcy_cob_id: 0x0C5",
       {on(refuse_write, {0x1014, 0}, 0x0609'0030)}},
      {"NMT start not obeyed", "", {fault(no_start)}},
      // keep-alive
      {"kept running but no heartbeat", "reset: keep_alive", {fault(no_heartbeat)}, 5s, 1s},
      {"kept running but no guarding",
       "reset: keep_alive, " + guarded,
       {fault(no_guarding)},
       5s,
       1s},
      {"kept running with another mapping",
       "reset: keep_alive, " + mapping,
       {fault(self_start), reads_as({0x1017, 0}, 100)},
       5s,
       1s},
      // PDOs
      {"read-only COB-ID", mapping, {on(refuse_write, {0x1800, 1}, 0x0601'0002)}},
      {"COB-ID can't be read", mapping, {on(refuse_object, {0x1800, 1}, 0x0602'0000)}},
      {"mapping fixed", mapping, {fault(fixed_mapping)}},
      {"mapping count refused", mapping, {on(refuse_write, {0x1A00, 0}, 0x0800'0022)}},
      {"object not mappable", mapping, {on(refuse_write, {0x1A00, 2}, 0x0604'0041)}},
      {"mapping too long", mapping, {on(refuse_write, {0x1A00, 2}, 0x0604'0042)}},
      {"mapped object missing", mapping, {on(refuse_write, {0x1A00, 1}, 0x0602'0000)}},
      {"mapping entry missing", mapping, {on(refuse_write, {0x1A00, 2}, 0x0609'0011)}},
      {"mapping incompatible", mapping, {on(refuse_write, {0x1A00, 1}, 0x0604'0043)}},
      {"mapping silently ignored", mapping, {on(ignore_write, {0x1A00, 2})}},
      {"transmission type refused",
       "tpdo: {1: {transmission: 10}}",
       {on(refuse_write, {0x1800, 2}, 0x0609'0030)}},
      {"event timer refused",
       "tpdo: {1: {event_timer: 50}}",
       {on(refuse_write, {0x1800, 5}, 0x0609'0031)}},
      // configuration
      {"gone after the restore", "restore_configuration: 1", {fault(power_off, 72ms)}, 10s},
      {"mute after the restore",
       "restore_configuration: 1",
       {fault(no_bootup), on(mute_sdo, {0x1017, 0})},
       10s},
      {"restore refused", "restore_configuration: 1", {on(refuse_write, {0x1011, 1}, 0x0800'0020)}},
      {"store refused",
       "store_configuration: 1, " + setting,
       {on(refuse_write, {0x1010, 1}, 0x0606'0000)}},
      {"store takes too long",
       "store_configuration: 1, " + setting,
       {on(mute_sdo, {0x1010, 1})},
       20s},
      {"configuration date refused",
       "configuration_date: auto",
       {on(refuse_write, {0x1020, 2}, 0x0601'0002)}},
      // program download
      {"software version unknown",
       "software_version: 0x00010001",
       {on(refuse_object, {0x1F56, 1}, 0x0602'0000)}},
      {"mute at the software version", program, {on(mute_sdo, {0x1F56, 1})}},
      {"software differs and there is no file", "software_version: 0x00010001"},
      {"software differs and the node is running",
       "reset: keep_alive, " + program,
       {fault(self_start), reads_as({0x1017, 0}, 100)},
       5s,
       1s},
      {"program does not stop", program, {on(refuse_write, {0x1F51, 1}, 0x0800'0022)}},
      {"program refused", program, {on(refuse_write, {0x1F50, 1}, 0x0800'0021)}},
      {"program download falls silent", program, {on(mute_sdo, {0x1F50, 1})}, 20s},
      {"program is not valid", "software_version: 0x00010001, software_file: stub.bin", {}, 20s},
      {"program is another version",
       "software_version: 0x00990099, software_file: program.bin",
       {},
       20s},
  };
  const std::string text = "sdo: [{index: 0x2002, value: 'hello'}]";
  all.push_back({"text too long", text, {on(refuse_write, {0x2002, 0}, 0x0607'0012)}});
  all.push_back({"text too short", text, {on(refuse_write, {0x2002, 0}, 0x0607'0013)}});
  // every abort code of the standard and of EtherCAT devices
  for (const std::uint32_t code :
       {0x0503'0000U, 0x0504'0001U, 0x0504'0005U, 0x0601'0000U, 0x0601'0001U, 0x0601'0002U,
        0x0602'0000U, 0x0604'0043U, 0x0604'0047U, 0x0606'0000U, 0x0607'0010U, 0x0607'0012U,
        0x0607'0013U, 0x0609'0011U, 0x0609'0030U, 0x0609'0031U, 0x0609'0032U, 0x0609'0036U,
        0x060A'0023U, 0x0800'0000U, 0x0800'0020U, 0x0800'0021U, 0x0800'0022U, 0x0800'0023U,
        0x0800'0024U, 0x1234'5678U}) {
    all.push_back({"abort " + hex(code, 8), setting, {on(refuse_write, {0x2000, 0}, code)}});
  }
  return all;
}

std::string report(const Case& what) {
  LoadedNetwork network = valve(what.keys, "", what.others);
  if (what.serial != 0) {
    auto& objects = network.devices[0].objects;
    const auto serial = std::ranges::find(objects, ObjectKey{0x1018, 4}, &DeviceObject::key);
    EXPECT_NE(serial, objects.end());
    serial->value = reads_as({0x1018, 4}, what.serial).value;
  }
  Plant plant{std::move(network), what.faults};
  if (what.devices_first != Time{}) plant.run_without_master(what.devices_first);
  plant.run(what.span);
  std::string text = plant.text_of(EventKind::boot_failed);
  const std::string folder = TAKT_SOURCE_DIR "/test/boot/data/";
  for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder)) {
    text.erase(at, folder.size());
  }
  return text;
}

const std::string golden_file = std::string{TAKT_SOURCE_DIR} + "/test/boot/data/boot_reports.txt";

/// Reads the reports from the golden file: a line "== name" comes before each report.
std::map<std::string, std::string> read_golden() {
  std::map<std::string, std::string> reports;
  std::ifstream in{golden_file};
  std::string* report = nullptr;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("== ")) {
      report = &reports[line.substr(3)];
    } else if (report != nullptr) {
      *report += line + "\n";
    }
  }
  return reports;
}

/// A person must review the reports when they change. They are regenerated by `TAKT_REMAKE_GOLDEN=1
/// build/release/bin/boot --gtest_filter='BootReports.*'`.
TEST(BootReports, AreTheseForEveryWayToFail) {
  std::string made;
  const auto golden = read_golden();
  for (const Case& what : cases()) {
    const std::string text = report(what) + "\n\n";
    made += "== " + what.name + "\n" + text;
    const auto expected = golden.find(what.name);
    EXPECT_EQ(text, expected == golden.end() ? "" : expected->second) << what.name;
  }
  if (std::getenv("TAKT_REMAKE_GOLDEN") != nullptr) std::ofstream{golden_file} << made;
}

TEST(BootReports, NameCauseStatusAndRemedyOfAtLeastSixtyKinds) {
  const auto golden = read_golden();
  EXPECT_GE(golden.size(), 60u);
  EXPECT_EQ(golden.size(), cases().size());
  std::set<char> letters;
  for (const auto& [name, text] : golden) {
    EXPECT_NE(text.find("failed to boot at step "), std::string::npos) << name;
    EXPECT_NE(text.find("\n  try       "), std::string::npos) << name;
    EXPECT_NE(text.find("\n  received  "), std::string::npos) << name;
    if (const auto at = text.find("\n  status    "); at != std::string::npos) {
      letters.insert(text[at + 13]);
    }
  }
  const std::string reached{letters.begin(), letters.end()};
  EXPECT_EQ(reached, "BCDEFGHIJKLMNO");
}

}  // namespace
}  // namespace takt
