#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

TEST(EdsInPlant, KeepsWhatADcfSaysOfTheNodeInItsPlant) {
  const auto file = read_eds(std::string{test::base} + R"([DeviceComissioning]
NodeID=5
NodeName=hoist
NodeRefd==A1-M3
Baudrate=500
NetNumber=2
NetworkName=lift
NetRefd==A1
LSS_SerialNumber=0x12345678
[2000]
ParameterName=Gain
DataType=6
AccessType=rw
ParamRefd=P 12.3
[2001]
ParameterName=Limits
ObjectType=9
SubNumber=2
ParamRefd=L 1
[2001sub0]
ParameterName=n
DataType=5
AccessType=ro
DefaultValue=1
[2001sub1]
ParameterName=Speed
DataType=6
AccessType=rw
ParamRefd=L 1.1
)",
                             "lift.dcf");

  const auto& node = file.dictionary.commissioning;
  EXPECT_EQ(node.node_refd, "=A1-M3");
  EXPECT_EQ(node.net_number, 2U);
  EXPECT_EQ(node.net_refd, "=A1");
  EXPECT_EQ(node.serial_number, 0x12345678U);
  EXPECT_EQ(node.pos, (SourcePos{test::line_of(1), 1}));
  const auto& references = file.dictionary.parameter_references;
  ASSERT_EQ(references.size(), 3U);
  EXPECT_EQ(references[0].index, 0x2000);
  EXPECT_EQ(references[0].sub, 0);
  EXPECT_EQ(references[0].text, "P 12.3");
  EXPECT_EQ(references[1].index, 0x2001);
  EXPECT_EQ(references[1].sub, std::nullopt);
  EXPECT_EQ(references[2].sub, 1);
  EXPECT_EQ(references[2].text, "L 1.1");
}

TEST(EdsInPlant, SaysThatASerialNumberCannotBeRead) {
  const auto file = read_eds("[DeviceComissioning]\nNodeID=5\nLSS_SerialNumber=A-17\n", "x.dcf");

  ASSERT_TRUE(test::has(file.findings, "number-unreadable"));
  EXPECT_EQ(test::find(file.findings, "number-unreadable")->pos, (SourcePos{3, 18}));
  EXPECT_EQ(file.dictionary.commissioning.serial_number, 0U);
}

}  // namespace
}  // namespace takt
