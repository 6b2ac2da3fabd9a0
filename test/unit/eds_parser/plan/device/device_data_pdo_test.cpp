#include <algorithm>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using test::compile_device_file;
using test::drv28;
using test::lenze8400;

using Complaints = std::vector<std::string>;

TEST(DeviceDataPdos, RefusesTransmissionTypesThatADrv28Lacks) {
  for (const char* type : {"0", "252", "253"}) {
    const auto net = drv28(std::string{"tpdo: {2: {transmission: "} + type + "}}");

    EXPECT_FALSE(net.complaints().empty()) << type;
  }
  const std::string declared = drv28("tpdo: {2: {transmission: 0}}").declared("device-data");
  EXPECT_NE(declared.find("TPDO2 of node `pump` can't have transmission type 0 on Astraada DRV-28, "
                          "which allows only 1..240, 254, 255"),
            std::string::npos)
      << declared;
  EXPECT_NE(declared.find("astraada_drv28.yaml:"), std::string::npos);
}

TEST(DeviceDataPdos, RefusesAnotherTypeOrATimerForTheParameterChannelOfADrv28) {
  EXPECT_EQ(drv28("tpdo: {1: {transmission: 254}}").complaints(),
            Complaints{"2:53 error [device-data]"});
  EXPECT_EQ(drv28("tpdo: {1: {transmission: 255, event_timer: 100}}").complaints(),
            Complaints{"2:71 error [device-data]"});
  EXPECT_EQ(drv28("tpdo: {1: {transmission: 255, event_timer: 0}}").complaints(), Complaints{});
}

TEST(DeviceDataPdos, CountsInhibitTimesOfADrv28InMilliseconds) {
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

TEST(DeviceDataPdos, RefusesInhibitTimesOfADrv28BelowItsLeastOrBetweenMilliseconds) {
  EXPECT_EQ(drv28("tpdo: {3: {inhibit_time: 490}}").declared("device-data").substr(0, 48),
            "the inhibit time of TPDO3 of node `pump` is 49 m");
  EXPECT_EQ(drv28("tpdo: {3: {inhibit_time: 500}}").complaints(), Complaints{});
  EXPECT_EQ(drv28("tpdo: {3: {inhibit_time: 1005}}").complaints(),
            Complaints{"2:53 error [device-data]"});
  EXPECT_EQ(drv28("tpdo: {3: {inhibit_time: 0}}").complaints(),
            Complaints{"2:53 error [device-data]"});
  EXPECT_EQ(drv28("sdo: [{index: 0x1802, sub_index: 3, value: 20}]").complaints(),
            Complaints{"2:34 error [device-data]"});
}

TEST(DeviceDataPdos, RefusesReservedTypesOfALenze) {
  EXPECT_TRUE(has_error(lenze8400("tpdo: {1: {transmission: 245}}").findings));
}

TEST(DeviceDataPdos, RefusesTypesThatAreWrittenBySdo) {
  const std::string sdo = "sdo: [{index: 0x1801, sub_index: 2, value: ";
  for (const char* type : {"0", "245", "252", "253"}) {
    const std::string declared = drv28(sdo + type + "}]").declared("device-data");
    EXPECT_NE(declared.find("can't have transmission type " + std::string{type}),
              std::string::npos);
    EXPECT_NE(drv28(sdo + type + "}], tpdo: {2: {enabled: false}}").declared("device-data"), "");
  }
  EXPECT_EQ(drv28(sdo + "254}]").declared("device-data"), "");
  const std::string reserved = lenze8400(sdo + "245}]").declared("device-data");
  EXPECT_NE(reserved.find("types 241 to 251 are reserved"), std::string::npos);
  EXPECT_FALSE(has_error(lenze8400(sdo + "252}]").findings));
}

TEST(DeviceDataPdos, RefusesToPollADrv28) {
  for (const char* poll : {"poll_ms: 100", "poll_syncs: 5"}) {
    const auto net = drv28(std::string{"tpdo: {2: {transmission: 254, "} + poll + "}}");
    EXPECT_NE(net.declared("device-data").find("Astraada DRV-28 answers no remote request"),
              std::string::npos);
  }
  EXPECT_EQ(lenze8400("tpdo: {1: {transmission: 253, poll_ms: 100}}").declared("device-data"), "");
}

TEST(DeviceDataPdos, KnowsTheBufferStateOfATechnosoftDriveAndItsInhibitTime) {
  const auto net =
      compile_device_file("arm: {node_id: 4, dcf: x, vendor_id: 0x1A3}\n", "takt_drive402.eds");

  const auto& plan = net.plan.nodes.at(0);
  EXPECT_EQ(plan.device_data, "Technosoft iPOS");
  ASSERT_EQ(plan.emcy_texts.size(), 1U);
  EXPECT_EQ(plan.emcy_texts[0].code, 0xFF01);
  EXPECT_NE(std::ranges::find(plan.device_notes, "inhibit times of 30 ms by default"),
            plan.device_notes.end());
}

TEST(DeviceDataPdos, ATpdoOfADrv28ThatOnlyAnswersAnRpdoWhichIsOffIsAWarning) {
  const auto net = drv28("tpdo: {2: {transmission: 255}}, rpdo: {2: {enabled: false}}");
  const std::string declared = net.declared("device-data");
  EXPECT_NE(
      declared.find("TPDO2 of node `pump` of transmission type 255 is sent only as the answer to "
                    "RPDO2, which is off, so the device never sends it. Switch RPDO2 on, or write "
                    "`transmission: 254` (on change)"),
      std::string::npos)
      << declared;
}

TEST(DeviceDataPdos, ATpdoOfADrv28ThatIsSentOtherwiseNeedsNoRpdo) {
  EXPECT_EQ(drv28("tpdo: {2: {transmission: 254}}, rpdo: {2: {enabled: false}}").complaints(),
            Complaints{});
  EXPECT_EQ(drv28("tpdo: {2: {transmission: 255}}, rpdo: {2: {transmission: 1}}").complaints(),
            Complaints{});
}

}  // namespace
}  // namespace takt
