#include "eds_parser/table/bus_plan.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(BusPlan, FindsANodeByItsId) {
  BusPlan plan;
  plan.nodes.push_back({.name = "shoulder", .id = 5_node});
  plan.nodes.push_back({.name = "elbow", .id = 6_node});

  ASSERT_NE(plan.find(6), nullptr);
  EXPECT_EQ(plan.find(6)->name, "elbow");
  EXPECT_EQ(plan.index_of(6), 1U);
  for (const unsigned id : {0U, 7U, 261U}) {
    EXPECT_EQ(plan.find(id), nullptr) << id;
    EXPECT_EQ(plan.index_of(id), 2U) << id;
  }
}

}  // namespace
}  // namespace takt
