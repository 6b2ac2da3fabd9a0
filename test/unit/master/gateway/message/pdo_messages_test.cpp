#include <gtest/gtest.h>

#include "master/gateway/message/bus_view.hpp"
#include "master/gateway/message/status_messages.hpp"
#include "master/lcm/messages.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {
namespace {

TEST(PdoMessages, ReportAgeCountAndTroubleOfEachPdo) {
  const BusPlan plan = test::axes({.nodes = 1});
  StatusSnapshot snapshot;
  snapshot.tpdos = {{.missing = 3, .late = 2, .length_errors = 5, .too_long = 1, .stale = true}};
  snapshot.rpdos = {{.sent = 9, .ready = true}};
  const PdoMark mark{.received = 7, .cycle = 95, .flags = PdoMark::late};

  const auto messages = pdo_messages(plan, snapshot, {&mark, 1}, 100);

  ASSERT_EQ(messages.size(), 1U);
  ASSERT_EQ(messages[0].pdos.size(), 2U);
  const pdo_state_t& tpdo = messages[0].pdos[0];
  EXPECT_EQ(tpdo.cob_id, 0x181);
  EXPECT_EQ(tpdo.count, 7);
  EXPECT_EQ(tpdo.toggle, 1);
  EXPECT_EQ(tpdo.age, 5);
  EXPECT_EQ(tpdo.flags, 4);
  EXPECT_EQ(tpdo.missing, 3);
  EXPECT_EQ(tpdo.late, 2);
  EXPECT_EQ(tpdo.too_short, 4);
  EXPECT_EQ(tpdo.too_long, 1);
  const pdo_state_t& rpdo = messages[0].pdos[1];
  EXPECT_EQ(rpdo.output, 1);
  EXPECT_EQ(rpdo.count, 9);
  EXPECT_EQ(rpdo.stale, 0);
}

TEST(PdoMessages, OfManyPdosComeInPartsThatAreReadBack) {
  const BusPlan plan = test::axes({.nodes = 100});
  StatusSnapshot snapshot;
  snapshot.tpdos.resize(100);
  snapshot.rpdos.resize(100);
  BusView view;
  std::vector<std::byte> buffer;
  for (const pdo_status_t& part : pdo_messages(plan, snapshot, {}, 1)) {
    const Bytes bytes = encode(part, buffer);
    EXPECT_LE(bytes.size(), message_bytes);
    const auto read = decode<pdo_status_t>(bytes);
    ASSERT_TRUE(read);
    EXPECT_FALSE(view.pdos());
    view.take(*read);
  }
  ASSERT_TRUE(view.pdos());
  EXPECT_EQ(view.pdos()->pdos.size(), 200U);
  EXPECT_EQ(view.pdos()->pdos[0].age, -1) << "none came so far";
  EXPECT_EQ(view.pdos()->pdos[199].node_id, 100);
}

}  // namespace
}  // namespace takt
