#include "master/sim/bus/offer_list.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

namespace takt::sim {
namespace {

Offer offer(BusNodeIndex node, std::uint32_t rank) {
  return {.from = {}, .rank = rank, .node = node};
}

std::vector<BusNodeIndex> nodes_of(const OfferList& list) {
  std::vector<BusNodeIndex> nodes;
  for (const Offer& one : list.all()) nodes.push_back(one.node);
  return nodes;
}

using Nodes = std::vector<BusNodeIndex>;

TEST(OfferList, IsInTheOrderOfRank) {
  OfferList list;
  list.reserve(4);
  EXPECT_TRUE(list.empty());
  list.add(offer(0, 30));
  list.add(offer(1, 10));
  list.add(offer(2, 40));
  list.add(offer(3, 20));
  EXPECT_EQ(nodes_of(list), (Nodes{1, 3, 0, 2}));
  EXPECT_EQ(list.first().node, 1);
}

TEST(OfferList, RemovesAnyOffer) {
  OfferList list;
  list.reserve(4);
  for (BusNodeIndex i = 0; i < 4; ++i) list.add(offer(i, i));
  list.remove(2);
  EXPECT_EQ(nodes_of(list), (Nodes{0, 1, 3}));
  list.remove(2);
  EXPECT_EQ(nodes_of(list), (Nodes{0, 1, 3}));
  list.remove(0);
  list.remove(3);
  list.remove(1);
  EXPECT_TRUE(list.empty());
}

TEST(OfferList, HasRoomForEachNodeAgainAndAgain) {
  OfferList list;
  list.reserve(3);
  for (BusNodeIndex i = 0; i < 3; ++i) list.add(offer(i, i));
  for (std::uint32_t round = 0; round < 10; ++round) {
    const BusNodeIndex node = list.first().node;
    list.remove(node);
    list.add(offer(node, 10 + round));
    EXPECT_TRUE(std::ranges::is_sorted(list.all(), {}, &Offer::rank));
    EXPECT_EQ(list.all().size(), 3U);
  }
}

}  // namespace
}  // namespace takt::sim
