#include "master/gateway/message/bus_view.hpp"

#include <gtest/gtest.h>
#include <initializer_list>

namespace takt {
namespace {

/// Makes one of three parts of a status; each part has its own node.
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

TEST(BusView, IsNotDeafenedByOneForgedMessageOfAnotherSession) {
  BusView view;
  take(view, {0, 1, 2}, 7);
  layout_t layout{};
  layout.session = 1;
  layout.hash = 5;
  layout.total_signals = layout.num_signals = 1;
  layout.signals.resize(1);
  view.take(layout);

  image_t image{};
  image.session = 2;
  view.take(image);
  pdo_status_t pdos{};
  pdos.session = 2;
  pdos.parts = 1;
  view.take(pdos);
  event_t event{};
  event.session = 2;
  view.take(event);
  sync_status_t sync{};
  sync.session = 2;
  view.take(sync);
  take(view, {0, 1, 2}, 8);

  EXPECT_EQ(view.signals().size(), 1U);
  EXPECT_FALSE(view.two_daemons());
  EXPECT_FALSE(view.pdos());
  EXPECT_TRUE(view.events().empty());
}

}  // namespace
}  // namespace takt
