#include "apps/takt/live/view/pages.hpp"

#include <algorithm>
#include <cstdint>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <string>

#include "apps/takt/live/view/top_frame.hpp"
#include "test/unit/apps/takt/live/view/bus_for_tests.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::size_t widths[] = {20, 35, 50, 64, 80, 100, 120, 200};

std::size_t longest(const std::vector<Line>& lines) {
  std::size_t most = 0;
  for (const Line& line : lines) most = std::max(most, line.columns());
  return most;
}

ShownBus crowded() {
  ShownBus bus = machine();
  bus.status.cycle = 4'000'000'000;
  bus.status.cycles_missed = 1'000'000;
  bus.status.stop = 3;
  bus.status.stop_text = "shoulder: was disabled at 75 mm/s, and a long text follows\nelbow";
  bus.node(111, "a_node_without_process_data").boot_state = 1;
  bus.status.nodes.back().holder = "takt-move of a user with a long name";
  event_t event{};
  event.utime = 1'000'000;
  event.text = "node 1 'shoulder': EMCY 0x3210 and a text that is longer than most lines are\nmore";
  bus.events.push_back(event);
  return bus;
}

TEST(Pages, NoLineIsLongerThanTheWidth) {
  const BusView bus = crowded().view();
  for (const std::size_t width : widths) {
    for (std::size_t page = 0; page < page_names.size(); ++page) {
      const auto lines = page_text(static_cast<Page>(page), bus, width).all();
      EXPECT_LE(longest(lines), width) << page_names[page] << '\n' << text_of(lines);
      const TopFrame frame =
          top_frame(bus, {.page = static_cast<Page>(page), .columns = width, .rows = 0});
      EXPECT_LE(longest(frame.lines), width) << page_names[page] << '\n' << text_of(frame.lines);
    }
    EXPECT_LE(longest(status_lines(bus, width)), width) << text_of(status_lines(bus, width));
  }
}

TEST(Pages, NoColumnDisappears) {
  const BusView bus = crowded().view();
  for (const std::size_t width : widths) {
    const std::string axes = text_of(axes_page(bus, width).all());
    for (const char* const title : {"AXIS", "STATE", "MODE", "POSITION", "VELOCITY", "FOLLOWING",
                                    "ERROR", "INPUTS", "OUTPUTS"}) {
      EXPECT_THAT(axes, HasSubstr(title)) << width;
    }
    const std::string nodes = text_of(nodes_page(bus, width).all());
    for (const char* const title :
         {"NODE", "NAME", "STATE", "BOOT", "HEARTBEAT", "EMCY", "NO PDO", "HELD BY"}) {
      EXPECT_THAT(nodes, HasSubstr(title)) << width;
    }
  }
}

TEST(Pages, EachAxisHasOneRowAt80Columns) {
  const Table::Text page = axes_page(machine().view(), 80);

  ASSERT_EQ(page.head.size(), 1U);
  ASSERT_EQ(page.body.size(), 5U) << text_of(page.body);
  const std::string shoulder = page.body[0].render(80, false);
  EXPECT_THAT(shoulder, HasSubstr("shoulder"));
  EXPECT_THAT(shoulder, HasSubstr("operation enabled"));
  EXPECT_THAT(shoulder, HasSubstr("csp"));
  EXPECT_THAT(shoulder, HasSubstr("1.2345 rad"));
  EXPECT_THAT(shoulder, HasSubstr("-2.5000 rad/s"));
  EXPECT_THAT(shoulder, HasSubstr("0.0002 rad")) << "target minus actual position";
}

TEST(Pages, RawCountsOf32BitsStillHaveOneRowAt80Columns) {
  ShownBus bus;
  bus.drive(1, "axis", 0x1637, "");
  for (signal_t& signal : bus.layout.signals) signal.scale = 1.0;
  bus.values[2] = bus.values[5] = -2'147'483'648;
  bus.values[3] = 2'000'000'000;

  const Table::Text page = axes_page(bus.view(), 80);

  ASSERT_EQ(page.body.size(), 1U) << text_of(page.body);
  const std::string row = page.body.front().render(80, false);
  EXPECT_THAT(row, HasSubstr("-2147483648 cnt"));
  EXPECT_THAT(row, HasSubstr("2.00e+09 cnt"));
}

TEST(Pages, AnAxisShowsItsErrorAndAShortName) {
  const std::string row = axes_page(machine().view(), 80).body[1].render(80, false);

  EXPECT_THAT(row, HasSubstr("fault"));
  EXPECT_THAT(row, HasSubstr("3210"));
  EXPECT_THAT(row, HasSubstr("~"));
  EXPECT_THAT(row, Not(HasSubstr("cnt")));
}

TEST(Pages, SpeedAxesAndNodesWithoutAxesHaveTheirRows) {
  const std::string page = text_of(axes_page(machine().view(), 80).all());

  EXPECT_THAT(page, HasSubstr("runs backward"));
  EXPECT_THAT(page, HasSubstr("-20.0000 Hz"));
  EXPECT_THAT(page, HasSubstr("6000:00 2D"));
  EXPECT_THAT(page, HasSubstr("6200:00 81"));
}

TEST(Pages, ANodeThatHasNotBootedShowsItsBoot) {
  ShownBus bus = machine();
  bus.status.nodes[0].boot_state = 1;
  bus.status.nodes[0].boot_step = 3;
  bus.status.nodes[0].boot_steps = 31;

  EXPECT_THAT(axes_page(bus.view(), 80).body[0].render(80, false), HasSubstr("boot 4/31"));
}

TEST(Pages, AStaleStatuswordIsNotShownAsAState) {
  ShownBus bus = machine();
  bus.stale = {0, 2};

  const std::string row = axes_page(bus.view(), 80).body[0].render(80, false);

  EXPECT_THAT(row, HasSubstr("no statusword"));
  EXPECT_THAT(row, Not(HasSubstr("rad ")));
}

TEST(Pages, TheFollowingErrorIsThatOfTheMotionIfThereIsOne) {
  ShownBus bus = machine();
  axis_motion_t motion{};
  motion.node_id = 1;
  motion.axis = 1;
  motion.state = 2;
  motion.following_error = 0.25;
  bus.motions.push_back(motion);

  EXPECT_THAT(axes_page(bus.view(), 80).body[0].render(80, false), HasSubstr("0.2500 rad"));
}

TEST(Pages, OldAndHostileMotionsAreNotShown) {
  for (const std::int64_t cycle : {std::int64_t{5}, std::numeric_limits<std::int64_t>::min(),
                                   std::numeric_limits<std::int64_t>::max()}) {
    ShownBus bus = machine();
    BusView view = bus.view();
    motion_t message{};
    message.session = ShownBus::session;
    message.parts = 1;
    message.cycle = cycle;
    message.axes.resize(1);
    message.axes[0].node_id = message.axes[0].axis = 1;
    message.axes[0].state = 2;
    message.axes[0].following_error = 0.25;
    view.take(message);

    EXPECT_THAT(axes_page(view, 80).body[0].render(80, false), Not(HasSubstr("0.25"))) << cycle;
  }
}

TEST(Pages, StatuswordsAreInHexAndInWords) {
  const std::string page = text_of(words_page(machine().view(), 120).all());

  EXPECT_THAT(page, HasSubstr("1637"));
  EXPECT_THAT(page, HasSubstr("operation enabled, voltage, remote, target reached"));
  EXPECT_THAT(page, HasSubstr("000F"));
  EXPECT_THAT(page, HasSubstr("enable operation"));
  EXPECT_THAT(page, HasSubstr("ready, running, backward"));
  EXPECT_THAT(page, HasSubstr("ctrl 0001  run\n"));
}

TEST(Pages, DigitalInputsHaveTheirBits) {
  const std::string page = text_of(io_page(machine().view(), 80).all());

  EXPECT_THAT(page, HasSubstr("io.read_input_8_bit"));
  EXPECT_THAT(page, HasSubstr("0010 1101"));
  EXPECT_LT(page.find("io.read_input"), page.find("shoulder.statusword"));
}

TEST(Pages, TheUnitOfAValueIsWholeOnItsPage) {
  ShownBus bus = machine();
  bus.signal(10, "torque", 0x6401, false, 16, 200, "of rated torque", 1e-3);

  EXPECT_THAT(text_of(io_page(bus.view(), 80).all()), HasSubstr("0.2000 of rated torque"));
}

TEST(Pages, TextsFromTheBusHaveNoControlCharacters) {
  ShownBus bus = machine();
  bus.status.nodes[0].name = "a\033[2Jb\n";
  for (signal_t& signal : bus.layout.signals) signal.node = "x\033]0;title\007";
  bus.speed_axes[0].unit = "\033[0m";

  const TopFrame frame = top_frame(bus.view(), {.rows = 0});

  EXPECT_THAT(text_of(frame.lines), Not(HasSubstr("\033")));
  EXPECT_THAT(text_of(frame.lines), Not(HasSubstr("\007")));
}

TEST(Pages, AHostileDescriptionOfSpeedAxesIsHarmless) {
  ShownBus bus = machine();
  bus.speed_axes[0].status = 1'000'000;
  bus.speed_axes[0].actual_speed = -5;
  bus.speed_axes[0].control = 2'000'000'000;

  EXPECT_THAT(text_of(axes_page(bus.view(), 80).all()), HasSubstr("no status word"));
}

TEST(TopFrame, FitsTheRowsAndScrolls) {
  ShownBus bus;
  for (std::int16_t id = 1; id <= 40; ++id) bus.drive(id, "axis" + std::to_string(id), 0x1637);
  const BusView view = bus.view();

  const TopFrame first = top_frame(view, {.rows = 24});
  const TopFrame last = top_frame(view, {.rows = 24, .first_row = 10'000});

  EXPECT_LE(first.lines.size(), 24U);
  EXPECT_LE(last.lines.size(), 24U);
  EXPECT_THAT(text_of(first.lines), HasSubstr("axis1 "));
  EXPECT_THAT(text_of(first.lines), HasSubstr("arrows scroll"));
  EXPECT_GT(last.first_row, 0U);
  EXPECT_LT(last.first_row, 10'000U);
}

TEST(TopFrame, HasOneLineForOneCauseAndNoneForAcknowledgedEvents) {
  ShownBus bus = machine();
  for (const char* const node : {"node 1", "node 2"}) {
    event_t event{};
    event.utime = 1'000'000;
    event.kind = "heartbeat_lost";
    event.text = std::string{node} + ": the node is lost";
    bus.events.push_back(event);
  }
  const BusView view = bus.view();

  EXPECT_THAT(text_of(top_frame(view, {}).lines), HasSubstr("node 1, node 2: the node is lost"));
  EXPECT_THAT(text_of(top_frame(view, {.seen_until = 1'000'000}).lines),
              Not(HasSubstr("the node is lost")));
}

TEST(TopFrame, NamesItsPages) {
  const TopFrame frame = top_frame(machine().view(), {.page = Page::io});

  EXPECT_THAT(text_of(frame.lines), HasSubstr("[3 io]"));
  EXPECT_THAT(text_of(frame.lines), HasSubstr("1 axes"));
  EXPECT_EQ(page_of("io"), Page::io);
  EXPECT_FALSE(page_of("IO"));
}

TEST(TopFrame, OfABusWithoutAnImageSaysSo) {
  ShownBus bus;
  bus.node(1, "shoulder");

  EXPECT_THAT(text_of(top_frame(bus.view(), {}).lines), HasSubstr("waiting for the layout"));
  EXPECT_THAT(text_of(status_lines(bus.view(), 80)), HasSubstr("shoulder"));
}

}  // namespace
}  // namespace takt::test
