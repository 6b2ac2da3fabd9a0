#include "master/gateway/bus_view.hpp"

#include <gtest/gtest.h>
#include <initializer_list>

namespace takt {
namespace {

/// One of three parts, with a node of its own.
status_t part(std::int16_t number, std::int64_t cycle) {
  status_t message{};
  message.session = 1;
  message.cycle = cycle;
  message.part = number;
  message.parts = 3;
  message.num_nodes = 1;
  message.nodes.resize(1);
  message.nodes[0].node_id = static_cast<std::int16_t>(number + 1);
  return message;
}

void take(BusView& view, std::initializer_list<std::int16_t> numbers, std::int64_t cycle) {
  for (const std::int16_t number : numbers) view.take(part(number, cycle));
}

TEST(BusView, PutsAStatusTogether) {
  BusView view;

  take(view, {0, 1, 2}, 7);

  ASSERT_TRUE(view.status());
  EXPECT_EQ(view.status()->num_nodes, 3);
  EXPECT_EQ(view.status()->nodes[2].node_id, 3);
}

TEST(BusView, AStatusWithoutItsMiddlePartIsNone) {
  BusView view;

  take(view, {0, 2}, 7);
  EXPECT_FALSE(view.status());

  take(view, {1}, 7);  // late: out of order
  EXPECT_FALSE(view.status());
  take(view, {0, 1, 2}, 8);
  ASSERT_TRUE(view.status());
  EXPECT_EQ(view.status()->num_nodes, 3);
}

TEST(BusView, ARepeatedPartOfAStatusDoesNotDoubleItsNodes) {
  BusView view;

  take(view, {0, 1, 1, 2}, 7);

  EXPECT_FALSE(view.status());
}

}  // namespace
}  // namespace takt
