#include <nlohmann/json.hpp>
#include <utility>

#include "apps/takt/trajectory/trajectory_line.hpp"
#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

using Json = nlohmann::ordered_json;

std::string defect_text(motion::Defect defect) {
  static constexpr std::string_view texts[]{
      "a number is infinite",
      "the velocity limits do not enclose 0",
      "the acceleration limits do not enclose 0",
      "the jerk limit is not greater than 0",
      "the target velocity is outside the limits",
      "the target acceleration is outside the limits",
      "with its target acceleration, the axis would have to exceed the velocity limits before it "
      "arrives",
      "no motion was found that stays inside the range of positions",
      "no duration was found that is possible for all axes",
      "precision: the limits and states differ by so many powers of ten that the motion can't be "
      "computed with 16 digits"};
  return std::string{name_of(defect, texts)};
}

Json segments_of(const motion::Profile& profile) {
  Json segments = Json::array();
  for (const motion::Segment& segment : profile.segments()) {
    segments.push_back({{"duration", segment.duration}, {"jerk", segment.jerk}});
  }
  return segments;
}

Json sample_at(const TrajectoryAnswer& answer, double time) {
  Json sample{{"time", time}};
  for (std::size_t i = 0; i < answer.axes.size(); ++i) {
    const auto state = answer.axes[i].profile.at(answer.request.tasks[i].from, time);
    sample["position"].push_back(state.position);
    sample["velocity"].push_back(state.velocity);
    sample["acceleration"].push_back(state.acceleration);
  }
  return sample;
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
