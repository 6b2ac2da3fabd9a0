#include <nlohmann/json.hpp>
#include <utility>

#include "apps/takt/trajectory/trajectory_line.hpp"

namespace takt {
namespace {

using Json = nlohmann::ordered_json;

std::string defect_text(motion::Defect defect) {
  using motion::Defect;
  switch (defect) {
    case Defect::not_finite:
      return "a number is infinite";
    case Defect::velocity_limits:
      return "the velocity limits do not enclose 0";
    case Defect::acceleration_limits:
      return "the acceleration limits do not enclose 0";
    case Defect::jerk_limit:
      return "the jerk limit is not greater than 0";
    case Defect::target_velocity:
      return "the target velocity is outside the limits";
    case Defect::target_acceleration:
      return "the target acceleration is outside the limits";
    case Defect::velocity_before_target:
      return "with its target acceleration, the axis would have to exceed the velocity limits "
             "before it arrives";
    case Defect::position_range:
      return "no motion was found that stays inside the range of positions";
  }
  return {};
}

Json segments_of(const motion::Profile& profile) {
  Json segments = Json::array();
  for (const motion::Segment& segment : profile.segments()) {
    segments.push_back({{"duration", segment.duration}, {"jerk", segment.jerk}});
  }
  return segments;
}

Json sample_at(const TrajectoryAnswer& answer, double time) {
  Json position = Json::array();
  Json velocity = Json::array();
  Json acceleration = Json::array();
  for (std::size_t i = 0; i < answer.axes.size(); ++i) {
    const auto state = answer.axes[i].profile.at(answer.request.tasks[i].from, time);
    position.push_back(state.position);
    velocity.push_back(state.velocity);
    acceleration.push_back(state.acceleration);
  }
  return {{"time", time},
          {"position", std::move(position)},
          {"velocity", std::move(velocity)},
          {"acceleration", std::move(acceleration)}};
}

}  // namespace

std::expected<TrajectoryAnswer, std::string> answer_trajectory(TrajectoryRequest request) {
  TrajectoryAnswer answer{.request = std::move(request), .axes = {}};
  answer.axes.resize(answer.request.tasks.size());
  const auto planned =
      motion::plan_trajectory(answer.request.tasks, answer.request.options, answer.axes);
  if (!planned) {
    return std::unexpected{"axis " + std::to_string(planned.error().axis) + ": " +
                           defect_text(planned.error().defect)};
  }
  answer.duration = *planned;
  return answer;
}

std::expected<std::string, std::string> trajectory_json(const TrajectoryAnswer& answer,
                                                        std::optional<Time> sample) {
  Json json{{"duration", answer.duration},
            {"durations", Json::array()},
            {"independent_durations", Json::array()},
            {"segments", Json::array()},
            {"error", nullptr}};
  for (const motion::PlannedAxis& axis : answer.axes) {
    json["durations"].push_back(axis.duration);
    json["independent_durations"].push_back(axis.shortest);
    json["segments"].push_back(segments_of(axis.profile));
  }
  if (sample) {
    const double step = std::chrono::duration<double>{*sample}.count();
    const double number = answer.duration / step;
    if (!(number < static_cast<double>(most_samples))) {
      return std::unexpected{"--sample would give more than " + std::to_string(most_samples) +
                             " samples; choose a longer time"};
    }
    Json samples = Json::array();
    for (std::size_t i = 0; static_cast<double>(i) * step < answer.duration; ++i) {
      samples.push_back(sample_at(answer, static_cast<double>(i) * step));
    }
    samples.push_back(sample_at(answer, answer.duration));
    json["samples"] = std::move(samples);
  }
  return json.dump();
}

std::string trajectory_error_json(std::string_view error) {
  return Json{{"duration", nullptr},
              {"durations", nullptr},
              {"independent_durations", nullptr},
              {"segments", nullptr},
              {"error", error}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace takt
