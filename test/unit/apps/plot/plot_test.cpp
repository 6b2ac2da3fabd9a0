#include "apps/plot/plot.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <regex>
#include <utility>

namespace takt {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Returns a plot of one panel with these values, one each second.
Plot plot_of(std::vector<double> values) {
  Plot plot{.title = "test", .legend = {{.text = "axis"}}};
  for (std::size_t i = 0; i < values.size(); ++i) plot.times.push_back(static_cast<double>(i));
  plot.panels.push_back(
      {.quantity = "velocity", .unit = "rad/s", .curves = {{.values = std::move(values)}}});
  return plot;
}

/// Returns the y of all points of the curves, and the top and height of the frame.
struct Drawn {
  std::vector<double> ys;
  double top = 0.0;
  double height = 0.0;
};
Drawn drawn(const std::string& svg) {
  Drawn found;
  const std::regex frame{
      R"re(class="frame" x="[\d.]+" y="([\d.]+)" width="[\d.]+" height="([\d.]+)")re"};
  std::smatch match;
  if (std::regex_search(svg, match, frame)) {
    found.top = std::stod(match[1]);
    found.height = std::stod(match[2]);
  }
  const auto panel = svg.find("rotate(-90)");
  const std::string curves = svg.substr(svg.find("class=\"curve", panel));
  const std::regex point{R"re([ML](-?[\d.]+) (-?[\d.]+))re"};
  for (auto at = std::sregex_iterator{curves.begin(), curves.end(), point};
       at != std::sregex_iterator{}; ++at) {
    found.ys.push_back(std::stod((*at)[2]));
  }
  return found;
}

TEST(Plot, HasUnitsALegendAZeroLineAndRoundTicks) {
  const std::string svg = plot_svg(plot_of({-1.3, 0.4, 2.2}));
  EXPECT_THAT(svg, HasSubstr(">velocity<tspan"));
  EXPECT_THAT(svg, HasSubstr(">(rad/s)</tspan>"));
  EXPECT_THAT(svg, HasSubstr(">time (s)</text>"));
  EXPECT_THAT(svg, HasSubstr(">axis</text>"));
  EXPECT_THAT(svg, HasSubstr("class=\"zero\""));
  EXPECT_THAT(svg, HasSubstr(">-2</text>"));
  EXPECT_THAT(svg, HasSubstr(">3</text>"));
  EXPECT_THAT(svg, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
}

TEST(Plot, KeepsItsCurvesInsideTheFrame) {
  for (const auto& values : {std::vector{-1.3, 0.4, 2.2}, std::vector{5.0, 5.0}, std::vector{0.0},
                             std::vector{1e-12, -3e-12}, std::vector{1e9, 1e9 + 1.0}}) {
    const Drawn found = drawn(plot_svg(plot_of(values)));
    ASSERT_FALSE(found.ys.empty());
    for (const double y : found.ys) {
      EXPECT_GE(y, found.top - 0.1);
      EXPECT_LE(y, found.top + found.height + 0.1);
    }
  }
}

TEST(Plot, EscapesForeignTexts) {
  Plot plot = plot_of({1.0, 2.0});
  plot.title = "a<b>&\"\x1B[5m";
  EXPECT_THAT(plot_svg(plot), HasSubstr(">a&lt;b&gt;&amp;&quot;?[5m</text>"));
}

TEST(Plot, DrawsNothingWhereThereIsNoValue) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = plot_svg(plot_of({none, 1.0, 2.0, none, 2.0, 1.0, none}));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_EQ(drawn(svg).ys.size(), 4U);
  EXPECT_THAT(plot_svg(plot_of({none, none})), Not(HasSubstr("nan")));
  EXPECT_THAT(plot_svg(Plot{}), HasSubstr("</svg>"));
}

TEST(Plot, IsShortForManyPoints) {
  std::vector<double> values;
  for (int i = 0; i < 100'000; ++i) values.push_back(std::sin(i * 1e-4) + 0.01 * (i % 7));
  EXPECT_LT(plot_svg(plot_of(values)).size(), 60'000U);
  EXPECT_LT(drawn(plot_svg(plot_of({0.0, 1.0, 2.0, 3.0, 4.0}))).ys.size(), 3U) << "a straight line";
}

}  // namespace
}  // namespace takt
