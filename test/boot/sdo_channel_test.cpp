// Boots over a second SDO server: `sdo_channel`, 0x1201.
#include <gmock/gmock.h>

#include "test/boot/plant.hpp"

namespace takt {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::Not;

LoadedNetwork over(const std::string& channel) {
  return network_of(
      "bus: {interface: can0}\nmaster: {sync_period: 10000}\nnodes:\n"
      "  device: {node_id: 5, dcf: two_servers.eds, sdo: [{index: 0x2000, value: 7}], "
      "sdo_channel: " +
      channel + "}\n");
}

std::string warnings(const LoadedNetwork& network) {
  std::string text;
  for (const Finding& finding : network.findings) {
    if (finding.rule == "no-sdo-server") text += finding.message;
  }
  return text;
}

TEST(SdoChannelBoot, GoesOverTheSecondServerOfTheDevice) {
  LoadedNetwork network = over("{request: 0x645, answer: 0x5C5}");
  EXPECT_EQ(warnings(network), "");
  Plant plant{std::move(network)};

  plant.run(3s);

  EXPECT_EQ(plant.node().nmt, NmtState::operational);
  EXPECT_EQ(plant.device(5).objects().number({0x2000, 0}, 0), 7U);
  EXPECT_GT(plant.frames(0x645), 0);
  EXPECT_GT(plant.frames(0x5C5), 0);
  EXPECT_EQ(plant.frames(0x605), 0) << "the first server is left to others";
  EXPECT_EQ(plant.frames(0x585), 0);
}

TEST(SdoChannelBoot, NamesTheChannelWhereNobodyAnswersOnIt) {
  LoadedNetwork network = over("{request: 0x6C5, answer: 0x6E5}");
  EXPECT_THAT(warnings(network), HasSubstr("0x1201: 0x645 and 0x5C5"));
  Plant plant{std::move(network)};

  plant.run(5s);

  const std::string report = plant.text_of(EventKind::boot_failed);
  EXPECT_THAT(report, HasSubstr("sent      6C5  40 00 10 00"));
  EXPECT_THAT(report, HasSubstr("SDO channel of `sdo_channel` (0x6C5 and 0x6E5)"));
  EXPECT_THAT(report, HasSubstr("`takt sdo read 5 1201:01 --bus can0`"));
}

TEST(SdoChannelBoot, DoesNotBlameAChannelThatHasAnswered) {
  sim::Fault mute{.kind = sim::FaultKind::mute_sdo, .node = 5_node};
  mute.object = {0x2000, 0};
  Plant plant{over("{request: 0x645, answer: 0x5C5}"), {mute}};

  plant.run(5s);

  const std::string report = plant.text_of(EventKind::boot_failed);
  EXPECT_THAT(report, HasSubstr("read 2000:00"));
  EXPECT_THAT(report, Not(HasSubstr("sdo_channel")));
}

/// Until the boot of node 1 has disabled its second channel, both nodes answer requests to node 65.
TEST(SdoChannelBoot, OfTwoLenzes64IdsApartGoesWellWhereTheNetworkFileSwitchesTheChannelOff) {
  const std::string lenze = "dcf: " TAKT_SOURCE_DIR "/share/eds/lenze8400.eds";
  const std::string off = ", sdo: [{index: 0x1201, sub_index: 1, value: 0x80000000}]";
  Plant plant{
      network_of("master: {sync_period: 10000, node_id: 127}\nnodes:\n  pump: {node_id: 1, " +
                 lenze + off + "}\n  fan: {node_id: 65, " + lenze + off + "}\n")};

  plant.run(10s);

  EXPECT_EQ(plant.node(0).nmt, NmtState::operational);
  EXPECT_EQ(plant.node(1).nmt, NmtState::operational);
  EXPECT_EQ(plant.device(1).objects().number({0x1201, 1}, 0), 0x8000'0000U);
}

}  // namespace
}  // namespace takt
