#include "apps/takt/import/nodelist.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/network_file/load_network.hpp"
#include "test/unit/apps/takt/import/import_fixture.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;
using test::Import;
using testing::HasSubstr;

class Nodelist : public Import {
 protected:
  void SetUp() override {
    Import::SetUp();
    fs::create_directories(folder_ / "eds");
    fs::create_directories(folder_ / "out");
    const std::string eds = TAKT_SOURCE_DIR "/share/eds/plain301.eds";
    for (const auto* name : {"io.dcf", "eds/pump.dcf", "master.dcf"}) {
      fs::copy_file(eds, folder_ / name, fs::copy_options::overwrite_existing);
    }
    std::ofstream{folder_ / "io.dcf", std::ios::app}
        << "\n[DeviceComissioning]\nNodeID=5\nBaudrate=250\n";
    std::ofstream{folder_ / "master.dcf", std::ios::app}
        << "\n[DeviceComissioning]\nNodeID=1\nCANopenManager=1\n";
  }

  ImportedNodelist import(const std::string& text, unsigned number = 1) {
    std::ofstream{folder_ / "nodelist.cpj"} << text;
    return import_nodelist(folder_ / "nodelist.cpj", number, folder_ / "out");
  }

  static constexpr const char* lift =
      "[Topology]\nNetName=Lift 1\nNetRefd=drawing 7\nNodes=0x03\n"
      "Node1Present=0x01\nNode1DCFName=master.dcf\n"
      "Node5Present=0x01\nNode5Name=Door I/O\nNode5Refd=A5\nNode5DCFName=io.dcf\n"
      "Node12Present=1\nNode12DCFName=pump.dcf\n"
      "Node20Present=0x00\nNode20Name=spare\n"
      "EDSBaseName=eds\nColour=red\n[Topology2]\nNetName=other\nNodes=0\n[Vendor]\nX=1\n";
};

TEST_F(Nodelist, BecomesANetworkFile) {
  const auto imported = import(lift);

  ASSERT_TRUE(imported.report.usable);
  EXPECT_EQ(imported.yaml,
            "# from nodelist.cpj, [Topology]\n"
            "bus:\n  name: lift_1\n  bitrate_kbit: 250  # Baudrate of the DCFs\n"
            "master:\n  node_id: 1\n"
            "  # sync_period: 10000  # us; without it there is no SYNC\n"
            "nodes:\n"
            "  door_i_o:\n    node_id: 5\n    dcf: \"../io.dcf\"\n"
            "  node12:\n    node_id: 12\n    dcf: \"../eds/pump.dcf\"\n");
}

TEST_F(Nodelist, IsANetworkThatLoads) {
  const auto imported = import(lift);
  std::ofstream{folder_ / "out/lift.yaml"} << imported.yaml;

  const auto network = load_network(folder_ / "out/lift.yaml");

  EXPECT_FALSE(has_error(network.findings));
  EXPECT_EQ(network.plan.name, "lift_1");
  ASSERT_EQ(network.plan.nodes.size(), 2U);
  EXPECT_EQ(network.plan.nodes[1].name, "node12");
}

TEST_F(Nodelist, NamesEveryKeyAsUsedOrIgnored) {
  const auto list = import(lift).report;

  EXPECT_EQ(list.keys.size(), 15U);
  EXPECT_EQ(key(list, "Topology.NetName").use, KeyUse::used);
  EXPECT_EQ(key(list, "Topology.NetRefd").use, KeyUse::ignored);
  EXPECT_EQ(key(list, "Topology.Node5Name").why, "name of the node, as `door_i_o`");
  EXPECT_EQ(key(list, "Topology.Node5Name").pos, (SourcePos{8, 11}));
  EXPECT_THAT(key(list, "Topology.Node1DCFName").why, HasSubstr("takt replaces this master"));
  EXPECT_EQ(key(list, "Topology.Node20Present").use, KeyUse::ignored);
  EXPECT_EQ(key(list, "Topology.EDSBaseName").use, KeyUse::used);
  EXPECT_EQ(key(list, "Topology.Colour").why, "not a key of CiA 306-3");
  EXPECT_EQ(list.others.size(), 2U);  // [Topology2], [Vendor]
}

TEST_F(Nodelist, SaysWhatIsWrongAndWritesNothing) {
  const std::string head = "[Topology]\nNodes=1\nNode5Present=1\n";
  for (const auto& [text, rule] : std::vector<std::pair<std::string, std::string>>{
           {"", "no-file"},
           {"[Foo]\nA=1\n", "no-topology"},
           {head, "missing-key"},
           {head + "Node5DCFName=no.dcf\n", "no-file"},
           {"[Topology]\nNodes=1\nNode128Present=1\n", "node-id-range"},
           {"[Topology]\nNodes=0\n", "no-nodes"}}) {
    const auto imported = import(text);

    EXPECT_FALSE(imported.report.usable) << text;
    EXPECT_TRUE(imported.yaml.empty());
    EXPECT_NE(std::ranges::count(imported.report.others, rule, &Finding::rule), 0) << text;
  }
  EXPECT_FALSE(import(lift, 3).report.usable);
}

TEST_F(Nodelist, WithoutAManagerTheMasterHasTheHighestFreeId) {
  std::string two = "[Topology]\nNodes=2\n";
  for (const char* id : {"127", "126"}) {
    two += "Node" + std::string{id} + "Present=1\nNode" + id + "DCFName=eds/pump.dcf\n";
  }
  std::string all = "[Topology]\nNodes=127\n";
  for (int id = 1; id <= 127; ++id) {
    const auto key = "Node" + std::to_string(id);
    all += key + "Present=1\n" + key + "DCFName=eds/pump.dcf\n";
  }

  EXPECT_THAT(import(two).yaml, HasSubstr("master:\n  node_id: 125\n"));
  EXPECT_FALSE(import(all).report.usable);
  EXPECT_NE(std::ranges::count(import(all).report.others, "no-free-id", &Finding::rule), 0);
}

TEST_F(Nodelist, AWrongCountAndTwoEqualNamesAreReported) {
  const auto imported = import(
      "[TOPOLOGY]\nNodes=7\nNode5Present=1\nNode5Name=io\nNode5DCFName=io.dcf\n"
      "Node6Present=1\nNode6Name=IO\nNode6DCFName=io.dcf\n");

  EXPECT_TRUE(imported.report.usable);
  EXPECT_EQ(key(imported.report, "TOPOLOGY.Nodes").use, KeyUse::suspicious);
  EXPECT_THAT(imported.yaml, HasSubstr("  io_6:\n    node_id: 6\n"));
  EXPECT_THAT(key(imported.report, "TOPOLOGY.Node6DCFName").why,
              HasSubstr("the NodeID of the file is 5"));
}

}  // namespace
}  // namespace takt
