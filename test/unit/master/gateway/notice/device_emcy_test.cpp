#include <gtest/gtest.h>

#include "master/explain/boot_report.hpp"
#include "test/unit/master/gateway/a_plan.hpp"

namespace takt {
namespace {

TEST(DeviceEmcy, IsReportedInTheWordsOfTheDeviceData) {
  BusPlan plan = test::a_plan();
  plan.nodes.at(0).emcy_texts = {{0x2310, "overcurrent of the inverter"}};
  Event event{.kind = EventKind::emcy, .node = 5};
  event.bytes = {0x10, 0x23, 0x01};

  const std::string own = describe(plan, event);
  event.node = 6;
  const std::string other = describe(plan, event);

  EXPECT_NE(own.find("EMCY 0x2310: overcurrent of the inverter"), std::string::npos) << own;
  EXPECT_EQ(other.find("of the inverter"), std::string::npos) << other;
}

}  // namespace
}  // namespace takt
