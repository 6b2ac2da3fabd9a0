#include "master/linux/can/can_filters.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

constexpr canid_t exact = 0xC000'07FF;  // SFF mask, EFF and RTR flags: the kernel's hash table

NodePlan node_plan(NodeId id) {
  NodePlan node{.name = {}, .id = id, .description_file = {}, .product_name = {}, .boot_plan = {}};
  return node;
}

BusPlan plan_of(int nodes) {
  BusPlan plan;
  for (int id = 1; id <= nodes; ++id) {
    plan.nodes.push_back(node_plan(*NodeId::from(static_cast<unsigned>(id))));
    for (std::uint32_t pdo = 0; pdo < 4; ++pdo) {
      PdoRow row{.cob_id = CobId::base(0x180 + 0x100 * pdo + static_cast<std::uint32_t>(id)),
                 .node = *NodeId::from(static_cast<unsigned>(id))};
      plan.pdos.tpdos.push_back(row);
    }
  }
  return plan;
}

TEST(CanFilters, LetPassExactlyWhatTheMasterHearsOfANode) {
  BusPlan plan;
  plan.nodes.push_back(node_plan(5_node));
  plan.pdos.tpdos.push_back({.cob_id = CobId::base(0x185), .node = 5_node});

  const auto filters = filters_for(plan);

  std::vector<canid_t> ids;
  for (const can_filter& filter : filters) {
    EXPECT_EQ(filter.can_mask, exact);
    ids.push_back(filter.can_id);
  }
  std::vector<canid_t> expected{0x080, 0x085, 0x185, 0x585, 0x67F};
  for (canid_t stranger = 0x701; stranger <= 0x77E; ++stranger) expected.push_back(stranger);
  expected.push_back(0x7E4);  // LSS
  EXPECT_EQ(ids, expected) << "and the signs of life of others, but not of the master (127)";
}

TEST(CanFilters, HearTheEmcyOfANodeWhereItIs) {
  BusPlan plan;
  plan.nodes.push_back(node_plan(5_node));
  plan.nodes[0].emcy_cob_id = CobId::base(0x0C5);

  const auto filters = filters_for(plan);

  EXPECT_TRUE(passes(filters, 0x0C5));
  EXPECT_FALSE(passes(filters, 0x085));
}

TEST(CanFilters, KeepOutTheRpdosThatTheMasterSendsItself) {
  BusPlan plan = plan_of(3);
  plan.pdos.rpdos.push_back({.cob_id = CobId::base(0x203), .node = 3_node});

  const auto filters = filters_for(plan);

  EXPECT_FALSE(passes(filters, 0x203));
  EXPECT_FALSE(passes(filters, 0x603));
  EXPECT_FALSE(passes(filters, 0x000));
}

TEST(CanFilters, KeepOutRemoteFramesAndExtendedTwins) {
  const auto filters = filters_for(plan_of(3));

  EXPECT_TRUE(passes(filters, 0x703));
  EXPECT_FALSE(passes(filters, 0x703 | CAN_RTR_FLAG));
  EXPECT_FALSE(passes(filters, 0x703 | CAN_EFF_FLAG));
}

TEST(CanFilters, WithoutSyncTheIdentifierOfSyncDoesNotPass) {
  BusPlan plan = plan_of(1);
  plan.cycle.sync = false;

  EXPECT_FALSE(passes(filters_for(plan), 0x080));
}

TEST(CanFilters, AFullBusFitsIntoTheKernelsLimitAndLosesNothing) {
  const BusPlan plan = plan_of(127);  // 1 + 127 * 7 = 890 identifiers

  const auto filters = filters_for(plan);

  EXPECT_LE(filters.size(), max_kernel_filters);
  for (const PdoRow& row : plan.pdos.tpdos) EXPECT_TRUE(passes(filters, row.cob_id.id()));
  for (canid_t id = 1; id <= 127; ++id) {
    EXPECT_TRUE(passes(filters, 0x080 + id));
    EXPECT_TRUE(passes(filters, 0x580 + id));
    EXPECT_TRUE(passes(filters, 0x700 + id));
  }
}

TEST(CanFilters, AFullBusStillKeepsOutTheOutputsOfTheMaster) {
  const auto filters = filters_for(plan_of(127));

  for (canid_t id = 1; id < 127; ++id) EXPECT_FALSE(passes(filters, 0x600 + id)) << id;
  EXPECT_TRUE(passes(filters, 0x67F)) << "requests to the master's own SDO server";
}

TEST(CanFilters, PrefixesWidenOnlyAsFarAsTheLimitAsks) {
  // 100, 102, 104, 106: with a limit of 2 each pair becomes one prefix of four identifiers
  const std::vector<CobId> ids{CobId::base(0x100), CobId::base(0x102), CobId::base(0x104),
                               CobId::base(0x106)};

  const auto filters = filters_for(ids, 2);

  EXPECT_LE(filters.size(), 2U);
  EXPECT_TRUE(passes(filters, 0x106));
  EXPECT_FALSE(passes(filters, 0x108));
  EXPECT_FALSE(passes(filters, 0x0FF));
}

TEST(CanFilters, ExtendedIdentifiersPassExactly) {
  const std::vector<CobId> ids{CobId::extended(0x12345)};

  const auto filters = filters_for(ids);

  ASSERT_EQ(filters.size(), 1U);
  EXPECT_EQ(filters[0].can_id, 0x8001'2345U);
  EXPECT_EQ(filters[0].can_mask, 0xDFFF'FFFFU);
}

TEST(CanFilters, TooManyExtendedIdentifiersOpenAllExtendedOnes) {
  std::vector<CobId> ids;
  for (std::uint32_t i = 0; i < 600; ++i) ids.push_back(CobId::extended(0x10000 + i));

  const auto filters = filters_for(ids);

  ASSERT_EQ(filters.size(), 1U);
  EXPECT_TRUE(passes(filters, 0x9234'5678U));
  EXPECT_FALSE(passes(filters, 0x181));
}

}  // namespace
}  // namespace takt
