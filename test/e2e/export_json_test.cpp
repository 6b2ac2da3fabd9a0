// `takt export json` writes the keys that other programs rely on, with the values of the compiled
// plan.
#include <algorithm>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "eds_parser/network_file/load_network.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string demo(const std::string& name) {
  return std::string{TAKT_SOURCE_DIR} + "/share/demo/" + name + ".yaml";
}

/// Converts a time to microseconds, the unit of the document.
double us(Time time) { return static_cast<double>(time.count()) / 1000.0; }

/// Runs `takt export json` and returns the JSON document from the file that the output names after
/// the warnings.
json exported(const std::string& network) {
  const Folder folder;
  const auto target = folder / "out";
  const Ended ended = run({TAKT, "export", "json", network, "-o", target.string()}, folder.path());
  EXPECT_EQ(ended.exit_code, 0) << ended.output;
  const auto end = ended.output.rfind('\n');
  const auto begin = ended.output.rfind('\n', end - 1);  // npos + 1 if there is only one line
  const auto written = ended.output.substr(begin + 1, end - begin - 1);
  auto document = json::parse(read_file(written));
  EXPECT_EQ(written, target / (document.value("bus", "") + ".json"));
  return document;
}

/// `name`, or `name?` if the key is optional, and its kind: n number, b boolean, s text, l list, o
/// object. A capital letter also allows null.
using Shape = std::vector<std::pair<std::string_view, char>>;

bool is_kind(const json& value, char kind) {
  switch (kind) {
    case 'N':
      return value.is_null() || value.is_number();
    case 'n':
      return value.is_number();
    case 'b':
      return value.is_boolean();
    case 's':
      return value.is_string();
    case 'l':
      return value.is_array();
    case 'o':
      return value.is_object();
    default:
      return false;
  }
}

void expect_shape(const json& object, const Shape& shape, const std::string& where) {
  std::set<std::string> surplus;
  for (const auto& item : object.items()) surplus.insert(item.key());
  for (const auto& [written, kind] : shape) {
    const bool optional = written.ends_with('?');
    const std::string key{optional ? written.substr(0, written.size() - 1) : written};
    surplus.erase(key);
    if (!object.contains(key)) {
      EXPECT_TRUE(optional) << where << " has no " << key;
      continue;
    }
    EXPECT_TRUE(is_kind(object[key], kind)) << where << '.' << key << ": " << object[key];
  }
  EXPECT_THAT(surplus, testing::IsEmpty()) << where;
}

const Shape bus_shape = {
    {"bus", 's'},         {"interface", 's'}, {"bitrate", 'n'}, {"master_id", 'n'},
    {"start_nodes", 'b'}, {"cycle", 'o'},     {"nodes", 'l'},   {"master_heartbeat_us", 'n'},
    {"image", 'o'},       {"lcm", 'o'},       {"waits", 'l'},   {"limits", 'l'}};
const Shape limit_shape = {{"node", 's'},  {"axis", 'N'},    {"index", 'N'},     {"sub", 'N'},
                           {"limit", 's'}, {"source", 's'},  {"low", 'N'},       {"high", 'N'},
                           {"unit", 's'},  {"signals", 'l'}, {"proposal?", 's'}, {"because?", 's'}};
const Shape wait_shape = {{"wait", 's'}, {"limit_us", 'n'}, {"what", 's'}};
const Shape cycle_shape = {{"period_us", 'n'},       {"sync", 'b'},
                           {"sync_cob_id", 'n'},     {"sync_overflow", 'n'},
                           {"time_period_us", 'n'},  {"time_cob_id", 'n'},
                           {"sync_source", 's'},     {"sync_timeout_us", 'n'},
                           {"sync_window_us", 'n'},  {"receive_window_us", 'n'},
                           {"service_frames", 'n'},  {"output_deadline_us", 'n'},
                           {"inputs_wire_us", 'n'},  {"quiet_before_sync_us", 'n'},
                           {"outputs_wire_us", 'n'}, {"compute_from_us", 'n'},
                           {"acts_at_sync", 's'},    {"compute_until_us", 'n'}};
const Shape node_shape = {
    {"id", 'n'},
    {"name", 's'},
    {"file", 's'},
    {"product_name", 's'},
    {"identity", 'o'},
    {"boot", 'b'},
    {"mandatory", 'b'},
    {"cia402", 'b'},
    {"heartbeat_timeout_us", 'n'},
    {"guard_time_us", 'n'},
    {"guard_life_time_us", 'n'},
    {"emcy_cob_id", 'n'},
    {"on_loss", 's'},
    {"group", 's'},
    {"sdo_request_cob_id", 'n'},
    {"sdo_answer_cob_id", 'n'},
    {"sdo_timeout_us", 'n'},
    {"reboot_delay_us", 'n'},
    {"reboot_delay_max_us", 'n'},
    {"lss", 'b'},
    {"device_data", 's'},
    {"device_data_file", 's'},
    {"device_notes", 'l'},
    {"homing", 'l'},
    {"tpdos", 'l'},
    {"rpdos", 'l'},
    {"boot_plan", 'l'},
};
const Shape pdo_shape = {
    {"number", 'n'},  {"cob_id", 'n'},     {"extended", 'b'},   {"transmission_type", 'n'},
    {"length", 'n'},  {"sync_start", 'n'}, {"inhibit_us", 'n'}, {"event_timer_us", 'n'},
    {"poll_us", 'n'}, {"poll_syncs", 'n'}, {"late", 's'},       {"deadline_us", 'n'},
    {"fields", 'l'},  {"on_request", 'b'}, {"mpdo_header", 'n'}};
const Shape field_shape = {{"signal", 'n'}, {"name", 's'},       {"index", 'n'},
                           {"sub", 'n'},    {"bit_offset", 'n'}, {"bits", 'n'}};
const Shape step_shape = {{"step", 'n'},         {"action", 's'},     {"letter", 's'},
                          {"purpose", 's'},      {"timeout_us", 'n'}, {"command?", 's'},
                          {"sub?", 'n'},         {"target?", 'n'},    {"index?", 'n'},
                          {"value?", 's'},       {"mask?", 'n'},      {"frame?", 's'},
                          {"write_frame?", 's'}, {"optional?", 'b'}};
const Shape signal_shape = {{"signal", 'n'},      {"node", 's'},
                            {"node_id", 'n'},     {"name", 's'},
                            {"index", 'n'},       {"sub", 'n'},
                            {"direction", 's'},   {"data_type", 's'},
                            {"bits", 'n'},        {"unit", 's'},
                            {"scale", 'n'},       {"offset", 'n'},
                            {"fallback?", 's'},   {"fallback_cycles?", 'n'},
                            {"safe_value?", 'N'}, {"fallback_value?", 'n'},
                            {"seeded_from?", 'N'}};

/// Demos with synchronous axes, terminals, event-driven PDOs, remote requests, and many nodes.
const std::vector<std::string> demos = {"two_axes",       "beckhoff", "lenze8400_sync",
                                        "astraada_drv28", "plain301", "sixteen_nodes"};

TEST(ExportJson, HasTheKeysThatOtherProgramsRelyOn) {
  for (const auto& name : demos) {
    const auto document = exported(demo(name));

    expect_shape(document, bus_shape, name);
    expect_shape(document["cycle"], cycle_shape, name + " cycle");
    for (const auto& wait : document["waits"]) expect_shape(wait, wait_shape, name + " waits");
    for (const auto& limit : document["limits"]) expect_shape(limit, limit_shape, name + " limits");
    for (const auto& node : document["nodes"]) {
      const std::string where = name + ' ' + node.value("name", "");
      expect_shape(node, node_shape, where);
      for (const auto* direction : {"tpdos", "rpdos"}) {
        for (const auto& pdo : node[direction]) {
          expect_shape(pdo, pdo_shape, where + ' ' + direction);
          for (const auto& field : pdo["fields"]) expect_shape(field, field_shape, where);
        }
      }
      for (const auto& step : node["boot_plan"]) expect_shape(step, step_shape, where + " boot");
    }
    expect_shape(document["image"],
                 {{"inputs", 'n'}, {"outputs", 'n'}, {"hash", 'n'}, {"signals", 'l'}}, name);
    for (const auto& signal : document["image"]["signals"]) {
      expect_shape(signal, signal_shape, name + " image");
    }
    expect_shape(document["lcm"], {{"url", 's'}, {"channels", 'l'}}, name);
    for (const auto& channel : document["lcm"]["channels"]) {
      expect_shape(channel, {{"channel", 's'}, {"type", 's'}}, name + " lcm");
    }
  }
}

void expect_pdos(const json& list, const std::vector<PdoRow>& rows, const BusPlan& plan,
                 std::size_t node) {
  std::size_t at = 0;
  for (const PdoRow& row : rows) {
    if (row.node_index != node) continue;
    ASSERT_LT(at, list.size());
    const json& pdo = list[at++];
    EXPECT_EQ(pdo["number"], row.number);
    EXPECT_EQ(pdo["cob_id"], row.cob_id.id());
    EXPECT_EQ(pdo["extended"], row.cob_id.is_extended());
    EXPECT_EQ(pdo["transmission_type"], row.transmission);
    EXPECT_EQ(pdo["length"], row.length);
    EXPECT_EQ(pdo["sync_start"], row.sync_start);
    EXPECT_EQ(pdo["inhibit_us"], us(row.inhibit));
    EXPECT_EQ(pdo["event_timer_us"], us(row.event_timer));
    EXPECT_EQ(pdo["deadline_us"], us(row.deadline));
    EXPECT_EQ(pdo["poll_us"], us(row.poll));
    EXPECT_EQ(pdo["poll_syncs"], row.poll_syncs);
    EXPECT_EQ(pdo["late"], row.drop_late ? "drop" : "use");
    EXPECT_EQ(pdo["on_request"], row.on_request);
    EXPECT_EQ(pdo["mpdo_header"], row.header);
    ASSERT_EQ(pdo["fields"].size(), row.field_count);
    for (std::size_t i = 0; i < row.field_count; ++i) {
      const PdoField& field = plan.pdos.fields[row.first_field + i];
      const Signal& signal = plan.layout.signals[field.signal];
      EXPECT_EQ(pdo["fields"][i], json({{"signal", field.signal},
                                        {"name", signal.name},
                                        {"index", signal.object.index},
                                        {"sub", signal.object.sub},
                                        {"bit_offset", field.bit_offset},
                                        {"bits", field.bits}}));
    }
  }
  EXPECT_EQ(at, list.size());
}

void expect_boot(const json& steps, const BootPlan& boot) {
  ASSERT_EQ(steps.size(), boot.steps.size());
  for (std::size_t i = 0; i < boot.steps.size(); ++i) {
    const BootStep& step = boot.steps[i];
    EXPECT_EQ(steps[i]["step"], i + 1);
    EXPECT_EQ(steps[i]["letter"], std::string(1, step.letter));
    EXPECT_EQ(steps[i]["purpose"], step.purpose);
    EXPECT_EQ(steps[i]["timeout_us"], us(step.timeout));
    EXPECT_EQ(steps[i].value("index", 0), step.object.index);
    EXPECT_EQ(steps[i].value("sub", 0), step.object.index == 0 ? 0 : step.object.sub);
    EXPECT_EQ(steps[i].value("mask", 0xFFFF'FFFFU), step.mask);
    EXPECT_EQ(steps[i].value("optional", false), step.optional);
    EXPECT_EQ(steps[i].contains("value"), !step.value.empty());
    if (step.action == BootAction::skip_if_same) {
      EXPECT_EQ(steps[i]["target"], step.target + 1);
    }
  }
}

TEST(ExportJson, SaysWhatThePlanSays) {
  for (const auto& name : demos) {
    const auto document = exported(demo(name));
    const auto network = load_network(demo(name));
    const BusPlan& plan = network.plan;

    EXPECT_EQ(document["bus"], plan.name);
    EXPECT_EQ(document["interface"], plan.interface);
    EXPECT_EQ(document["bitrate"], plan.bitrate);
    EXPECT_EQ(document["master_id"], plan.master_id.value());
    EXPECT_EQ(document["master_heartbeat_us"], us(plan.master_heartbeat));
    EXPECT_EQ(document["start_nodes"], plan.start_nodes);
    EXPECT_EQ(document["cycle"]["period_us"], us(plan.cycle.period));
    EXPECT_EQ(document["cycle"]["sync"], plan.cycle.sync);
    EXPECT_EQ(document["cycle"]["sync_cob_id"], plan.cycle.sync_cob_id.id());
    EXPECT_EQ(document["cycle"]["sync_overflow"], plan.cycle.sync_overflow);
    EXPECT_EQ(document["cycle"]["sync_timeout_us"], us(plan.cycle.sync_timeout));
    EXPECT_EQ(document["cycle"]["sync_window_us"], us(plan.cycle.sync_window));
    EXPECT_EQ(document["cycle"]["receive_window_us"], us(plan.cycle.receive_window));
    EXPECT_EQ(document["cycle"]["output_deadline_us"], us(plan.cycle.output_deadline));
    EXPECT_EQ(document["cycle"]["quiet_before_sync_us"], us(plan.cycle.quiet_before_sync));
    EXPECT_EQ(document["cycle"]["service_frames"], plan.cycle.service_frames);
    EXPECT_EQ(document["cycle"]["time_period_us"], us(plan.time.period));
    EXPECT_EQ(document["cycle"]["time_cob_id"], plan.time.cob_id.id());

    ASSERT_EQ(document["nodes"].size(), plan.nodes.size());
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      const json& node = document["nodes"][i];
      const NodePlan& wanted = plan.nodes[i];
      SCOPED_TRACE(name + ' ' + wanted.name);
      EXPECT_EQ(node["id"], wanted.id.value());
      EXPECT_EQ(node["name"], wanted.name);
      EXPECT_EQ(node["file"], wanted.description_file);
      EXPECT_EQ(node["mandatory"], wanted.mandatory);
      EXPECT_EQ(node["cia402"], wanted.cia402);
      EXPECT_EQ(node["heartbeat_timeout_us"], us(wanted.heartbeat_timeout));
      EXPECT_EQ(node["guard_time_us"], us(wanted.guard.period));
      EXPECT_EQ(node["sdo_timeout_us"], us(wanted.sdo_timeout));
      EXPECT_EQ(node["lss"], wanted.lss.has_value());
      EXPECT_EQ(node["device_data"], wanted.device_data);
      EXPECT_EQ(node["device_notes"], json(wanted.device_notes));
      EXPECT_EQ(node["homing"].size(),
                static_cast<std::size_t>(std::ranges::count_if(
                    wanted.axes, [](const AxisPlan& axis) { return axis.homing.has_value(); })));
      expect_pdos(node["tpdos"], plan.pdos.tpdos, plan, i);
      expect_pdos(node["rpdos"], plan.pdos.rpdos, plan, i);
      expect_boot(node["boot_plan"], wanted.boot_plan);
    }

    const json& image = document["image"];
    EXPECT_EQ(image["inputs"], plan.layout.inputs);
    EXPECT_EQ(image["outputs"], plan.layout.outputs());
    EXPECT_EQ(image["hash"], plan.layout.hash);
    ASSERT_EQ(image["signals"].size(), plan.layout.signals.size());
    for (std::size_t i = 0; i < plan.layout.signals.size(); ++i) {
      const json& signal = image["signals"][i];
      const Signal& wanted = plan.layout.signals[i];
      SCOPED_TRACE(name + ' ' + wanted.name);
      EXPECT_EQ(signal["signal"], i);
      EXPECT_EQ(signal["node"], plan.nodes[wanted.node_index].name);
      EXPECT_EQ(signal["node_id"], wanted.node.value());
      EXPECT_EQ(signal["name"], wanted.name);
      EXPECT_EQ(signal["index"], wanted.object.index);
      EXPECT_EQ(signal["sub"], wanted.object.sub);
      EXPECT_EQ(signal["direction"], wanted.output ? "out" : "in");
      EXPECT_EQ(signal["bits"], wanted.bits);
      EXPECT_EQ(signal["unit"], wanted.unit);
      EXPECT_EQ(signal["scale"], wanted.scale);
      EXPECT_EQ(signal["offset"], wanted.offset);
      EXPECT_EQ(signal.contains("fallback"), wanted.output);
      if (!wanted.output) continue;
      EXPECT_EQ(signal["fallback"], wanted.fallback == Fallback::hold ? "hold" : "value");
      EXPECT_EQ(signal["fallback_cycles"], wanted.fallback_cycles);
      EXPECT_EQ(signal["safe_value"], wanted.safe_value ? json(*wanted.safe_value) : json());
      EXPECT_EQ(signal["seeded_from"], wanted.seeded_from ? json(*wanted.seeded_from) : json());
    }
  }
}

/// Compares the elbow of the demo, node 2, with the numbers in its network file.
TEST(ExportJson, HasTheNumbersOfTheNetworkFile) {
  const auto document = exported(demo("two_axes"));

  EXPECT_EQ(document["bus"], "demo");
  EXPECT_EQ(document["bitrate"], 1'000'000);
  EXPECT_EQ(document["cycle"]["period_us"], 2000.0);
  EXPECT_EQ(document["cycle"]["sync_source"], "master");
  const json& elbow = document["nodes"][1];
  EXPECT_EQ(elbow["name"], "elbow");
  EXPECT_EQ(elbow["rpdos"][0]["cob_id"], 0x202);
  EXPECT_EQ(elbow["rpdos"][0]["length"], 6);
  EXPECT_EQ(elbow["rpdos"][0]["fields"][1]["index"], 0x607A);
  EXPECT_EQ(elbow["rpdos"][0]["fields"][1]["bit_offset"], 16);
  const auto& steps = elbow["boot_plan"];
  const auto velocity = std::ranges::find_if(
      steps, [](const json& step) { return step.value("index", 0) == 0x6081; });
  ASSERT_NE(velocity, steps.end());
  EXPECT_EQ((*velocity)["value"], "0x000186A0");  // 100000
  const auto signal = elbow["tpdos"][0]["fields"][1]["signal"].get<std::size_t>();
  const json& position = document["image"]["signals"][signal];
  EXPECT_EQ(position["node"], "elbow");
  EXPECT_EQ(position["unit"], "rad");
  EXPECT_EQ(position["scale"], 6.283185307179586e-4);
  EXPECT_EQ(document["lcm"]["channels"][0]["channel"], "DEMO_IMAGE");
}

TEST(ExportJson, IsWhatPlanPrintsAsJson) {
  const Folder folder;
  const auto plan = run({TAKT, "plan", demo("two_axes"), "--json"}, folder.path());

  EXPECT_EQ(exported(demo("two_axes")), json::parse(plan.output));
}

TEST(ExportJson, WritesNothingOfANetworkWithAnError) {
  const Folder folder;
  std::ofstream{folder / "bad.yaml"} << "nodes:\n  a: {node_id: 300}\n";

  const auto ended =
      run({TAKT, "export", "json", (folder / "bad.yaml").string(), "-o", (folder / "out").string()},
          folder.path());

  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.output, HasSubstr("bad.yaml:2:"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(ExportJson, SaysThatAFolderCannotBeWritten) {
  const Folder folder;
  std::ofstream{folder / "taken"} << "a file";

  const auto ended = run(
      {TAKT, "export", "json", demo("two_axes"), "-o", (folder / "taken").string()}, folder.path());

  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.output, HasSubstr((folder / "taken").string()));
  EXPECT_EQ(read_file(folder / "taken"), "a file");
}

}  // namespace
}  // namespace takt::test
