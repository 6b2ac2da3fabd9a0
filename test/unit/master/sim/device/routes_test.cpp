#include "master/sim/device/routes.hpp"

#include <gtest/gtest.h>

namespace takt::sim {
namespace {

std::vector<RouteKind> kinds(const Routes& routes, CobId id) {
  std::vector<RouteKind> all;
  for (const Route& route : routes.of(id)) all.push_back(route.kind);
  return all;
}

using Kinds = std::vector<RouteKind>;

TEST(Routes, FindsAllRoutesOfAnIdentifierInTheOrderOfTheirKinds) {
  Routes routes;
  routes.reserve(4);
  routes.add({CobId::base(0x205), RouteKind::rpdo, 1});
  routes.add({CobId::base(0x080), RouteKind::sync, 0});
  routes.add({CobId::base(0x205), RouteKind::heartbeat, 0});
  routes.add({CobId::extended(0x205), RouteKind::rpdo, 2});
  routes.sort();

  EXPECT_EQ(kinds(routes, CobId::base(0x205)), (Kinds{RouteKind::heartbeat, RouteKind::rpdo}));
  EXPECT_EQ(kinds(routes, CobId::base(0x080)), Kinds{RouteKind::sync});
  ASSERT_EQ(routes.of(CobId::extended(0x205)).size(), 1u);
  EXPECT_EQ(routes.of(CobId::extended(0x205))[0].index, 2);
  EXPECT_TRUE(routes.of(CobId::base(0x206)).empty());
  EXPECT_TRUE(routes.of(CobId::extended(0x204)).empty());
  EXPECT_TRUE(routes.of(CobId::extended(0x206)).empty());
}

TEST(Routes, ForgetThemAll) {
  Routes routes;
  routes.reserve(2);
  routes.add({CobId::base(0x080), RouteKind::sync, 0});
  routes.sort();

  routes.clear();
  routes.add({CobId::base(0x000), RouteKind::nmt, 0});
  routes.sort();

  EXPECT_TRUE(routes.of(CobId::base(0x080)).empty());
  EXPECT_EQ(kinds(routes, CobId::base(0x000)), Kinds{RouteKind::nmt});
}

}  // namespace
}  // namespace takt::sim
