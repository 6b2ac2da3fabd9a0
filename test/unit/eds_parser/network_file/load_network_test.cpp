#include "eds_parser/network_file/load_network.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

#include "eds_parser/check/check.hpp"
#include "eds_parser/print/plan/print_plan.hpp"
#include "eds_parser/read/eds.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const fs::path source = TAKT_SOURCE_DIR;

std::string read(const fs::path& path) {
  std::ifstream in{path};
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::vector<std::string> findings(const LoadedNetwork& network, Severity least) {
  std::vector<std::string> out;
  for (const Finding& finding : network.findings) {
    if (finding.severity >= least) out.push_back(to_string(finding));
  }
  return out;
}

TEST(LoadNetwork, TheDemoLoadsWithoutAFinding) {
  const auto network = load_network(source / "share/demo/two_axes.yaml");

  EXPECT_THAT(findings(network, Severity::note), IsEmpty());
  EXPECT_EQ(network.plan.name, "demo");
  EXPECT_TRUE(network.bus_named);
  ASSERT_EQ(network.devices.size(), 3U);
  EXPECT_EQ(network.devices[0].model, "drive402");
  EXPECT_EQ(network.devices[2].model, "io401");
  EXPECT_EQ(network.devices[2].node, 10_node);
}

TEST(LoadNetwork, TheFolderOfTheBlackBoxIsBesideTheNetworkFile) {
  const test::Folder folder;
  const std::string node =
      "nodes: {io: {node_id: 5, dcf: " + (source / "share/eds/takt_io401.eds").string() + "}}\n";
  const auto network = load_network(
      folder.write("box.yaml", "black_box: {folder: box, size_mb: 2, keep: 3}\n" + node));
  const auto absolute =
      load_network(folder.write("far.yaml", "black_box: {folder: /var/lib/takt}\n" + node));
  const auto none = load_network(folder.write("none.yaml", node));

  EXPECT_THAT(findings(network, Severity::warning), IsEmpty());
  EXPECT_EQ(network.recording.folder, (folder.path() / "box").string());
  EXPECT_EQ(network.recording.bytes, std::size_t{2} << 20);
  EXPECT_EQ(network.recording.keep, 3U);
  EXPECT_EQ(absolute.recording.folder, "/var/lib/takt");
  EXPECT_EQ(none.recording.folder, "");
}

/// A person must review the golden plan when it changes: `takt plan share/demo/two_axes.yaml >
/// two_axes.plan.txt`.
TEST(LoadNetwork, ThePlanOfTheDemoIsTheGoldenOne) {
  const auto network = load_network(source / "share/demo/two_axes.yaml");

  std::ostringstream out;
  print_plan_text(out, network.plan,
                  {.node = {}, .realtime = network.realtime, .lcm = network.lcm});

  EXPECT_EQ(out.str(), read(source / "test/unit/eds_parser/network_file/data/two_axes.plan.txt"));
}

TEST(LoadNetwork, ThePlanAsJsonSaysTheSame) {
  const auto network = load_network(source / "share/demo/two_axes.yaml");

  std::ostringstream out;
  print_plan_json(out, network.plan, {.node = {}, .realtime = {}, .lcm = {}});
  const auto json = nlohmann::json::parse(out.str());

  EXPECT_EQ(json["bus"], "demo");
  EXPECT_EQ(json["cycle"]["period_us"], 2000.0);
  EXPECT_EQ(json["cycle"]["acts_at_sync"], "k+1");
  const auto& node = json["nodes"][0];
  EXPECT_EQ(node["identity"]["device_type"], 0x20192);
  EXPECT_EQ(node["identity"]["product_code"], 0x402);
  EXPECT_EQ(node["sdo_request_cob_id"], 0x601);
  EXPECT_EQ(json["nodes"][1]["name"], "elbow");
  EXPECT_EQ(json["nodes"][1]["tpdos"][0]["cob_id"], 0x182);
  EXPECT_EQ(json["nodes"][0]["boot_plan"][0]["frame"], "000#8201");
  EXPECT_EQ(json["image"]["signals"].size(), network.plan.layout.signals.size());
  EXPECT_EQ(json["image"]["hash"], network.plan.layout.hash);
  EXPECT_EQ(json["lcm"]["channels"][0]["channel"], "DEMO_IMAGE");
}

TEST(LoadNetwork, TheIdentityInJsonIsThatOfTheDeviceAndNothingElseThatTheBootExpects) {
  auto network = load_network(source / "share/demo/two_axes.yaml");
  const auto expect = [](ObjectKey object, std::byte value) {
    BootStep step;
    step.action = BootAction::expect;
    step.object = object;
    step.value = {value, std::byte{}, std::byte{}, std::byte{}};
    step.purpose = "whatever";
    return step;
  };
  auto& steps = network.plan.nodes[0].boot_plan.steps;
  steps.push_back(expect({0x1018, 3}, std::byte{7}));
  steps.push_back(expect({0x1018, 4}, std::byte{9}));
  steps.push_back(expect({0x1F57, 1}, std::byte{1}));
  steps.push_back(expect({0x1018, 5}, std::byte{1}));

  std::ostringstream out;
  print_plan_json(out, network.plan, {});

  const auto identity = nlohmann::json::parse(out.str())["nodes"][0]["identity"];
  const auto expected = nlohmann::json::parse(
      R"({"device_type": 131474, "vendor_id": 43981, "product_code": 1026,
          "revision_number": 7, "serial_number": 9})");
  EXPECT_EQ(identity, expected);
}

TEST(LoadNetwork, ABusYmlOfOtherMastersRunsUnchanged) {
  const auto network = load_network(source / "test/unit/eds_parser/network_file/data/bus.yml");

  EXPECT_THAT(findings(network, Severity::warning), ElementsAre(HasSubstr("[on-loss]")));
  ASSERT_EQ(network.plan.nodes.size(), 2U);
  EXPECT_EQ(network.plan.bitrate, 500'000U);
  EXPECT_EQ(network.plan.layout.signals.size(), 16U);
  EXPECT_EQ(network.plan.nodes[1].heartbeat_timeout, std::chrono::milliseconds{500});
  EXPECT_TRUE(network.plan.nodes[1].mandatory);
  EXPECT_FALSE(network.bus_named);
}

TEST(LoadNetwork, BusFilesOfTheWildLoadWithoutError) {
  const char* folder = std::getenv("TAKT_BUS_YML");
  const fs::path root = folder != nullptr ? fs::path{folder} : source / "../shared/bus_yml";
  std::error_code error;
  for (const auto& entry : fs::directory_iterator{root, error}) {
    if (!fs::exists(entry.path() / "bus.yml")) continue;
    const auto network = load_network(entry.path() / "bus.yml");
    const auto errors = findings(network, Severity::error);
    if (entry.path().filename() == "cia402_multichannel_system") {
      ASSERT_EQ(errors.size(), 1U);
      EXPECT_THAT(errors[0], HasSubstr("bus.yml:18:10: error: node `cia402_multichannel_device`: "
                                       "device file `cia402_slave_multichannel.eds` not found"));
    } else {
      EXPECT_THAT(errors, IsEmpty()) << entry.path();
      EXPECT_FALSE(network.plan.layout.signals.empty());
    }
  }
}

TEST(LoadNetwork, DeviceFilesAreFoundBesideTheFileAndInDcfPath) {
  const test::Folder folder;
  const std::string eds = read(source / "share/eds/takt_io401.eds");
  fs::create_directories(folder.path() / "eds");
  folder.write("near.eds", eds);
  folder.write("eds/far.eds", eds);
  const auto file = folder.write("net.yaml",
                                 "options: {dcf_path: eds}\n"
                                 "master: {sync_period: 10000}\n"
                                 "nodes:\n"
                                 "  a: {node_id: 1, dcf: \"@CONFIG@/near.eds\"}\n"
                                 "  b: {node_id: 2, dcf: far.eds}\n"
                                 "  c: {node_id: 3, dcf: gone.eds}\n");

  const auto network = load_network(file);

  EXPECT_EQ(network.plan.nodes.size(), 2U);
  const auto errors = findings(network, Severity::error);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_THAT(errors[0], HasSubstr("net.yaml:6:24: error: node `c`: device file `gone.eds` not "
                                   "found; looked for"));
  EXPECT_THAT(errors[0], HasSubstr("eds/gone.eds"));
}

TEST(LoadNetwork, OfADeviceFileWithoutObjectsTheErrorsAreThoseOfTheFile) {
  const test::Folder folder;
  folder.write("d.eds", "[FileInfo]\nFileName=d.eds\n");
  const auto file = folder.write("net.yaml",
                                 "master: {sync_period: 10000}\n"
                                 "a: {node_id: 1, dcf: d.eds}\n");

  const auto network = load_network(file);

  const auto at = std::ranges::find(network.findings, "no-device-file", &Finding::rule);
  ASSERT_NE(at, network.findings.end());
  EXPECT_EQ(at->severity, Severity::note);
  EXPECT_TRUE(has_error(network.findings));
}

TEST(LoadNetwork, APathThroughALinkIsThatOfTheSystem) {
  const test::Folder folder;
  std::string eds = read(source / "share/eds/takt_io401.eds");
  folder.write("d.eds", eds);
  const std::string name = "ProductName=";
  eds.insert(eds.find(name) + name.size(), "behind the link ");
  folder.write("far/d.eds", eds);
  fs::create_directories(folder.path() / "far/inside");
  fs::create_directory_symlink("far/inside", folder.path() / "link");
  const auto file = folder.write("net.yaml",
                                 "master: {sync_period: 10000}\n"
                                 "a: {node_id: 1, dcf: link/../d.eds}\n");

  const auto network = load_network(file);

  ASSERT_EQ(network.plan.nodes.size(), 1U);
  EXPECT_THAT(network.plan.nodes[0].product_name, HasSubstr("behind the link"));
}

TEST(LoadNetwork, FindingsOfADeviceFileAreOneLine) {
  const test::Folder folder;
  std::string eds = read(source / "share/eds/takt_io401.eds");
  eds.insert(eds.find("ParameterName=Device type"), "Nonsense=1\nPDOMapping=maybe\n");
  folder.write("d.eds", eds);
  const auto file = folder.write("net.yaml",
                                 "master: {sync_period: 10000}\n"
                                 "a: {node_id: 1, dcf: d.eds}\nb: {node_id: 2, dcf: d.eds}\n");

  const auto network = load_network(file);

  std::size_t lines = 0;
  for (const Finding& finding : network.findings) lines += finding.rule == "device-file";
  EXPECT_EQ(lines, 1U);
  EXPECT_THAT(findings(network, Severity::error), IsEmpty());
}

TEST(LoadNetwork, FindingsOfADeviceFileAreThoseOfEdsCheck) {
  const test::Folder folder;
  std::string eds = read(source / "share/eds/takt_io401.eds");
  eds.insert(eds.find("ParameterName=Device type"), "PDOMapping=maybe\n");
  const std::string mapped = "DefaultValue=0x60000108";  // 1A00:01; 1017:00 can't be mapped
  ASSERT_NE(eds.find(mapped), std::string::npos);
  eds.replace(eds.find(mapped), mapped.size(), "DefaultValue=0x10170010");
  const auto device = folder.write("d.eds", eds);
  const auto file =
      folder.write("net.yaml", "master: {sync_period: 10000}\na: {node_id: 1, dcf: d.eds}\n");

  const EdsFile read_file = read_eds_file(device, NodeId::from(1));
  Findings all = read_file.findings;
  for (const Finding& finding : check(read_file.dictionary)) all.push_back(finding);
  const auto errors = std::ranges::count(all, Severity::error, &Finding::severity);
  const auto warnings = std::ranges::count(all, Severity::warning, &Finding::severity);
  ASSERT_GT(errors, std::ranges::count(read_file.findings, Severity::error, &Finding::severity));
  ASSERT_GT(warnings, 0);

  const auto network = load_network(file);

  const auto line = std::ranges::find(network.findings, "device-file", &Finding::rule);
  ASSERT_NE(line, network.findings.end());
  EXPECT_EQ(line->severity, Severity::warning);
  EXPECT_THAT(line->message, AllOf(HasSubstr(std::to_string(errors) + " error"),
                                   HasSubstr(std::to_string(warnings) + " warning"),
                                   HasSubstr("`takt eds check --node 1 " + device.string())));
}

/// A DCF with a DOMAIN, and a network that has it.
struct DomainNetwork {
  test::Folder folder;

  LoadedNetwork load(const std::string& keys,
                     const std::string& object = "ObjectType=0x2\nDataType=0xF\n") {
    folder.write("cam.dcf", read(source / "share/eds/plain301.eds") +
                                "\n[2F00]\nParameterName=Cam table\n" + object + keys);
    return load_network(folder.write("net.yaml",
                                     "bus: {name: b, bitrate_kbit: 500}\nmaster: {sync_period: "
                                     "10000}\nnodes:\n  arm: {dcf: cam.dcf, "
                                     "node_id: 5}\n"));
  }
};

const BootStep* step_of(const LoadedNetwork& network, ObjectKey object) {
  if (network.plan.nodes.empty()) return nullptr;
  const auto& steps = network.plan.nodes[0].boot_plan.steps;
  const auto found = std::ranges::find(steps, object, &BootStep::object);
  return found == steps.end() ? nullptr : &*found;
}

TEST(LoadNetwork, ADomainGetsTheFileThatItsDcfNames) {
  DomainNetwork net;
  fs::create_directories(net.folder.path() / "tables");
  net.folder.write("tables/cam.bin", "12345678");

  const auto network = net.load("AccessType=wo\nDownloadFile=tables\\cam.bin\n");

  EXPECT_THAT(findings(network, Severity::error), IsEmpty());
  const auto* step = step_of(network, {0x2F00, 0});
  ASSERT_NE(step, nullptr);
  EXPECT_EQ(step->action, BootAction::download_program);
  EXPECT_EQ(step->value.size(), 8U);
  EXPECT_EQ(std::to_integer<char>(step->value[7]), '8');
  EXPECT_EQ(step->purpose, "DCF: 2F00:00 Cam table = file tables\\cam.bin, 8 bytes");
}

TEST(LoadNetwork, AShortDomainThatCanBeReadIsWrittenOnlyWhereItDiffers) {
  DomainNetwork net;
  net.folder.write("cam.bin", "12345678");

  const auto network = net.load("AccessType=rw\nDownloadFile=cam.bin\n");

  const auto* step = step_of(network, {0x2F00, 0});
  ASSERT_NE(step, nullptr);
  EXPECT_EQ(step->action, BootAction::write_if_differs);
}

TEST(LoadNetwork, AMissingFileOfADomainIsAnErrorAtItsLine) {
  DomainNetwork net;

  for (const std::string name : {"no.bin", "/etc/hostname", ".."}) {
    const auto network = net.load("AccessType=rw\nDownloadFile=" + name + "\n");

    const auto found = std::ranges::find(network.findings, "no-file", &Finding::rule);
    ASSERT_NE(found, network.findings.end()) << name;
    EXPECT_EQ(found->severity, Severity::error);
    EXPECT_THAT(found->file, testing::EndsWith("cam.dcf"));
    const std::string text = read(net.folder.path() / "cam.dcf");
    const auto lines =
        1 + std::count(text.begin(),
                       text.begin() + static_cast<std::ptrdiff_t>(text.find("DownloadFile")), '\n');
    EXPECT_EQ(found->pos.line, lines);
    EXPECT_THAT(found->message, HasSubstr(name));
  }
}

TEST(LoadNetwork, AFileForWhatIsNoDomainIsLeftOut) {
  DomainNetwork net;
  net.folder.write("cam.bin", "12345678");

  const auto network = net.load("AccessType=rw\nDownloadFile=cam.bin\nUploadFile=back.bin\n",
                                "ObjectType=0x7\nDataType=0x7\n");

  EXPECT_THAT(findings(network, Severity::note), testing::Contains(HasSubstr("it was left out")));
  EXPECT_THAT(findings(network, Severity::note), testing::Contains(HasSubstr("`takt sdo upload`")));
  EXPECT_EQ(step_of(network, {0x2F00, 0}), nullptr);
}

TEST(LoadNetwork, WhatIsNoFileIsAnErrorNotACrash) {
  EXPECT_TRUE(has_error(load_network("/nonexistent/net.yaml").findings));
  EXPECT_TRUE(has_error(load_network("/").findings));
  EXPECT_TRUE(has_error(load_network("/dev/null").findings));
}

/// Every prefix and every single-byte change of a real file ends with findings, never with a crash.
TEST(LoadNetwork, SurvivesDamagedFiles) {
  const test::Folder folder;
  folder.write("d.eds", read(source / "share/eds/takt_io401.eds"));
  const std::string good =
      "bus: {name: x}\nmaster: &m {sync_period: 5000}\nnodes:\n  a:\n    node_id: 1\n"
      "    dcf: d.eds\n    tpdo: {1: {mapping: [{index: 0x6000, sub_index: 1}]}}\n"
      "    units: {position: {scale: 1.5e-3, unit: m}}\n";

  for (std::size_t i = 0; i < good.size(); i += 3) {
    for (const char c : {'\0', '*', '[', ':', '\xFF', '-'}) {
      std::string bad = good;
      bad[i] = c;
      static_cast<void>(load_network(folder.write("net.yaml", bad)));
    }
    static_cast<void>(load_network(folder.write("net.yaml", good.substr(0, i))));
  }
}

}  // namespace
}  // namespace takt
