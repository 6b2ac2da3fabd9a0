#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "apps/takt/trajectory/trajectory_line.hpp"

namespace takt {
namespace {

using Json = nlohmann::ordered_json;
using Failure = std::unexpected<std::string>;

/// A key of a request, and how a number of its array gets into a task.
struct NumberKey {
  const char* part;
  const char* key;
  double* (*place)(motion::AxisTask&);
  bool required;
};

constexpr NumberKey number_keys[]{
    {"from", "position", [](motion::AxisTask& t) { return &t.from.position; }, true},
    {"from", "velocity", [](motion::AxisTask& t) { return &t.from.velocity; }, false},
    {"from", "acceleration", [](motion::AxisTask& t) { return &t.from.acceleration; }, false},
    {"to", "position", [](motion::AxisTask& t) { return &t.to.position; }, true},
    {"to", "velocity", [](motion::AxisTask& t) { return &t.to.velocity; }, false},
    {"to", "acceleration", [](motion::AxisTask& t) { return &t.to.acceleration; }, false},
    {"limits", "velocity", [](motion::AxisTask& t) { return &t.limits.max_velocity; }, true},
    {"limits", "acceleration", [](motion::AxisTask& t) { return &t.limits.max_acceleration; },
     true},
    {"limits", "jerk", [](motion::AxisTask& t) { return &t.limits.jerk; }, true},
    {"limits", "min_velocity", [](motion::AxisTask& t) { return &t.limits.min_velocity; }, false},
    {"limits", "min_acceleration", [](motion::AxisTask& t) { return &t.limits.min_acceleration; },
     false},
    {"limits", "max_position", [](motion::AxisTask& t) { return &t.range.max; }, false},
    {"limits", "min_position", [](motion::AxisTask& t) { return &t.range.min; }, false},
};

std::string quoted(std::string_view part, std::string_view key) {
  return "`" + std::string{part} + "." + std::string{key} + "`";
}

/// Returns the first key of `object` that no member of `known` equals.
std::optional<std::string> unknown_key(const Json& object,
                                       std::span<const std::string_view> known) {
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) == known.end()) return key;
  }
  return std::nullopt;
}

class Reader {
 public:
  std::expected<TrajectoryRequest, std::string> read(const Json& line) {
    if (!line.is_object()) return Failure{"expected a JSON object"};
    static constexpr std::array<std::string_view, 6> parts{
        "from", "to", "limits", "interface", "synchronisation", "minimum_duration"};
    if (const auto key = unknown_key(line, parts)) return Failure{"`" + *key + "` is no key"};
    if (!read_options(line) || !read_axes(line)) return Failure{error_};
    return std::move(request_);
  }

 private:
  bool fail(std::string error) {
    error_ = std::move(error);
    return false;
  }

  /// Reads one of two or three words. Leaves `value` unchanged if the key is missing.
  template <class Value, std::size_t Size>
  bool read_word(const Json& line, const char* key, Value& value,
                 const std::array<std::pair<std::string_view, Value>, Size>& words) {
    const auto found = line.find(key);
    if (found == line.end()) return true;
    std::string expected;
    for (const auto& [word, meaning] : words) {
      if (found->is_string() && found->template get_ref<const std::string&>() == word) {
        value = meaning;
        return true;
      }
      expected += (expected.empty() ? "`" : ", `") + std::string{word} + "`";
    }
    return fail("`" + std::string{key} + "` is one of " + expected);
  }

  bool read_options(const Json& line) {
    using motion::Goal;
    using motion::Synchronisation;
    static constexpr std::array<std::pair<std::string_view, Goal>, 2> goals{
        {{"position", Goal::position}, {"velocity", Goal::velocity}}};
    static constexpr std::array<std::pair<std::string_view, Synchronisation>, 3> ways{
        {{"time", Synchronisation::time},
         {"phase", Synchronisation::phase},
         {"none", Synchronisation::none}}};
    auto& options = request_.options;
    if (!read_word(line, "interface", options.goal, goals)) return false;
    if (!read_word(line, "synchronisation", options.synchronisation, ways)) return false;
    const auto minimum = line.find("minimum_duration");
    if (minimum == line.end() || minimum->is_null()) return true;
    if (!minimum->is_number() || !(minimum->get<double>() >= 0.0)) {
      return fail("`minimum_duration` is a number of seconds, 0 or more");
    }
    options.minimum_duration = minimum->get<double>();
    return true;
  }

  bool read_axes(const Json& line) {
    for (const char* part : {"from", "to", "limits"}) {
      const auto found = line.find(part);
      if (found == line.end() || !found->is_object()) {
        return fail("`" + std::string{part} + "` is missing, or is no object");
      }
      std::vector<std::string_view> known;
      for (const NumberKey& key : number_keys) {
        if (std::string_view{key.part} == part) known.push_back(key.key);
      }
      if (const auto key = unknown_key(*found, known)) {
        return fail(quoted(part, *key) + " is no key");
      }
    }
    for (const NumberKey& key : number_keys) {
      if (!read_numbers(line[key.part], key)) return false;
    }
    for (motion::AxisTask& task : request_.tasks) set_lower_limits(task.limits);
    return true;
  }

  bool read_numbers(const Json& part, const NumberKey& key) {
    const auto found = part.find(key.key);
    const bool is_target = std::string_view{key.part} == "to";
    const bool required =
        key.required && !(is_target && request_.options.goal == motion::Goal::velocity);
    if (found == part.end() || found->is_null()) {
      return !required || fail(quoted(key.part, key.key) + " is missing");
    }
    if (!found->is_array() || found->empty()) {
      return fail(quoted(key.part, key.key) + " is an array with a number for each axis");
    }
    if (request_.tasks.empty()) request_.tasks.resize(found->size(), unlimited());
    if (found->size() != request_.tasks.size()) {
      return fail(quoted(key.part, key.key) + " has " + std::to_string(found->size()) +
                  " numbers, expected " + std::to_string(request_.tasks.size()) +
                  ", one for each axis");
    }
    for (std::size_t i = 0; i < found->size(); ++i) {
      const Json& number = (*found)[i];
      if (!number.is_number()) {
        return fail(quoted(key.part, key.key) + " has an element that is no number");
      }
      *key.place(request_.tasks[i]) = number.get<double>();
    }
    return true;
  }

  /// Returns a task without limits; the caller sets them.
  static motion::AxisTask unlimited() {
    motion::AxisTask task;
    task.limits.min_velocity = task.limits.min_acceleration = std::nan("");
    return task;
  }

  static void set_lower_limits(motion::Limits& limits) {
    if (std::isnan(limits.min_velocity)) limits.min_velocity = -limits.max_velocity;
    if (std::isnan(limits.min_acceleration)) limits.min_acceleration = -limits.max_acceleration;
  }

  TrajectoryRequest request_;
  std::string error_;
};

}  // namespace

std::expected<TrajectoryRequest, std::string> read_trajectory_request(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (json.is_discarded()) return Failure{"this is not JSON"};
  return Reader{}.read(json);
}

}  // namespace takt
