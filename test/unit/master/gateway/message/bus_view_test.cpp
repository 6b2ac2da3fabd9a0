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

TEST(BusView, HasTheSpeedAxesOfItsLayoutOnly) {
  BusView view;
  take(view, {0, 1, 2}, 7);
  speed_axes_t axes{};
  axes.session = 1;
  axes.layout_hash = 5;
  axes.parts = 1;
  axes.num_axes = 1;
  axes.axes.resize(1);
  view.take(axes);
  EXPECT_TRUE(view.speed_axes().empty()) << "before the layout";

  layout_t layout{};
  layout.session = 1;
  layout.hash = 5;
  layout.total_signals = layout.num_signals = 1;
  layout.signals.resize(1);
  view.take(layout);
  EXPECT_EQ(view.speed_axes().size(), 1U);

  axes.layout_hash = 6;
  view.take(axes);
  EXPECT_TRUE(view.speed_axes().empty()) << "their positions are those of another layout";
}

TEST(BusView, PutsMotionsTogetherAndIgnoresThoseOfAnotherSession) {
  BusView view;
  take(view, {0, 1, 2}, 7);
  motion_t motions{};
  motions.session = 1;
  motions.cycle = 9;
  motions.parts = 2;
  motions.axes.resize(1);
  view.take(motions);
  EXPECT_FALSE(view.motions());

  motions.part = 1;
  view.take(motions);
  ASSERT_TRUE(view.motions());
  EXPECT_EQ(view.motions()->axes.size(), 2U);

  motions.session = 2;
  motions.part = 0;
  motions.parts = 1;
  motions.cycle = 10;
  view.take(motions);
  EXPECT_EQ(view.motions()->cycle, 9);
}

}  // namespace
}  // namespace takt
