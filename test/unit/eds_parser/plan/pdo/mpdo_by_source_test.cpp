// RPDOs that the master sends by source address: `mpdo: sam` and the dispatcher list of the device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "eds_parser/print/plan/print_plan.hpp"
#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using test::compile;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string dispatcher(int sub, const std::string& access, const std::string& value) {
  return "[1FD0sub" + std::to_string(sub) +
         "]\nParameterName=Entry\nObjectType=0x7\nDataType=0x1B\nAccessType=" + access +
         "\nDefaultValue=" + value + "\nPDOMapping=0\n";
}

/// Makes the tiny drive with an object dispatcher list of two entries.
std::string eds(const std::string& first = "0", const std::string& second = "0",
                const std::string& access = "rw") {
  return test::tiny_eds() + test::record("1FD0", "Dispatching list", 3) +
         test::entry("1FD0sub0", "highest", 5, "const", "2") + dispatcher(1, access, first) +
         dispatcher(2, access, second);
}

/// Makes a network with an RPDO2 by source address; `lines` adds lines to the node.
std::string arm(const std::string& objects, const std::string& lines = "") {
  return "master: {sync_period: 10000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n" +
         lines + "    rpdo: {2: {mpdo: sam, transmission: 255, mapping: [" + objects + "]}}\n";
}

std::vector<PdoRow> rows(const test::Compiled& net) {
  std::vector<PdoRow> found;
  for (const PdoRow& row : net.plan.pdos.rpdos) {
    if (row.number == 2) found.push_back(row);
  }
  return found;
}

// 6081:00 and 607A:00 of the device are 6081:00 and 2100:03 of node 127.
TEST(MpdoBySource, HasTheMastersAddressAndTheObjectThatTheDeviceAwaits) {
  const auto net = compile(arm("{index: 0x6081}, {index: 0x607A}"),
                           eds("0x016081006081007F", "0x01607A002100037F"));
  EXPECT_THAT(net.complaints(), IsEmpty());
  ASSERT_EQ(rows(net).size(), 2U);
  EXPECT_EQ(rows(net)[0].header, 0x0060'817FU);
  EXPECT_EQ(rows(net)[1].header, 0x0321'007FU);
  EXPECT_EQ(rows(net)[1].length, 8);
  const PdoField& field = net.plan.pdos.fields[rows(net)[1].first_field];
  EXPECT_EQ(field.bit_offset, 32);
  EXPECT_EQ(field.bits, 32);
  EXPECT_EQ(net.plan.layout.signals[field.signal].object, (ObjectKey{0x607A, 0}));
  std::ostringstream text;
  print_plan_text(text, net.plan, {.node = {}, .realtime = {}, .lcm = {}});
  EXPECT_THAT(text.str(), HasSubstr("MPDO by source, as 2100:03 of the master"));
}

TEST(MpdoBySource, MarksTheMappingOfTheDevice) {
  const auto net = compile(arm("{index: 0x6081}"), eds("0x016081006081007F"));
  const auto& steps = net.plan.nodes[0].boot_plan.steps;
  const auto mark = std::ranges::find_if(
      steps, [](const BootStep& step) { return step.purpose.starts_with("RPDO2 mapping on"); });
  ASSERT_NE(mark, steps.end());
  EXPECT_EQ(mark->value, std::vector{std::byte{0xFE}});
}

TEST(MpdoBySource, FollowsABlockOfTheDispatchingList) {
  const auto net = compile(arm("{index: 0x60C2, sub_index: 2}"), eds("0x0260C2012200057F"));
  EXPECT_THAT(net.complaints(), IsEmpty());
  ASSERT_EQ(rows(net).size(), 1U);
  EXPECT_EQ(rows(net)[0].header, 0x0622'007FU);
}

TEST(MpdoBySource, TakesTheListAsTheNetworkFileWritesIt) {
  const std::string written =
      "    sdo: [{index: 0x1FD0, sub_index: 2, value: 0x016081006081007F}]\n";
  const auto net = compile(arm("{index: 0x6081}", written), eds("0x016081002000007F"));
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(rows(net)[0].header, 0x0020'007FU) << "the first entry that fits";
  EXPECT_THAT(compile(arm("{index: 0x6081}", written), eds()).complaints(), IsEmpty());
}

TEST(MpdoBySource, ReportsWhatToWriteWhereTheDeviceAwaitsNothing) {
  const auto net = compile(arm("{index: 0x6081}"), eds("0x0160810060810006"));
  EXPECT_THAT(net.complaints(), ElementsAre("6:56 error [dispatching-list]"));
  EXPECT_THAT(net.declared("dispatching-list"),
              HasSubstr("takes 6081:00 from the master, node 127: write one under `sdo:`, "
                        "`{index: 0x1FD0, sub_index: 2, value: 0x016081006081007F}`"));
}

TEST(MpdoBySource, ProposesAPlaceForEachObjectAsLongAsThereIsOne) {
  const auto net = compile(arm("{index: 0x6081}, {index: 0x607A}, {index: 0x60FF}"), eds());
  const std::string declared = net.declared("dispatching-list");
  EXPECT_THAT(declared, HasSubstr("sub_index: 1, value: 0x016081006081007F"));
  EXPECT_THAT(declared, HasSubstr("sub_index: 2, value: 0x01607A00607A007F"));
  EXPECT_THAT(declared,
              HasSubstr("takes 60FF:00 from the master, node 127: the list has no free entry"));
}

TEST(MpdoBySource, NeedsADispatchingList) {
  EXPECT_THAT(compile(arm("{index: 0x6081}")).declared("dispatching-list"),
              HasSubstr("tiny.eds has no object dispatching list"));
  EXPECT_THAT(compile(arm("{index: 0x6081}"), eds("0", "0", "ro")).declared("dispatching-list"),
              HasSubstr("tiny.eds has no object dispatching list"));
}

TEST(MpdoBySource, DoesNotSendTwoObjectsUnderOneName) {
  const auto net = compile(arm("{index: 0x6081}, {index: 0x607A}"),
                           eds("0x016081002100037F", "0x01607A002100037F"));
  EXPECT_THAT(net.declared("dispatching-list"), HasSubstr("both would overwrite each other"));
}

}  // namespace
}  // namespace takt
