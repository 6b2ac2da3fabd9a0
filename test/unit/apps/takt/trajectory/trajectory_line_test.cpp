#include "apps/takt/trajectory/trajectory_line.hpp"

#include <chrono>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/takt/trajectory/trajectory_plot.hpp"

namespace takt {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

constexpr const char* two_axes =
    R"({"from":{"position":[0,0],"velocity":[0,0.1],"acceleration":[0,0]},)"
    R"("to":{"position":[1,-0.5],"velocity":[0,0],"acceleration":[0,0]},)"
    R"("limits":{"velocity":[1,1],"acceleration":[5,5],"jerk":[50,50],)"
    R"("min_velocity":[-1,-1],"min_acceleration":[-5,-5]},)"
    R"("interface":"position","synchronisation":"time","minimum_duration":0})";

nlohmann::json answer_to(std::string_view line, std::optional<Time> sample = {}) {
  auto request = read_trajectory_request(line);
  EXPECT_TRUE(request.has_value()) << request.error();
  const auto answer = answer_trajectory(std::move(*request));
  EXPECT_TRUE(answer.has_value()) << answer.error();
  return nlohmann::json::parse(*trajectory_json(*answer, sample));
}

std::string error_of(std::string_view line) {
  const auto request = read_trajectory_request(line);
  return request ? "none" : request.error();
}

TEST(TrajectoryLine, HasDurationsAndSegmentsOfEachAxis) {
  const auto answer = answer_to(two_axes);

  EXPECT_NEAR(answer["duration"].get<double>(), 1.3, 1e-9);
  EXPECT_EQ(answer["durations"][0], answer["duration"]);
  EXPECT_EQ(answer["durations"][1], answer["duration"]);
  EXPECT_EQ(answer["independent_durations"][0], answer["duration"]);
  EXPECT_LT(answer["independent_durations"][1], answer["duration"]);
  EXPECT_EQ(answer["segments"].size(), 2u);
  EXPECT_EQ(answer["segments"][0][0]["jerk"], 50.0);
  EXPECT_NEAR(answer["segments"][0][0]["duration"].get<double>(), 0.1, 1e-12);
  EXPECT_TRUE(answer["error"].is_null());
  EXPECT_FALSE(answer.contains("samples"));
}

TEST(TrajectoryLine, MayLeaveOutWhatHasADefault) {
  const auto answer = answer_to(R"({"from":{"position":[0]},"to":{"position":[1]},)"
                                R"("limits":{"velocity":[1],"acceleration":[5],"jerk":[50]}})");

  EXPECT_NEAR(answer["duration"].get<double>(), 1.3, 1e-9);
}

TEST(TrajectoryLine, OfAVelocityNeedsNoTargetPosition) {
  const auto answer =
      answer_to(R"({"from":{"position":[0]},"to":{"velocity":[0.5]},"interface":"velocity",)"
                R"("limits":{"velocity":[1],"acceleration":[5],"jerk":[50]}})");

  EXPECT_NEAR(answer["duration"].get<double>(), 0.2, 1e-9);
}

TEST(TrajectoryLine, KeepsTheRangeOfPositions) {
  const auto answer = [](std::string_view limit) {
    auto request = read_trajectory_request(
        R"({"from":{"position":[0],"velocity":[1]},"to":{"position":[0]},)"
        R"("limits":{"velocity":[1],"acceleration":[5],"jerk":[50],"min_position":[-1],)"
        R"("max_position":[)" +
        std::string{limit} + "]}}");
    return answer_trajectory(std::move(request.value()));
  };

  EXPECT_TRUE(answer("0.3").has_value());
  EXPECT_EQ(answer("0.1").error(),
            "axis 0: no motion was found that stays inside the range of positions");
}

TEST(TrajectoryLine, HasTheStatesAtEachIntervalAndAtTheEnd) {
  const auto answer = answer_to(two_axes, 100ms);

  ASSERT_EQ(answer["samples"].size(), 14u);
  EXPECT_EQ(answer["samples"][0]["velocity"], (std::vector{0.0, 0.1}));
  EXPECT_NEAR(answer["samples"][13]["position"][0].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(answer["samples"][13]["position"][1].get<double>(), -0.5, 1e-9);
}

TEST(TrajectoryLine, HasNoMoreSamplesThanAreGoodForAnybody) {
  auto request = read_trajectory_request(two_axes);
  const auto answer = answer_trajectory(std::move(*request));

  const auto text = trajectory_json(*answer, 1us);

  ASSERT_FALSE(text.has_value());
  EXPECT_THAT(text.error(), HasSubstr("choose a longer time"));
}

TEST(TrajectoryLine, ThatIsWrongNamesTheKeyAndWhatWasExpected) {
  EXPECT_EQ(error_of("{"), "this is not JSON");
  EXPECT_EQ(error_of("[1]"), "expected a JSON object");
  EXPECT_EQ(error_of(R"({"form":{}})"), "`form` is no key");
  EXPECT_EQ(error_of(R"({"from":[]})"), "`from` is missing, or is no object");
  EXPECT_EQ(error_of(R"({"interface":"force"})"), "`interface` is one of `position`, `velocity`");
  EXPECT_EQ(error_of(R"({"minimum_duration":-1})"),
            "`minimum_duration` is a number of seconds, 0 or more");
  const auto with = [](std::string_view from) {
    return error_of(R"({"from":)" + std::string{from} +
                    R"(,"to":{"position":[1]},)"
                    R"("limits":{"velocity":[1],"acceleration":[5],"jerk":[50]}})");
  };
  EXPECT_EQ(with("{}"), "`from.position` is missing");
  EXPECT_EQ(with(R"({"position":1})"), "`from.position` is an array with a number for each axis");
  EXPECT_EQ(with(R"({"position":["1"]})"), "`from.position` has an element that is no number");
  EXPECT_EQ(with(R"({"position":[0],"speed":[0]})"), "`from.speed` is no key");
  EXPECT_EQ(with(R"({"position":[0,0]})"),
            "`to.position` has 1 numbers, expected 2, one for each axis");
}

TEST(TrajectoryLine, WithoutASolutionSaysWhyAndForWhichAxis) {
  auto request = read_trajectory_request(
      R"({"from":{"position":[0,0]},"to":{"position":[1,1],"velocity":[0,2]},)"
      R"("limits":{"velocity":[1,1],"acceleration":[5,5],"jerk":[50,50]}})");
  ASSERT_TRUE(request.has_value());

  const auto answer = answer_trajectory(std::move(*request));

  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error(), "axis 1: the target velocity is outside the limits");
  const auto line = nlohmann::json::parse(trajectory_error_json(answer.error()));
  EXPECT_TRUE(line["duration"].is_null());
  EXPECT_EQ(line["error"], answer.error());
}

TEST(TrajectoryPlot, HasACurveOfEachAxisInEachPanel) {
  auto request = read_trajectory_request(two_axes);
  const auto answer = answer_trajectory(std::move(*request));

  const std::string svg = trajectory_svg(*answer);

  std::size_t curves = 0;
  for (auto at = svg.find("\"curve"); at != std::string::npos; at = svg.find("\"curve", at + 1)) {
    ++curves;
  }
  EXPECT_EQ(curves, 8u + 2u) << "and two entries of the legend";
  EXPECT_THAT(svg, HasSubstr(">acceleration<tspan x=\"0\" dy=\"13\">(unit/s²)</tspan>"));
}

}  // namespace
}  // namespace takt
