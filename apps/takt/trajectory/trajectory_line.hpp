#pragma once
#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/motion/trajectory.hpp"

namespace takt {

/// One request of `takt trajectory`.
struct TrajectoryRequest {
  std::vector<motion::AxisTask> tasks;
  motion::TrajectoryOptions options;
};

/// Reads the JSON object of one line. On failure, returns a sentence that names the key and what
/// was expected.
std::expected<TrajectoryRequest, std::string> read_trajectory_request(std::string_view line);

/// The answer to one request.
struct TrajectoryAnswer {
  TrajectoryRequest request;
  std::vector<motion::PlannedAxis> axes;
  double duration = 0.0;  ///< s
};

/// Plans the motion of a request. On failure, returns a sentence that names the axis.
std::expected<TrajectoryAnswer, std::string> answer_trajectory(TrajectoryRequest request);

/// Largest number of samples of one answer.
constexpr std::size_t most_samples = 1'000'000;

/// Returns the answer as one line of JSON, with the states of all axes at intervals of `sample` if
/// that is given. The error is that there would be more than most_samples samples.
std::expected<std::string, std::string> trajectory_json(const TrajectoryAnswer& answer,
                                                        std::optional<Time> sample);

/// Returns the line of JSON for a request that has no answer.
std::string trajectory_error_json(std::string_view error);

}  // namespace takt
