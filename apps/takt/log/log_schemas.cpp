#include "apps/takt/log/log_schemas.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace takt::logging {
namespace {

nlohmann::json object(const char* title, nlohmann::json properties) {
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", title},
          {"type", "object"},
          {"properties", std::move(properties)}};
}

nlohmann::json typed(const char* type, const std::string& description) {
  return {{"type", type}, {"description", description}};
}

}  // namespace

std::string cycle_field(const std::vector<LoggedSignal>& signals) {
  std::string name = "cycle";
  while (std::ranges::find(signals, name, &LoggedSignal::node) != signals.end()) name += '_';
  return name;
}

nlohmann::json image_schema(const std::vector<LoggedSignal>& signals) {
  nlohmann::json nodes = nlohmann::json::object();
  nodes[cycle_field(signals)] = typed("integer", "number of the SYNC");
  for (const LoggedSignal& signal : signals) {
    nlohmann::json& node = nodes[signal.node];
    node["type"] = "object";
    const bool is_integer =
        !is_real(signal.format.type) && signal.format.scale == 1.0 && signal.format.offset == 0.0;
    const std::string unit = signal.unit.empty() ? "" : ", " + signal.unit;
    node["properties"][signal.name] =
        typed(is_integer ? "integer" : "number", to_string(signal.object) + unit);
  }
  return object("takt.image", std::move(nodes));
}

nlohmann::json event_schema() {
  nlohmann::json levels = nlohmann::json::array();
  for (const char* const level : {"UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"}) {
    levels.push_back({{"title", level}, {"const", levels.size()}});
  }
  nlohmann::json time{
      {"type", "object"},
      {"title", "time"},
      {"properties",
       {{"sec", {{"type", "integer"}, {"minimum", 0}}},
        {"nsec", {{"type", "integer"}, {"minimum", 0}, {"maximum", 999'999'999}}}}}};
  return object("foxglove.Log",
                {{"timestamp", std::move(time)},
                 {"level", {{"title", "foxglove.LogLevel"}, {"oneOf", std::move(levels)}}},
                 {"message", typed("string", "the event in words")},
                 {"name", typed("string", "node; empty: the bus")},
                 {"file", typed("string", "kind of the event")},
                 {"line", {{"type", "integer"}, {"minimum", 0}, {"description", "cycle"}}}});
}

nlohmann::json frame_schema() {
  return object("takt.frame", {{"id", typed("string", "CAN identifier, hex")},
                               {"data", typed("string", "bytes, hex")},
                               {"service", typed("string", "CANopen service")},
                               {"node", typed("integer", "node-ID; 0: none or all")},
                               {"text", typed("string", "meaning")}});
}

}  // namespace takt::logging
