#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

#include "eds_parser/print/findings_json.hpp"
#include "eds_parser/print/print_dictionary.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

nlohmann::json json_of(const EdsFile& file) {
  std::ostringstream out;
  print_json(out, file.dictionary, file.findings);
  return nlohmann::json::parse(out.str());
}

nlohmann::json first_default(std::string_view type, std::string_view value,
                             std::optional<NodeId> node = 5_node) {
  const auto json = json_of(read_eds(test::var(type, value), "t.eds", node));
  return json["objects"][0]["subs"][0]["default"];
}

TEST(EdsJson, ListsTheFindingsOfEveryFile) {
  const auto good = read_eds("[1000]\nParameterName=x\nDataType=7\nAccessType=ro\n", "good.eds");
  const JudgedFile files[] = {
      {"bad.eds", false, {{"bad.eds", {3, 7}, Severity::error, "some-rule", "w\xE4r"}}},
      {"good.eds", good.readable, {}}};
  std::ostringstream out;

  print_findings_json(out, files);

  const auto json = nlohmann::json::parse(out.str());
  EXPECT_EQ(json["files"][0]["file"], "bad.eds");
  EXPECT_EQ(json["files"][0]["readable"], false);
  EXPECT_EQ(json["files"][0]["findings"][0]["line"], 3);
  EXPECT_EQ(json["files"][0]["findings"][0]["column"], 7);
  EXPECT_EQ(json["files"][0]["findings"][0]["severity"], "error");
  EXPECT_EQ(json["files"][0]["findings"][0]["rule"], "some-rule");
  EXPECT_EQ(json["files"][1]["readable"], true);
  EXPECT_TRUE(json["files"][1]["findings"].empty());
  EXPECT_EQ(json["errors"], 1);
  EXPECT_EQ(json["warnings"], 0);
}

TEST(EdsJson, KeepsNumbersAsNumbersToTheLastBit) {
  EXPECT_EQ(first_default("0x1B", "18446744073709551615").dump(), "18446744073709551615");
  EXPECT_EQ(first_default("0x15", "-9223372036854775808").dump(), "-9223372036854775808");
  EXPECT_EQ(first_default("0x04", "0x80000001").dump(), "-2147483647");
  EXPECT_EQ(first_default("0x08", "0.5").dump(), "0.5");
  EXPECT_EQ(first_default("0x11", "nan").dump(), "\"nan\"");
  EXPECT_EQ(first_default("0x11", "-inf").dump(), "\"-inf\"");
  EXPECT_EQ(first_default("0x09", "007").dump(), "\"007\"");
  EXPECT_EQ(first_default("0x0A", "01A1").dump(), "\"01a1\"");
  EXPECT_EQ(first_default("0x0F", "").dump(), "null");
  EXPECT_EQ(first_default("0x07", "$NODEID+1", std::nullopt).dump(), "null");
}

TEST(EdsJson, HasTheShapeOfTheContract) {
  const auto json = json_of(read_eds_file(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds", 5_node));

  EXPECT_EQ(json["kind"], "eds");
  EXPECT_EQ(json["node_id"], 5);
  EXPECT_EQ(json["device"]["vendor_number"], 0xABCD);
  EXPECT_EQ(json["device"]["baud_rates_kbit"],
            nlohmann::json({10, 20, 50, 125, 250, 500, 800, 1000}));
  EXPECT_EQ(json["objects"][0].dump(),
            R"({"index":4096,"list":"mandatory","name":"Device type","object_type":7,"subs":[)"
            R"({"access":"ro","data_type":7,"default":131474,"default_text":"0x00020192",)"
            R"("high_limit":null,"low_limit":null,"name":"Device type","pdo_mappable":false,)"
            R"("sub":0,"value":131474}]})");
  EXPECT_EQ(json["rpdos"][0].dump(),
            R"({"bits":48,"cob_id":517,"event_timer_ms":0,"extended":false,"inhibit_time_us":0,)"
            R"("mapping":[{"bit_offset":0,"bits":16,"index":24640,"name":"Controlword","sub":0},)"
            R"({"bit_offset":16,"bits":32,"index":24698,"name":"Target position","sub":0}],)"
            R"("number":1,"rtr_allowed":true,"sync_start":null,"transmission_type":1,)"
            R"("valid":true})");
  EXPECT_EQ(json["tpdos"].size(), 4U);
  EXPECT_EQ(json["diagnostics"].size(), 0U);
}

constexpr std::string_view in_plant = R"([DeviceComissioning]
NodeID=5
NodeName=hoist
NodeRefd==A1-M3
Baudrate=500
NetNumber=2
NetworkName=lift
LSS_SerialNumber=0x12345678
[M1ModuleInfo]
ProductName=Digital input
ProductVersion=1
ProductRevision=0
OrderCode=MOD-DI-8
[M1SubExt6000]
ParameterName=Input
DataType=5
AccessType=ro
Count=1
[ConnectedModules]
NrOfEntries=2
1=1
2=1
[1000]
ParameterName=Device type
DataType=7
AccessType=ro
ParamRefd=P1
)";

TEST(EdsJson, ReportsWhatTheNodeIsCalledElsewhereAndItsModules) {
  const auto json = json_of(read_eds(in_plant, "t.dcf"));

  EXPECT_EQ(json["commissioning"].dump(),
            R"({"baudrate_kbit":500,"canopen_manager":false,"lss_serial_number":305419896,)"
            R"("net_number":2,"net_refd":"","network_name":"lift","node_id":5,)"
            R"("node_name":"hoist","node_refd":"=A1-M3"})");
  EXPECT_EQ(json["parameter_references"].dump(), R"([{"index":4096,"param_refd":"P1","sub":0}])");
  EXPECT_EQ(json["modules"].dump(),
            R"([{"number":1,"order_code":"MOD-DI-8","product_name":"Digital input",)"
            R"("product_revision":"0","product_version":"1"}])");
  EXPECT_EQ(json["connected_modules"], nlohmann::json({1, 1}));
  EXPECT_TRUE(json_of(read_eds("[1000]\nDataType=7\n", "t.eds"))["commissioning"].is_null());
}

TEST(EdsJson, ListsFindingsWithTheirPlace) {
  const auto json =
      json_of(read_eds("[1000]\nDataType=7\nParameterName=x\nAccessType=ro\n"
                       "Strange=1\n",
                       "t.eds"));

  const auto& all = json["diagnostics"];
  const auto it =
      std::ranges::find_if(all, [](const auto& f) { return f["rule"] == "unknown-key"; });
  ASSERT_NE(it, all.end());
  EXPECT_EQ((*it)["line"], 5);
  EXPECT_EQ((*it)["column"], 1);
  EXPECT_EQ((*it)["severity"], "warning");
}

TEST(EdsText, ShowsWhatTheNodeIsCalledElsewhereAndItsModules) {
  std::ostringstream out;
  print_text(out, read_eds(in_plant, "t.dcf").dictionary);

  EXPECT_NE(
      out.str().find("\n  node name   hoist  reference =A1-M3\n"
                     "  network     lift  number 2\n"
                     "  LSS serial  0x12345678\n"
                     "  module      M1  Digital input  version 1.0  MOD-DI-8  (2 connected)\n"),
      std::string::npos)
      << out.str();
  EXPECT_TRUE(out.str().ends_with("\nReferences (1)\n  1000:00   P1\n")) << out.str();
}

TEST(EdsText, ShowsPdosAndObjectsOnLinesOfTheirOwn) {
  const auto file = read_eds_file(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds", 5_node);
  std::ostringstream out;
  print_text(out, file.dictionary);

  EXPECT_NE(out.str().find("\n  TPDO1   0x185      on   type 1   every SYNC            48 bits\n"
                           "      byte 0..1   6041:00  Statusword"),
            std::string::npos);
  EXPECT_NE(out.str().find("\n  1014      COB-ID EMCY "), std::string::npos);
  EXPECT_NE(out.str().find("133 ($NODEID+0x80)\n"), std::string::npos);
}

TEST(EdsText, ShowsTheDenotationsOfADcf) {
  const auto file = read_eds(
      "[2000]\nParameterName=a\nObjectType=8\nSubNumber=2\nDenotation=axes\n"
      "[2000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n"
      "[2000sub1]\nParameterName=v\nDataType=6\nAccessType=rw\nDenotation=lift\n",
      "t.dcf");
  std::ostringstream out;

  print_text(out, file.dictionary);

  EXPECT_TRUE(out.str().ends_with("\nDenotations\n  2000      axes\n  2000:01   lift\n"))
      << out.str();
  EXPECT_EQ(json_of(file)["objects"][0]["denotation"], "axes");
  EXPECT_EQ(json_of(file)["objects"][0]["subs"][1]["denotation"], "lift");
}

}  // namespace
}  // namespace takt
